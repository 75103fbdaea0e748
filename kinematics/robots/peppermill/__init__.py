"""Peppermill: two limbs, four identical motors, a platform on two screws."""

from kinematics.robots.peppermill.peppermill import Peppermill

__all__ = [
    "Peppermill",
]
