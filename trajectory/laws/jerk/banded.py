"""Cholesky's factors of a symmetric matrix with three diagonals below its own, in numba.

A matrix of n rows is an array (n + 3, 4): row i + 3 holds the entries (i, i - 3) to (i, i), and three rows of the unit
matrix stand before the first one, so that no row is a special case.
"""

from __future__ import annotations

import math

from kinematics import Array
from trajectory.laws.jerk.compiled import compiled

LEAD = 3  # rows before the first one


@compiled
def factorise(band: Array) -> bool:
    """Replace the matrix by its factor; returns False if the matrix is not positive definite."""
    band[:LEAD] = 0.0
    band[:LEAD, 3] = 1.0
    for i in range(LEAD, band.shape[0]):
        far = band[i, 0] / band[i - 3, 3]
        middle = (band[i, 1] - far * band[i - 2, 2]) / band[i - 2, 3]
        near = (band[i, 2] - far * band[i - 1, 1] - middle * band[i - 1, 2]) / band[i - 1, 3]
        rest = band[i, 3] - far * far - middle * middle - near * near
        if not rest > 0.0:
            return False
        band[i, 0], band[i, 1], band[i, 2], band[i, 3] = far, middle, near, math.sqrt(rest)
    return True


@compiled
def solve_factorised(factor: Array, x: Array) -> None:
    """Solve in place for a right-hand side (n + 3,) whose first three entries are 0."""
    for i in range(LEAD, x.size):
        below = factor[i, 0] * x[i - 3] + factor[i, 1] * x[i - 2] + factor[i, 2] * x[i - 1]
        x[i] = (x[i] - below) / factor[i, 3]
    last = x.size - 1
    for i in range(last, LEAD - 1, -1):
        above = 0.0
        if i + 1 <= last:
            above += factor[i + 1, 2] * x[i + 1]
        if i + 2 <= last:
            above += factor[i + 2, 1] * x[i + 2]
        if i + 3 <= last:
            above += factor[i + 3, 0] * x[i + 3]
        x[i] = (x[i] - above) / factor[i, 3]
