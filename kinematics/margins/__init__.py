"""Margins, one file for each kind: numbers that must be large enough at every pose, and what proves their bounds."""

from kinematics.margins.clearance import CLEARANCE
from kinematics.margins.condition import INVERSE_CONDITION_NUMBER
from kinematics.margins.force_capability import FORCE_CAPABILITY
from kinematics.margins.isotropic import F_W, FVI, V_W
from kinematics.margins.joint_travel import JOINT_TRAVEL
from kinematics.margins.natural_frequency import NATURAL_FREQUENCY
from kinematics.margins.parallel import DET_J_X
from kinematics.margins.passive_joint import PASSIVE_JOINT
from kinematics.margins.reach import REACH
from kinematics.margins.serial import DET_J_Q, J_Q
from kinematics.margins.stiffness import INTERNAL_STIFFNESS, ROTATIONAL_STIFFNESS, STIFFNESS
from kinematics.margins.strength import STRENGTH

# What every mechanism has.
STANDARD = (
    REACH,
    JOINT_TRAVEL,
    CLEARANCE,
    FVI,
    V_W,
    F_W,
    FORCE_CAPABILITY,
    INVERSE_CONDITION_NUMBER,
    J_Q,
    DET_J_Q,
    DET_J_X,
    STIFFNESS,
    NATURAL_FREQUENCY,
    STRENGTH,
)

__all__ = ["CLEARANCE", "INTERNAL_STIFFNESS", "PASSIVE_JOINT", "ROTATIONAL_STIFFNESS", "STANDARD"]
