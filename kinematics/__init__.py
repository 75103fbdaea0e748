"""Mechanisms as loop closures, and all that follows from them."""

from kinematics.errors import InvalidGeometry, InvalidShape, InvalidValue, LinkwrightError, UnreachablePose
from kinematics.heli4 import Heli4
from kinematics.indices import FviBounds
from kinematics.mechanism import Mechanism
from kinematics.peppermill import Peppermill

MECHANISMS: dict[str, type[Mechanism]] = {cls.__name__: cls for cls in (Heli4, Peppermill)}

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
    "UnreachablePose",
]
