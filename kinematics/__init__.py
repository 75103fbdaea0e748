"""Mechanisms as loop closures, and all that follows from them."""

from kinematics.architectures import ARCHITECTURES, Architecture, loop_mobility, mobility_of_identical_chains
from kinematics.bodies import InertiaRecord
from kinematics.delta import Delta
from kinematics.drive_train import DriveTrain
from kinematics.dynamics import inverse_dynamics
from kinematics.errors import InvalidGeometry, InvalidShape, InvalidValue, LinkwrightError, UnreachablePose
from kinematics.gough_stewart import GoughStewart
from kinematics.gough_stewart_geometry import SingularArchitecture
from kinematics.gough_stewart_modes import LostPaths
from kinematics.gough_stewart_self_motion import SelfMotion
from kinematics.heli4 import Heli4
from kinematics.hexa import Hexa
from kinematics.indices import FviBounds
from kinematics.mechanism import Mechanism
from kinematics.mobility import JointGraph
from kinematics.motion import actuator_motion, joint_motion
from kinematics.par4 import Par4
from kinematics.peppermill import Peppermill
from kinematics.planar_3prr import Planar3PRR
from kinematics.planar_3rpr import Planar3RPR
from kinematics.planar_3rrr import Planar3RRR
from kinematics.redundant_3t1r import Redundant3T1R

_MAIN = (Heli4, Redundant3T1R, Peppermill, GoughStewart)
_FAMILY = (Planar3RPR, Planar3PRR, Planar3RRR, Delta, Hexa, Par4)
MECHANISMS: dict[str, type[Mechanism]] = {cls.__name__: cls for cls in (*_MAIN, *_FAMILY)}

__all__ = [
    "ARCHITECTURES",
    "MECHANISMS",
    "Architecture",
    "Delta",
    "DriveTrain",
    "FviBounds",
    "GoughStewart",
    "Heli4",
    "Hexa",
    "InertiaRecord",
    "InvalidGeometry",
    "InvalidShape",
    "InvalidValue",
    "JointGraph",
    "LinkwrightError",
    "LostPaths",
    "Mechanism",
    "Par4",
    "Peppermill",
    "Planar3PRR",
    "Planar3RPR",
    "Planar3RRR",
    "Redundant3T1R",
    "SelfMotion",
    "SingularArchitecture",
    "UnreachablePose",
    "actuator_motion",
    "inverse_dynamics",
    "joint_motion",
    "loop_mobility",
    "mobility_of_identical_chains",
]
