"""Find limbs that hold the platform along the same line, so that det J_x is zero at every pose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Array
from kinematics.machine import GeometryRecord

ALIKE = 1e-9  # of the robot's size: what differs by no more differs by rounding


def twins(limbs: Array, size: float, tolerance: float = ALIKE) -> tuple[int, int] | None:
    """The first two equal rows, counted from 1; None if all rows differ.

    Args:
        limbs: (m, k) all numbers that decide how a limb holds the platform, in units of `size`.
        size: rows are equal if no number differs by more than `tolerance` times this.
    """
    alike = np.abs(limbs[:, None] - limbs).max(axis=-1) <= tolerance * size
    first, second = np.nonzero(np.triu(alike, 1))
    return (int(first[0]) + 1, int(second[0]) + 1) if len(first) else None


@dataclass(frozen=True)
class HalvesGeometry(GeometryRecord):
    """Of a platform of two halves on limbs 1, 2 and 3, 4, which differ in their `azimuths` (4,) [rad] only.

    With l_1 x l_2 or l_3 x l_4 zero, so is det J_x, a component of (l_1 x l_2) x (l_3 x l_4).

    Raises:
        InvalidGeometry: as for any geometry; or both limbs of a half have the same azimuth.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        azimuths = self.as_dict()["azimuths"]
        directions = np.stack([np.cos(azimuths), np.sin(azimuths)], axis=-1)
        for half in (0, 2):
            if twins(directions[half : half + 2], 1.0):
                reason = f"limbs {half + 1} and {half + 2} coincide, so det J_x is zero at every pose"
                raise self.invalid(
                    "azimuths", azimuths, f"two different directions for each half, modulo 2 pi: {reason}"
                )
