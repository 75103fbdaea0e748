"""Paths, actuator limits, timing laws, verification and set-points.

The timing laws and the moves load their solvers, IPOPT and ruckig, at first use.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from trajectory.cycles import (
    FRAME_UNITS,
    Cycle,
    FramePeak,
    MemberPeak,
    Piece,
    Repaired,
    frame_peaks,
    frame_reaction_text,
    member_peaks,
    repair,
    there_and_back,
)
from trajectory.errors import (
    InvalidPath,
    LimitsExceeded,
    MoveRefused,
    PathBeyondLimit,
    PathRefused,
    RoughPath,
    SetpointFileError,
    TimingFailed,
    UnsuitedPath,
    WaypointFileError,
)
from trajectory.files import CannotWrite, require_writable, write_files
from trajectory.laws import LAWS, Law, TimingLaw, law_named
from trajectory.laws.bounds import lower_bound
from trajectory.limits import LIMITS, SPEED_UNIT, JointField, Limit, LimitField, Limits, RangeField, ToolField
from trajectory.motions import (
    Motion,
    PathMotion,
    PoseMotion,
    PoseSpline,
    TimedMotion,
    TimedPath,
    TimeLaw,
    motion_of,
    pose_motion,
)
from trajectory.paths import (
    STANDARD_SIZES,
    AdeptCycle,
    Part,
    Path,
    PoseBounds,
    Reversed,
    RoundedPath,
    pieces,
    places,
    read_waypoints,
    require_smooth,
)
from trajectory.setpoints import Setpoints, cycle_setpoints, read_setpoints, write_setpoints
from trajectory.stops import EmergencyStop, emergency_stop
from trajectory.units import in_si
from trajectory.verification import PathCertificate, Peak, Verification, Way, certify_path, verify

if TYPE_CHECKING:
    from trajectory.laws.free import free_motion
    from trajectory.laws.jerk import jerk_limited
    from trajectory.laws.toppra import time_optimal
    from trajectory.moves import Move, plan_move, plan_stop

_LAZY = {
    "free_motion": "trajectory.laws.free",
    "jerk_limited": "trajectory.laws.jerk",
    "time_optimal": "trajectory.laws.toppra",
    "Move": "trajectory.moves",
    "plan_move": "trajectory.moves",
    "plan_stop": "trajectory.moves",
}


def __getattr__(name: str) -> Any:
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_LAZY[name]), name)


__all__ = [
    "FRAME_UNITS",
    "LAWS",
    "LIMITS",
    "SPEED_UNIT",
    "STANDARD_SIZES",
    "AdeptCycle",
    "CannotWrite",
    "Cycle",
    "EmergencyStop",
    "FramePeak",
    "InvalidPath",
    "JointField",
    "Law",
    "Limit",
    "LimitField",
    "Limits",
    "LimitsExceeded",
    "MemberPeak",
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
    "PoseBounds",
    "PoseMotion",
    "PoseSpline",
    "RangeField",
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
    "TimingLaw",
    "ToolField",
    "UnsuitedPath",
    "Verification",
    "Way",
    "WaypointFileError",
    "certify_path",
    "cycle_setpoints",
    "emergency_stop",
    "frame_peaks",
    "frame_reaction_text",
    "free_motion",
    "in_si",
    "jerk_limited",
    "law_named",
    "lower_bound",
    "member_peaks",
    "motion_of",
    "pieces",
    "places",
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
