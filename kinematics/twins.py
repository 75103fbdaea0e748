"""Limbs that are alike: both hold the platform along the same line, so that det J_x vanishes at every pose."""

from __future__ import annotations

import numpy as np

Array = np.ndarray

ALIKE = 1e-9  # of the robot's size: what differs by no more differs by rounding


def twins(limbs: Array, size: float, tolerance: float = ALIKE) -> tuple[int, int] | None:
    """The first two equal rows, counted from 1; None where all differ.

    Args:
        limbs: (m, k) all that makes a limb hold the platform as it does, in units of `size`.
        size: rows are equal where no number differs by more than `tolerance` times this.
    """
    alike = np.abs(limbs[:, None] - limbs).max(axis=-1) <= tolerance * size
    first, second = np.nonzero(np.triu(alike, 1))
    return (int(first[0]) + 1, int(second[0]) + 1) if len(first) else None


def twins_of_halves(azimuths: Array) -> tuple[int, int] | None:
    """As `twins`, for a platform of two halves on limbs 1, 2 and 3, 4 that differ in their azimuths (4,) [rad] only.

    With l_1 x l_2 or l_3 x l_4 zero, so is det J_x, a component of (l_1 x l_2) x (l_3 x l_4).
    """
    directions = np.stack([np.cos(azimuths), np.sin(azimuths)], axis=-1)
    for half in (0, 2):
        if twins(directions[half : half + 2], 1.0):
            return half + 1, half + 2
    return None
