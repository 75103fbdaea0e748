"""The law `toppra`: time-optimal on a fixed path, without a limit of jerk."""

from trajectory.laws.toppra.law import REFUSED, time_optimal

__all__ = [
    "REFUSED",
    "time_optimal",
]
