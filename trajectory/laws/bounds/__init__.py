"""Lower bounds of the time that any law takes."""

from trajectory.laws.bounds.least_time import lower_bound

__all__ = [
    "lower_bound",
]
