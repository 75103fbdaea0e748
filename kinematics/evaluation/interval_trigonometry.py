"""Cosine, shifted for the sine, and arctangent of intervals, without branches: a loop over them becomes vector code."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from kinematics.evaluation import vector_sine
from kinematics.evaluation.vector_arctangent import angle

_ERROR = 2.0**-50  # what sine, cosine and arctangent may be off by, relative to 1
_OPTIONS: dict[str, Any] = {"nogil": True, "cache": True, "error_model": "numpy", "inline": "always"}
_cosine_at = vector_sine.sine
LIMIT = vector_sine.LIMIT - 2.0  # rad; a quarter of a turn less
QUARTER = 0.5 * np.pi
_FAR = 1e9


@numba.njit(**_OPTIONS)
def shifted_cosine(a, b, shift):  # type: ignore[no-untyped-def]
    """Bounds of cos(x - shift) on [a, b] within LIMIT of 0; `shift` is 0, or QUARTER for a sine. Exact at x = 0."""
    p, q = a - shift, b - shift
    low, high = _bounds(p, q, _cosine_at(p, 1.0), _cosine_at(q, 1.0))
    zero, exact = (a == 0.0) & (b == 0.0), 1.0 if shift == 0.0 else 0.0
    return (exact if zero else low), (exact if zero else high)


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="never")
def far_cosine(a, b, shift):  # type: ignore[no-untyped-def]
    """As `shifted_cosine`, for any box, by the C library."""
    p, q = a - shift, b - shift
    if _FAR < max(abs(p), abs(q)) < np.inf:
        return -1.0, 1.0
    return _bounds(p, q, np.cos(p), np.cos(q))


@numba.njit(**_OPTIONS)
def _bounds(a, b, p, q):  # type: ignore[no-untyped-def]
    """From the cosines p and q of the ends, and where the box holds a multiple of pi, counted with room for rounding.

    `slack` covers the error of the cosine, the rounding of a shift by pi / 2, and of pi itself, all relative to the
    angle.
    """
    largest = max(abs(a), abs(b))
    slack = _ERROR * (1.0 + largest)
    first, last = np.ceil((a - slack) / np.pi - 1e-12), np.floor((b + slack) / np.pi + 1e-12)
    even = np.floor(0.5 * first) == 0.5 * first
    several, one = first < last, first == last
    wide = (b - a >= 6.0) | several
    high = 1.0 if wide | (one & even) else min(max(p, q) + 2.0 * slack, 1.0)
    low = -1.0 if wide | (one & (not even)) else max(min(p, q) - 2.0 * slack, -1.0)
    defined = largest < np.inf
    return (low if defined else -np.inf), (high if defined else np.inf)


@numba.njit(**_OPTIONS)
def arctangent(a, b, c, d):  # type: ignore[no-untyped-def]
    """atan2 of y in [a, b], x in [c, d], unless the box meets the cut or the origin.

    There it jumps, and bounds would let a slope speak for both sides. Elsewhere the angle falls with x above the
    x axis and grows with it below, and grows with y on the right of the y axis and falls with it on the left.
    """
    total = a + b + c + d
    defined = (total - total == 0.0) & ((c > 0.0) | (a > 0.0) | (b < 0.0))
    x, u = (d if a > 0.0 else c), (d if b < 0.0 else c)
    low, high = angle(a if x > 0.0 else b, x), angle(b if u > 0.0 else a, u)
    return (low - _ERROR * 4.0 if defined else -np.inf), (high + _ERROR * 4.0 if defined else np.inf)
