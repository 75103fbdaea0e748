"""Lower bounds of the time of any law."""

from trajectory.laws.bounds.least_time import lower_bound

__all__ = [
    "lower_bound",
]
