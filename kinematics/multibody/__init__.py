"""A mechanism as a tree of bodies, and as a file for simulators of multibody systems."""

from kinematics.multibody.mjcf import mjcf
from kinematics.multibody.open_tree import tree_motion
from kinematics.multibody.payload import placed_payload
from kinematics.multibody.placed_shapes import PlacedShape, placed_shapes
from kinematics.multibody.room_at_home import require_room
from kinematics.multibody.swept_box import swept_box

__all__ = [
    "PlacedShape",
    "mjcf",
    "placed_payload",
    "placed_shapes",
    "require_room",
    "swept_box",
    "tree_motion",
]
