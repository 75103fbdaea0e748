"""Mechanisms as loop closures, and all that follows from them."""

from kinematics.delta import Delta
from kinematics.errors import InvalidGeometry, InvalidShape, InvalidValue, LinkwrightError, UnreachablePose
from kinematics.gough_stewart import GoughStewart
from kinematics.gough_stewart_geometry import SingularArchitecture
from kinematics.gough_stewart_modes import LostPaths
from kinematics.heli4 import Heli4
from kinematics.indices import FviBounds
from kinematics.mechanism import Mechanism
from kinematics.par4 import Par4
from kinematics.planar_3prr import Planar3PRR
from kinematics.planar_3rpr import Planar3RPR
from kinematics.planar_3rrr import Planar3RRR

MECHANISMS: dict[str, type[Mechanism]] = {
    cls.__name__: cls for cls in (Heli4, GoughStewart, Planar3RPR, Planar3PRR, Planar3RRR, Delta, Par4)
}

__all__ = [
    "MECHANISMS",
    "Delta",
    "FviBounds",
    "GoughStewart",
    "Heli4",
    "InvalidGeometry",
    "InvalidShape",
    "InvalidValue",
    "LinkwrightError",
    "LostPaths",
    "Mechanism",
    "Par4",
    "Planar3PRR",
    "Planar3RPR",
    "Planar3RRR",
    "SingularArchitecture",
    "UnreachablePose",
]
