"""Paths, actuator limits, timing laws, verification and set-points.

The timing laws and the moves load their solvers, IPOPT and ruckig, at first use.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from trajectory.adept import STANDARD_SIZES, AdeptCycle
from trajectory.cycle import Cycle, Piece, there_and_back
from trajectory.emergency_stop import EmergencyStop, emergency_stop
from trajectory.errors import (
    InvalidPath,
    LimitsExceeded,
    MoveRefused,
    PathBeyondLimit,
    PathRefused,
    RoughPath,
    SetpointFileError,
    TimingFailed,
    WaypointFileError,
)
from trajectory.files import CannotWrite, require_writable, write_files
from trajectory.limits import Limits
from trajectory.lower_bound import lower_bound
from trajectory.motion import Motion, PoseMotion, motion_of, pose_motion
from trajectory.path import Part, Path, Reversed, pieces
from trajectory.path_certificate import PathCertificate, certify_path
from trajectory.pose_spline import PoseSpline
from trajectory.repair import Repaired, repair
from trajectory.rounded import RoundedPath
from trajectory.setpoint_file import read_setpoints, write_setpoints
from trajectory.setpoints import Setpoints, cycle_setpoints
from trajectory.smoothness import require_smooth
from trajectory.timed import TimedMotion, TimedPath
from trajectory.timing import PathMotion, TimeLaw
from trajectory.verification import Peak, Verification, verify
from trajectory.waypoint_file import read_waypoints

if TYPE_CHECKING:
    from trajectory.free_law import free_motion
    from trajectory.jerk import jerk_limited
    from trajectory.moves import Move, plan_move, plan_stop
    from trajectory.toppra_law import time_optimal

_LAZY = {
    "Move": "trajectory.moves",
    "free_motion": "trajectory.free_law",
    "jerk_limited": "trajectory.jerk",
    "plan_move": "trajectory.moves",
    "plan_stop": "trajectory.moves",
    "time_optimal": "trajectory.toppra_law",
}


def __getattr__(name: str) -> Any:
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_LAZY[name]), name)


__all__ = [
    "STANDARD_SIZES",
    "AdeptCycle",
    "CannotWrite",
    "Cycle",
    "EmergencyStop",
    "InvalidPath",
    "Limits",
    "LimitsExceeded",
    "Motion",
    "Move",
    "MoveRefused",
    "Part",
    "Path",
    "PathBeyondLimit",
    "PathCertificate",
    "PathMotion",
    "PathRefused",
    "Peak",
    "Piece",
    "PoseMotion",
    "PoseSpline",
    "Repaired",
    "Reversed",
    "RoughPath",
    "RoundedPath",
    "SetpointFileError",
    "Setpoints",
    "TimeLaw",
    "TimedMotion",
    "TimedPath",
    "TimingFailed",
    "Verification",
    "WaypointFileError",
    "certify_path",
    "cycle_setpoints",
    "emergency_stop",
    "free_motion",
    "jerk_limited",
    "lower_bound",
    "motion_of",
    "pieces",
    "plan_move",
    "plan_stop",
    "pose_motion",
    "read_setpoints",
    "read_waypoints",
    "repair",
    "require_smooth",
    "require_writable",
    "there_and_back",
    "time_optimal",
    "verify",
    "write_files",
    "write_setpoints",
]
