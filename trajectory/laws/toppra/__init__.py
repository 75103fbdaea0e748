"""The law `toppra`: time-optimal on a fixed path, without a jerk limit."""

from trajectory.laws.toppra.law import time_optimal

__all__ = [
    "time_optimal",
]
