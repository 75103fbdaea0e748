"""Bisection of many intervals at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Array


def bisected(
    holds: Callable[[Array], ArrayLike], low: ArrayLike, high: ArrayLike, tolerance: ArrayLike = 0.0
) -> tuple[Array, Array]:
    """The ends (...) of intervals from where a condition holds to where it does not.

    Args:
        holds: whether it does at arguments (...), (...) answers; it is taken to hold at `low` and not at `high`, and is
            asked at neither.
        low, high: (...) the ends to start from.
        tolerance: (...) halving ends at intervals of this length; with 0, where no double lies between their ends.
    """
    low, high = (np.array(end, dtype=float) for end in np.broadcast_arrays(low, high))
    middle = 0.5 * low + 0.5 * high
    while ((high - low > tolerance) & (low < middle) & (middle < high)).any():
        inside = np.asarray(holds(middle))
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
        middle = 0.5 * low + 0.5 * high
    return low, high
