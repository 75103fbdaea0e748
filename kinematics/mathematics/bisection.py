"""Bisection of many intervals at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Array


def bisected(
    holds: Callable[[Array], ArrayLike], low: ArrayLike, high: ArrayLike, tolerance: ArrayLike = 0.0
) -> tuple[Array, Array]:
    """Short intervals, each with an end (...) where a condition holds and an end (...) where it does not.

    Args:
        holds: the condition, from arguments (...) to answers (...). It must hold at `low` and fail at `high`; it is not
            called there.
        low, high: (...) the first ends.
        tolerance: (...) halving stops at intervals of this length; with 0, when no double is left between the ends.
    """
    low, high = (np.array(end, dtype=float) for end in np.broadcast_arrays(low, high))
    middle = 0.5 * low + 0.5 * high
    while ((high - low > tolerance) & (low < middle) & (middle < high)).any():
        inside = np.asarray(holds(middle))
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
        middle = 0.5 * low + 0.5 * high
    return low, high
