"""Find numerical solutions that are the same, and keep each once."""

from __future__ import annotations

import numpy as np

_EXACT = 1e-9  # distance of solutions that are one, where the equations are regular
_ROUNDING = 1e-14
_DOUBLE = 1e-6  # rounding parts the two poses of a double root by no more


def distinct(apart: np.ndarray, regularity: np.ndarray) -> list[int]:
    """Indices of solutions, each once.

    Args:
        apart: (k, k) distances of the solutions, over their size.
        regularity: (k,) determinant of the equations there, over its largest; towards 0, where a double solution is
            found as two near ones, solutions count as one from farther off.
    """
    blur = _EXACT + _ROUNDING / np.maximum(np.abs(regularity), 1e-8)
    return [i for i in range(len(apart)) if not (apart[i, :i] < blur[i]).any()]


def gaps(poses: np.ndarray, pose: np.ndarray, size: float) -> np.ndarray:
    """(...,) largest difference of poses [x, y, z, ...] (..., n) from one (n,): a length over the size, or an angle."""
    unit = np.ones(pose.shape[-1])
    unit[:3] = size
    largest: np.ndarray = (np.abs(poses - pose) / unit).max(axis=-1)
    return largest


def working_first(poses: np.ndarray, working: np.ndarray, size: float) -> np.ndarray:
    """Poses (k, n) in their order, but the working one (n,) first, if that exists."""
    if not np.isfinite(working).all():
        return poses
    away = gaps(poses, working, size)
    if not away.size or away.min() > _DOUBLE:  # a double root, which rounding lost among the others
        return np.concatenate([working[None], poses])
    nearest = int(away.argmin())
    return np.concatenate([poses[[nearest]], np.delete(poses, nearest, axis=0)])
