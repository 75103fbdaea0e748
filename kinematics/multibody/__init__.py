"""A mechanism as a tree of bodies, and as a file for simulators of multibody systems."""

from kinematics.multibody.mjcf import mjcf

__all__ = [
    "mjcf",
]
