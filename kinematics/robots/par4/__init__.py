"""Par4: four rotary limbs and an articulated platform."""

from kinematics.robots.par4.par4 import Par4

__all__ = [
    "Par4",
]
