"""Proved bounds as text. They are rounded only to the side on which they are proved."""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal


def rounded_down(value: float, digits: int) -> str:
    """A lower bound with so many digits, none above it; a shorter number, such as 0.3, stays itself."""
    return _rounded(value, digits, ROUND_FLOOR)


def rounded_up(value: float, digits: int) -> str:
    """An upper bound with so many digits, none below it."""
    return _rounded(value, digits, ROUND_CEILING)


def _rounded(value: float, digits: int, way: str) -> str:
    if value == 0.0 or not math.isfinite(value):
        return f"{value:g}"
    written = Decimal(repr(float(value)))
    last = Decimal(1).scaleb(written.adjusted() - digits + 1)
    return f"{float(written.quantize(last, rounding=way)):.{digits}g}"
