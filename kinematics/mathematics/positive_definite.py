"""Symmetric matrices of symbols: their smallest eigenvalue, and what shows that they are positive definite."""

from __future__ import annotations

from functools import reduce

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics.jacobi_rotations import singular_values

_LEAST = 1e-15  # of a diagonal entry: what rounding leaves of a pivot that is 0


def cholesky(matrix: ca.SX) -> ca.SX:
    """(n, n) symmetric -> L, lower triangular, with L L^T the matrix; a pivot that is not above 0 is all but 0."""
    n = matrix.shape[0]
    lower = ca.SX(n, n)
    for j in range(n):
        row = lower[j, :j]
        pivot = ca.sqrt(ca.fmax(matrix[j, j] - ca.sumsqr(row), _LEAST * matrix[j, j]))
        lower[j, j] = pivot
        for i in range(j + 1, n):
            lower[i, j] = (matrix[i, j] - ca.dot(lower[i, :j], row)) / pivot
    return lower


def smallest_eigenvalue(matrix: ca.SX, weight: ca.SX) -> ca.SX:
    """The smallest x for which matrix - x diag(0, weight) is singular, for a positive definite matrix and weight.

    The rows before those of the weight are free: they are eliminated, which is what Cholesky's last rows hold.

    Args:
        matrix: (n, n) symmetric.
        weight: (k, k) symmetric, k <= n.
    """
    k = weight.shape[0]
    factor = cholesky(matrix)[-k:, -k:]
    values = singular_values(factor if weight.is_eye() else lower_solved(cholesky(weight), factor))
    return reduce(ca.fmin, ca.vertsplit(values)) ** 2


def lower_solved(lower: ca.SX, right: ca.SX) -> ca.SX:
    """X (n, k) with L X = right for a lower triangular L (n, n)."""
    rows: list[ca.SX] = []
    for i in range(lower.shape[0]):
        known = [lower[i, j] * rows[j] for j in range(i)]
        rows.append((right[i, :] - sum(known, ca.SX(1, right.shape[1]))) / lower[i, i])
    return ca.vertcat(*rows)


def row_sums(matrix: ca.SX) -> ca.SX:
    """(n,) the diagonal less the moduli beside it: by Gershgorin, positive definite where all are above 0."""
    n = matrix.shape[0]
    return ca.vertcat(*(matrix[i, i] - sum(ca.fabs(matrix[i, j]) for j in range(n) if j != i) for i in range(n)))


def root_inverse(matrices: Array) -> Array:
    """(k, n, n) S with S^T A S the identity where A is positive definite; any numbers elsewhere."""
    usable = np.isfinite(matrices).all(axis=(1, 2))
    eye = np.eye(matrices.shape[1])
    values, vectors = np.linalg.eigh(np.where(usable[:, None, None], matrices, eye))
    size = np.maximum(np.abs(values).max(axis=1, keepdims=True), 1e-200)
    result: Array = vectors / np.sqrt(np.maximum(values, 1e-14 * size))[:, None, :]
    return result
