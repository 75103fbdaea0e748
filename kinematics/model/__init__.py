"""A mechanism's model: what it defines, and what follows from its loop closure."""

from kinematics.model.aspect import in_aspect, joined_to_home
from kinematics.model.continuation import continued, polished, reached
from kinematics.model.indices import FviBounds, homogeneous, sides
from kinematics.model.joint_redundancy import BestFit, EncoderCheck, check_encoders, least_squares
from kinematics.model.mechanism import Mechanism
from kinematics.model.programs import Build, Write
from kinematics.model.symbolic_model import Model
from kinematics.model.working_mode import Mode

__all__ = [
    "BestFit",
    "Build",
    "EncoderCheck",
    "FviBounds",
    "Mechanism",
    "Mode",
    "Model",
    "Write",
    "check_encoders",
    "continued",
    "homogeneous",
    "in_aspect",
    "joined_to_home",
    "least_squares",
    "polished",
    "reached",
    "sides",
]
