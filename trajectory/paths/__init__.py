"""Paths of the pose by arc length."""

from trajectory.paths.adept import STANDARD_SIZES, AdeptCycle
from trajectory.paths.clearance_arch import TOLERANCE, Arch
from trajectory.paths.knots import interval_of, located, throughout
from trajectory.paths.path import Part, Path, PathBox, Reversed, pieces, places, require_poses_of
from trajectory.paths.pose_bounds import PoseBounds, bezier_points
from trajectory.paths.rounded_path import RoundedPath
from trajectory.paths.smoothness import require_smooth
from trajectory.paths.waypoint_file import read_waypoints

__all__ = [
    "STANDARD_SIZES",
    "TOLERANCE",
    "AdeptCycle",
    "Arch",
    "Part",
    "Path",
    "PathBox",
    "PoseBounds",
    "Reversed",
    "RoundedPath",
    "bezier_points",
    "interval_of",
    "located",
    "pieces",
    "places",
    "read_waypoints",
    "require_poses_of",
    "require_smooth",
    "throughout",
]
