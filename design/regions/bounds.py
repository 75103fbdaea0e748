"""Bounds of a region's coordinates, as they are given."""

from __future__ import annotations

import math
from numbers import Real

from design.errors import InvalidRegion

Interval = float | tuple[float, float]
LARGEST = 1e100  # of a bound: squares of it must stay numbers


def interval(name: str, value: object) -> tuple[float, float]:
    """Lower and upper bound of a coordinate.

    Raises:
        InvalidRegion: neither a number nor two with the lower first.
    """
    pair = tuple(value) if isinstance(value, list | tuple) else (value, value)
    low, high = (number(v) for v in pair) if len(pair) == 2 else (math.nan, math.nan)
    if not low <= high:
        raise InvalidRegion(name, value, "a number whose square is one too, or two with the lower first")
    return low, high


def number(value: object) -> float:
    """The value as a float; NaN where it is no number of a usual size."""
    found = float(value) if isinstance(value, Real) and not isinstance(value, bool) else math.nan
    return found if abs(found) <= LARGEST else math.nan
