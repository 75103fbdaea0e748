"""The law `jerk`: the fastest on a fixed path that keeps all limits, jerk among them."""

from trajectory.laws.jerk.law import jerk_limited

__all__ = [
    "jerk_limited",
]
