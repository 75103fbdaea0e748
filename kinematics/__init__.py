"""Mechanisms as loop closures, and all that follows from them."""

from kinematics.errors import InvalidGeometry, InvalidShape, InvalidValue, LinkwrightError, UnreachablePose
from kinematics.gough_stewart import GoughStewart
from kinematics.gough_stewart_geometry import SingularArchitecture
from kinematics.gough_stewart_modes import LostPaths
from kinematics.heli4 import Heli4
from kinematics.indices import FviBounds
from kinematics.mechanism import Mechanism
from kinematics.peppermill import Peppermill
from kinematics.redundant_3t1r import Redundant3T1R

MECHANISMS: dict[str, type[Mechanism]] = {cls.__name__: cls for cls in (Heli4, Redundant3T1R, Peppermill, GoughStewart)}

__all__ = [
    "MECHANISMS",
    "FviBounds",
    "GoughStewart",
    "Heli4",
    "InvalidGeometry",
    "InvalidShape",
    "InvalidValue",
    "LinkwrightError",
    "LostPaths",
    "Mechanism",
    "Peppermill",
    "Redundant3T1R",
    "SingularArchitecture",
    "UnreachablePose",
]
