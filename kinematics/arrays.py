"""Arrays that come from outside: real numbers of the shape that is asked for."""

from __future__ import annotations

import numpy as np

from kinematics.errors import InvalidShape, InvalidValue

Array = np.ndarray


def checked(values: Array, what: str, names: tuple[str, ...]) -> Array:
    """The values as an array (..., len(names)).

    Raises:
        InvalidShape: the last axis does not match.
        InvalidValue: they are not all real numbers.
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
        InvalidValue: their leading shapes do not go together.
    """
    try:
        lead = np.broadcast_shapes(first.shape[:-1], second.shape[:-1])
    except ValueError:
        found = f"leading shapes {first.shape[:-1]} and {second.shape[:-1]}"
        raise InvalidValue("poses and joints", found, "shapes that go together") from None
    return np.broadcast_to(first, (*lead, first.shape[-1])), np.broadcast_to(second, (*lead, second.shape[-1]))
