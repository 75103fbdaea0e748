"""Checks of numbers that callers give; they return plain numbers."""

from __future__ import annotations

import math
from numbers import Integral, Real

from kinematics.errors import InvalidValue


def finite(what: str, value: object, expected: str = "a finite number") -> float:
    """As a float.

    Raises:
        InvalidValue: the value is text, a truth value, NaN or infinite.
    """
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
        raise InvalidValue(what, repr(value) if isinstance(value, str) else value, expected)
    return float(value)


def positive(what: str, value: object, expected: str = "a finite number > 0") -> float:
    """As a float.

    Raises:
        InvalidValue: the value is not above 0, or as for `finite`.
    """
    number = finite(what, value, expected)
    if number <= 0.0:
        raise InvalidValue(what, value, expected)
    return number


def whole(what: str, value: object, low: int, high: int | None = None) -> int:
    """As an int.

    Raises:
        InvalidValue: the value is not a whole number from `low` to `high`.
    """
    expected = f"a whole number, {low} or more" if high is None else f"a whole number from {low} to {high}"
    number = int(value) if isinstance(value, Integral) and not isinstance(value, bool) else None
    if number is None or number < low or (high is not None and number > high):
        raise InvalidValue(what, repr(value) if isinstance(value, str) else value, expected)
    return number
