"""Heli4: four rotary drives, two plates, a screw that turns the tool."""

from kinematics.robots.heli4.heli4 import Heli4

__all__ = [
    "Heli4",
]
