"""Limits, one file a kind: its words, what a motion uses of it, and what it asks of a law."""

from trajectory.limits.constraints import (
    Along,
    Cap,
    Constraint,
    Disc,
    Linear,
    Place,
    Sloped,
    Squared,
    Third,
    TorqueAlong,
)
from trajectory.limits.field import SPEED_UNIT, JointField, LimitField, RangeField, ToolField
from trajectory.limits.jerk import JOINT_JERK
from trajectory.limits.joint_ranges import JOINT_RANGES
from trajectory.limits.limit import InstantLimit, Limit, MeanSquareLimit, SymbolicMotion, Use
from trajectory.limits.limits import LIMITS, Limits, mean_squares, uses
from trajectory.limits.over_intervals import IntervalRows, OverIntervals, SlopesOverIntervals
from trajectory.limits.stretch import Sampled

__all__ = [
    "JOINT_JERK",
    "JOINT_RANGES",
    "LIMITS",
    "SPEED_UNIT",
    "Along",
    "Cap",
    "Constraint",
    "Disc",
    "InstantLimit",
    "IntervalRows",
    "JointField",
    "Limit",
    "LimitField",
    "Limits",
    "Linear",
    "MeanSquareLimit",
    "OverIntervals",
    "Place",
    "RangeField",
    "Sampled",
    "Sloped",
    "SlopesOverIntervals",
    "Squared",
    "SymbolicMotion",
    "Third",
    "ToolField",
    "TorqueAlong",
    "Use",
    "mean_squares",
    "uses",
]
