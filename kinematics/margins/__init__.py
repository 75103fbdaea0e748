"""Margins, one file for each kind: numbers that must be good enough at every pose, and what proves their bounds."""

from kinematics.margins.accuracy import ANGLE_ACCURACY, POSITION_ACCURACY
from kinematics.margins.clearance import CLEARANCE, lowest_of_base, payload_inside
from kinematics.margins.condition import INVERSE_CONDITION_NUMBER
from kinematics.margins.force_capability import FORCE_CAPABILITY
from kinematics.margins.isotropic import F_W, FVI, V_W
from kinematics.margins.joint_travel import JOINT_TRAVEL
from kinematics.margins.largest_errors import largest_errors
from kinematics.margins.mass import MASS
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
    MASS,
    POSITION_ACCURACY,
    STRENGTH,
)

__all__ = [
    "ANGLE_ACCURACY",
    "CLEARANCE",
    "INTERNAL_STIFFNESS",
    "PASSIVE_JOINT",
    "ROTATIONAL_STIFFNESS",
    "STANDARD",
    "largest_errors",
    "lowest_of_base",
    "payload_inside",
]
