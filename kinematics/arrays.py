"""Checks of arrays that callers give, and a base for records with arrays that compare by value."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from kinematics.errors import InvalidShape, InvalidValue

Array = np.ndarray


class Value:
    """Base of frozen dataclasses (with `eq=False`) that may hold arrays. Two are equal if all fields are equal.

    Arrays are equal if their shapes and all numbers are equal; NaN is equal to NaN here.
    """

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and all(map(_same, _fields(self), _fields(other)))

    def __hash__(self) -> int:
        return hash((type(self), *map(_key, _fields(self))))


def _fields(value: Any) -> list[Any]:
    return [getattr(value, field.name) for field in fields(value)]


def _same(first: Any, second: Any) -> bool:
    if isinstance(first, np.ndarray) or isinstance(second, np.ndarray):
        numbers = np.asarray(first).dtype.kind in "fc"
        return bool(np.array_equal(first, second, equal_nan=numbers and np.asarray(second).dtype.kind in "fc"))
    if isinstance(first, tuple) and type(first) is type(second):
        return len(first) == len(second) and all(map(_same, first, second))
    return bool(first == second)


def _key(value: Any) -> Any:
    """A key that is equal for equal values: for an array its shape, for a mapping its keys."""
    if isinstance(value, np.ndarray):
        return value.shape
    if isinstance(value, tuple):
        return tuple(map(_key, value))
    return tuple(value) if isinstance(value, dict) else value


def checked(values: Array, what: str, names: tuple[str, ...]) -> Array:
    """The values as an array (..., len(names)).

    Raises:
        InvalidShape: the last axis does not match.
        InvalidValue: not all values are real numbers.
    """
    try:
        given = np.asarray(values)
        if given.dtype.kind not in "biuf":
            raise ValueError
    except ValueError:
        raise InvalidValue(what, f"{values!r:.80}", f"an array of real numbers (..., {len(names)})") from None
    array = given.astype(float, copy=False)
    if array.ndim == 0 or array.shape[-1] != len(names):
        raise InvalidShape(what, names, array.shape)
    return array


def together(first: Array, second: Array) -> tuple[Array, Array]:
    """Poses (..., n) and joints (..., m) with one leading shape.

    Raises:
        InvalidValue: their leading shapes cannot be broadcast to one shape.
    """
    try:
        lead = np.broadcast_shapes(first.shape[:-1], second.shape[:-1])
    except ValueError:
        found = f"leading shapes {first.shape[:-1]} and {second.shape[:-1]}"
        raise InvalidValue("poses and joints", found, "leading shapes that can be broadcast to one shape") from None
    return np.broadcast_to(first, (*lead, first.shape[-1])), np.broadcast_to(second, (*lead, second.shape[-1]))
