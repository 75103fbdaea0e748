"""Tubes and plates as faces for a drawing in 3-D."""

from __future__ import annotations

import numpy as np

from kinematics import Array, PlacedShape

_SIDES = 12  # of a tube's drawing


def faces(shape: PlacedShape) -> list[Array]:
    """(k, 3) each: the outside of a tube or of a plate, without the rounding of its ends and rim."""
    if len(shape.corners) == 2:
        return _prism(*_rings(shape))
    return _prism(*shape.sides())


def _rings(shape: PlacedShape) -> tuple[Array, Array]:
    """The circles around both ends, as polygons."""
    start, end = shape.corners
    along = end - start
    helper = np.eye(3)[np.abs(along).argmin()]
    first = np.cross(along, helper)
    first /= np.linalg.norm(first) or 1.0
    second = np.cross(along, first)
    second /= np.linalg.norm(second) or 1.0
    angles = np.linspace(0.0, 2 * np.pi, _SIDES, endpoint=False)[:, None]
    ring = shape.around * (np.cos(angles) * first + np.sin(angles) * second)
    return start + ring, end + ring


def _prism(bottom: Array, top: Array) -> list[Array]:
    """All with four corners, as a drawing mixes no others; a triangle of an end has one twice."""
    ends, count = [], len(bottom)
    for corners in (bottom, top):
        ends += [corners[[0, i, i + 1, i + 1]] for i in range(1, count - 1)]
    after = np.roll(np.arange(count), -1)
    return ends + list(np.stack([bottom, bottom[after], top[after], top], axis=1))
