"""A mechanism's model: its definition, and everything that is derived from its loop closure."""

from kinematics.model.abstract_margin import ClaimSymbols, Margin, Measure, ToShow, by_name, signed
from kinematics.model.aspect import in_aspect, joined_to_home
from kinematics.model.bound import Bound
from kinematics.model.continuation import continued, polished, reached
from kinematics.model.indices import (
    FviBounds,
    fvi,
    fvi_components,
    homogeneous,
    isotropic,
    isotropic_components,
    sides,
)
from kinematics.model.joint_redundancy import BestFit, EncoderCheck, check_encoders, least_squares
from kinematics.model.mechanism import Mechanism
from kinematics.model.obstacle_names import free_name, taken_names
from kinematics.model.programs import Build, Write
from kinematics.model.symbolic_model import Model
from kinematics.model.working_mode import Mode

__all__ = [
    "BestFit",
    "Bound",
    "Build",
    "ClaimSymbols",
    "EncoderCheck",
    "FviBounds",
    "Margin",
    "Measure",
    "Mechanism",
    "Mode",
    "Model",
    "ToShow",
    "Write",
    "by_name",
    "check_encoders",
    "continued",
    "free_name",
    "fvi",
    "fvi_components",
    "homogeneous",
    "in_aspect",
    "isotropic",
    "isotropic_components",
    "joined_to_home",
    "least_squares",
    "polished",
    "reached",
    "sides",
    "signed",
    "taken_names",
]
