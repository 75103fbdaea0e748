"""Singular values of a small matrix of symbols, by Jacobi's rotations of its columns (Hestenes 1958)."""

from __future__ import annotations

from itertools import combinations

import casadi as ca

_MORE, _MOST = 2, 7  # sweeps: one more than were needed for 4000 matrices of 2, 3, 4 and 6 columns, far apart or alike
_ALIKE = 1e-13  # of their squares: columns so alike are hardly rotated, and their gradient is a number
_TINY = 1e-300  # in place of 0, where two columns have no length


def singular_values(matrix: ca.SX) -> ca.SX:
    """(m, n) with m >= n -> (n,) singular values in no order.

    Pairs of columns are rotated until all are square to each other; their lengths are then the singular values. Nothing
    is squared into A^T A, so small ones keep their digits.
    """
    columns = [matrix[:, k] for k in range(matrix.shape[1])]
    for _ in range(min(len(columns) + _MORE, _MOST)):
        for p, q in combinations(range(len(columns)), 2):
            u, v = columns[p], columns[q]
            gap, product = ca.sumsqr(v) - ca.sumsqr(u), ca.dot(u, v)
            alike = _ALIKE * (ca.sumsqr(u) + ca.sumsqr(v))
            root = ca.fabs(gap) + ca.sqrt(gap**2 + 4 * product**2 + alike**2)
            tangent = ca.if_else(gap < 0, -2, 2) * product / (root + _TINY)
            cosine = 1 / ca.sqrt(1 + tangent**2)
            columns[p], columns[q] = cosine * (u - tangent * v), cosine * (tangent * u + v)
    return ca.vertcat(*(ca.norm_2(column) for column in columns))
