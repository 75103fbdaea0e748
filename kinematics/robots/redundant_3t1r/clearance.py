"""Distances between the arms of the redundant 3T-1R robot, in numbers and in symbols."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics import segment_distances

# Arms that share a platform point have no distance to keep.
_APART = tuple((i, j) for i in range(6) for j in range(i + 1, 6) if i // 2 != j // 2)
_PARALLELOGRAMS = (2, 3)


def arm_distances(rails: Array, platform: Array, width: float) -> dict[tuple[int, int], Array]:
    """{(i, j): (...,) metres} for arms counted from 1, from their ends (..., 3, 6).

    Args:
        width: between the two rods of arms 3 and 4; 0 takes their middle lines [m].
    """
    ends = np.moveaxis(np.stack([rails, platform], axis=-1), (-2, -1), (0, -2))  # (6, ..., 2, 3)
    half = np.array([0.0, 0.0, width / 2])
    lines = [(e - half, e + half) if i in _PARALLELOGRAMS and width else (e,) for i, e in enumerate(ends)]
    return {
        (i + 1, j + 1): np.min([segment_distances(one, two) for one in lines[i] for two in lines[j]], axis=0)
        for i, j in _APART
    }


def arms_apart(rails: ca.SX, platform: ca.SX) -> list[tuple[ca.SX, ca.SX]]:
    """The same 12 pairs as middle lines (3, 2), ends in columns, from their ends (3, 6)."""
    arms = [ca.horzcat(rails[:, i], platform[:, i]) for i in range(6)]
    return [(arms[i], arms[j]) for i, j in _APART]
