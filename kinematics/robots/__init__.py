"""The mechanisms: one file or one room for each."""

from kinematics.robots.delta import Delta
from kinematics.robots.hexa import Hexa
from kinematics.robots.registry import MECHANISMS

__all__ = [
    "MECHANISMS",
    "Delta",
    "Hexa",
]
