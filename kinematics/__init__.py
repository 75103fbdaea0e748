"""Mechanisms as loop closures, and all that follows from them."""

from kinematics.errors import InvalidGeometry, InvalidShape, InvalidValue, LinkwrightError, UnreachablePose
from kinematics.heli4 import Heli4
from kinematics.indices import FviBounds
from kinematics.mechanism import Mechanism
from kinematics.peppermill import Peppermill
from kinematics.redundant_3t1r import Redundant3T1R

MECHANISMS: dict[str, type[Mechanism]] = {cls.__name__: cls for cls in (Heli4, Redundant3T1R, Peppermill)}

__all__ = [
    "MECHANISMS",
    "FviBounds",
    "Heli4",
    "InvalidGeometry",
    "InvalidShape",
    "InvalidValue",
    "LinkwrightError",
    "Mechanism",
    "Peppermill",
    "Redundant3T1R",
    "UnreachablePose",
]
