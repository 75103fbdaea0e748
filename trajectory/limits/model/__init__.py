"""The base of all limits: fields, constraints on the pace, and the stretch of time that keeps a limit."""

from trajectory.limits.model.constraints import (
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
    torque_over,
)
from trajectory.limits.model.field import SPEED_UNIT, JointField, LimitField, RangeField, ToolField
from trajectory.limits.model.limit import (
    NO_SLACK,
    InstantLimit,
    Limit,
    MeanSquareLimit,
    SymbolicMotion,
    Use,
    against,
)
from trajectory.limits.model.over_intervals import IntervalRows, OverIntervals, SlopesOverIntervals
from trajectory.limits.model.stretch import Sampled, stretch_of_mean_square, stretch_of_sum
from trajectory.limits.model.values import LimitValues

__all__ = [
    "NO_SLACK",
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
    "LimitValues",
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
    "against",
    "stretch_of_mean_square",
    "stretch_of_sum",
    "torque_over",
]
