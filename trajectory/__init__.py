"""Paths, actuator limits, timing laws, verification and set-points.

`time_optimal`, `jerk_limited` and `plan_approach` load their solvers, toppra, IPOPT and ruckig, at first use.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from trajectory.adept import AdeptCycle
from trajectory.cycle import Cycle, Piece, there_and_back
from trajectory.errors import LimitsExceeded, RoughPath, SetpointFileError, TimingFailed
from trajectory.files import CannotWrite, require_writable, write_files
from trajectory.limits import Limits
from trajectory.motion import Motion, PoseMotion, motion_of, pose_motion
from trajectory.path import Path, Reversed, require_smooth
from trajectory.repair import Repaired, repair
from trajectory.setpoint_file import read_setpoints, write_setpoints
from trajectory.setpoints import Setpoints, cycle_setpoints
from trajectory.timed import TimedMotion, TimedPath
from trajectory.timing import PathMotion, TimeLaw
from trajectory.verification import Peak, Verification, verify

if TYPE_CHECKING:
    from trajectory.approach import Approach, plan_approach
    from trajectory.jerk_law import jerk_limited
    from trajectory.toppra_law import time_optimal

_LAZY = {
    "Approach": "trajectory.approach",
    "jerk_limited": "trajectory.jerk_law",
    "plan_approach": "trajectory.approach",
    "time_optimal": "trajectory.toppra_law",
}


def __getattr__(name: str) -> Any:
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_LAZY[name]), name)


__all__ = [
    "AdeptCycle",
    "Approach",
    "CannotWrite",
    "Cycle",
    "Limits",
    "LimitsExceeded",
    "Motion",
    "Path",
    "PathMotion",
    "Peak",
    "Piece",
    "PoseMotion",
    "Repaired",
    "Reversed",
    "RoughPath",
    "SetpointFileError",
    "Setpoints",
    "TimeLaw",
    "TimedMotion",
    "TimedPath",
    "TimingFailed",
    "Verification",
    "cycle_setpoints",
    "jerk_limited",
    "motion_of",
    "plan_approach",
    "pose_motion",
    "read_setpoints",
    "repair",
    "require_smooth",
    "require_writable",
    "there_and_back",
    "time_optimal",
    "verify",
    "write_files",
    "write_setpoints",
]
