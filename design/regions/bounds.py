"""Check the bounds of a region's coordinates."""

from __future__ import annotations

import math
from numbers import Real

from design.errors import InvalidRegion

Interval = float | tuple[float, float]
LARGEST = 1e100  # largest size of a bound, so that its square stays finite


def interval(name: str, value: object) -> tuple[float, float]:
    """Lower and upper bound of a coordinate.

    Raises:
        InvalidRegion: the value is neither a number nor two numbers with the lower first.
    """
    pair = tuple(value) if isinstance(value, list | tuple) else (value, value)
    low, high = (number(v) for v in pair) if len(pair) == 2 else (math.nan, math.nan)
    if not low <= high:
        raise InvalidRegion(name, value, "a number of a size up to 1e100, or two such numbers with the lower first")
    return low, high


def number(value: object) -> float:
    """The value as a float; NaN if it is no number, or too large."""
    found = float(value) if isinstance(value, Real) and not isinstance(value, bool) else math.nan
    return found if abs(found) <= LARGEST else math.nan
