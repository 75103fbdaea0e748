"""Planar robots with three legs."""

from kinematics.robots.planar.planar_3prr import Planar3PRR
from kinematics.robots.planar.planar_3rpr import Planar3RPR
from kinematics.robots.planar.planar_3rrr import Planar3RRR

__all__ = [
    "Planar3PRR",
    "Planar3RPR",
    "Planar3RRR",
]
