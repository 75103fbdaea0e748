"""Motions: the pose, the joints and the torque as functions of time."""

from trajectory.motions.motion import Motion, PoseMotion, motion_of, pose_motion
from trajectory.motions.paced import SAME, PacedMotion
from trajectory.motions.pose_spline import InTime, PoseSpline
from trajectory.motions.time_law import PathMotion, TimeLaw
from trajectory.motions.timed_motion import TimedMotion, TimedPath
from trajectory.motions.torque_terms import ByRate, torque_along, torque_by_rate

__all__ = [
    "SAME",
    "ByRate",
    "InTime",
    "Motion",
    "PacedMotion",
    "PathMotion",
    "PoseMotion",
    "PoseSpline",
    "TimeLaw",
    "TimedMotion",
    "TimedPath",
    "motion_of",
    "pose_motion",
    "torque_along",
    "torque_by_rate",
]
