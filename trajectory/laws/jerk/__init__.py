"""The law `jerk`: the fastest law on a fixed path that keeps all limits, with the jerk limit."""

from trajectory.laws.jerk.law import jerk_limited

__all__ = [
    "jerk_limited",
]
