"""How near the axes of the redundant 3T-1R robot's arms come to each other."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics import segment_distances

# Arms that meet at a platform point have no distance to keep.
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
