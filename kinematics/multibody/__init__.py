"""A mechanism as a tree of bodies, and as a file for simulators of multibody systems."""

from kinematics.multibody.mjcf import mjcf
from kinematics.multibody.open_tree import tree_motion

__all__ = [
    "mjcf",
    "tree_motion",
]
