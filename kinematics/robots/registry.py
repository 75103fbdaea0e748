"""The mechanisms by name."""

from __future__ import annotations

from kinematics.model import Mechanism
from kinematics.robots.delta import Delta
from kinematics.robots.gough_stewart import GoughStewart
from kinematics.robots.heli4 import Heli4
from kinematics.robots.hexa import Hexa
from kinematics.robots.par4 import Par4
from kinematics.robots.peppermill import Peppermill
from kinematics.robots.planar import Planar3PRR, Planar3RPR, Planar3RRR
from kinematics.robots.redundant_3t1r import Redundant3T1R

_MAIN = (Heli4, Redundant3T1R, Peppermill, GoughStewart)
_FAMILY = (Planar3RPR, Planar3PRR, Planar3RRR, Delta, Hexa, Par4)
MECHANISMS: dict[str, type[Mechanism]] = {cls.__name__: cls for cls in (*_MAIN, *_FAMILY)}
