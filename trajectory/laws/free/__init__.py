"""The law `free`: path and timing together."""

from trajectory.laws.free.law import free_motion

__all__ = [
    "free_motion",
]
