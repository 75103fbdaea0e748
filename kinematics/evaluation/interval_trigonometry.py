"""Cosine, and with it sine, and arctangent of intervals."""

from __future__ import annotations

import numba
import numpy as np

_LIBRARY = 2.0**-50  # what sine, cosine and arctangent may be off by, relative to 1


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="never")
def cosine(a, b):  # type: ignore[no-untyped-def]
    """Extremes at the ends and where the box holds a multiple of pi, by a count that allows for its own rounding.

    `slack` covers the library's error, the rounding of a shift by pi / 2, and of pi itself, all relative to the angle.
    """
    slack = _LIBRARY * (1.0 + max(abs(a), abs(b)))
    if not b - a < 6.0 or max(abs(a), abs(b)) > 1e9:
        return -1.0, 1.0
    low, high = min(np.cos(a), np.cos(b)) - 2.0 * slack, max(np.cos(a), np.cos(b)) + 2.0 * slack
    first, last = np.ceil((a - slack) / np.pi - 1e-12), np.floor((b + slack) / np.pi + 1e-12)
    if first <= last:
        if first < last or first % 2.0 == 0.0:
            high = 1.0
        if first < last or first % 2.0 != 0.0:
            low = -1.0
    return max(low, -1.0), min(high, 1.0)


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="never")
def arctangent(a, b, c, d):  # type: ignore[no-untyped-def]
    """atan2 of y in [a, b], x in [c, d]: extremes at the corners unless the box meets the cut or the origin.

    There it jumps, and bounds would let a slope speak for both sides.
    """
    if c <= 0.0 and a <= 0.0 <= b:
        return -np.inf, np.inf
    p, q, u, v = np.arctan2(a, c), np.arctan2(a, d), np.arctan2(b, c), np.arctan2(b, d)
    low, high = min(min(p, q), min(u, v)), max(max(p, q), max(u, v))
    return low - _LIBRARY * 4.0, high + _LIBRARY * 4.0
