"""Small symbolic linear algebra without divisions, so that it stays exact on singularities."""

from __future__ import annotations

from itertools import combinations

import casadi as ca


class Minors:
    """Every minor of a matrix, each computed once by expansion along its first or its last row.

    Which of the two leaves rows of one half of the matrix, so that few small minors serve all large ones: an adjugate
    of a 4 x 4 matrix costs twelve 2 x 2 minors and forty-eight products. Structural zeros cost none.

    Args:
        matrix: (m, n).
        symmetric: the matrix is its own transpose; then a minor serves its transpose too.
    """

    def __init__(self, matrix: ca.SX, symmetric: bool = False) -> None:
        self.matrix, self._symmetric = matrix, symmetric
        self._known: dict[tuple[tuple[int, ...], tuple[int, ...]], ca.SX] = {}

    def minor(self, rows: tuple[int, ...], columns: tuple[int, ...]) -> ca.SX:
        """Determinant of the submatrix with these rows and columns."""
        if not rows:
            return ca.SX(1)
        if self._symmetric and columns < rows:
            rows, columns = columns, rows
        key = (rows, columns)
        if key not in self._known:
            last = 2 * rows[len(rows) // 2] < self.matrix.shape[0]
            along, others = (rows[-1], rows[:-1]) if last else (rows[0], rows[1:])
            sign = (-1) ** (len(rows) - 1) if last else 1
            total = ca.SX(0)
            for place, column in enumerate(columns):
                entry = self.matrix[along, column]
                if entry.is_zero():
                    continue
                rest = self.minor(others, columns[:place] + columns[place + 1 :])
                total += sign * (-1) ** place * (entry * rest)
            self._known[key] = total
        return self._known[key]


def determinant(matrix: ca.SX) -> ca.SX:
    """Determinant of a square matrix by shared minors."""
    everything = tuple(range(matrix.shape[0]))
    return Minors(matrix).minor(everything, everything)


def volume(matrix: ca.SX) -> ca.SX:
    """sqrt(det(A^T A)) of an m x n matrix, m >= n: the product of its singular values, |det A| where it is square.

    By Cauchy and Binet it is the norm of all n x n minors, which keeps the digits that forming A^T A would lose.
    """
    m, n = matrix.shape
    if m == n:
        return ca.fabs(determinant(matrix))
    minors, columns = Minors(matrix), tuple(range(n))
    return ca.norm_2(ca.vertcat(*(minors.minor(rows, columns) for rows in combinations(range(m), n))))


def adjugate(matrix: ca.SX, symmetric: bool = False) -> tuple[ca.SX, ca.SX]:
    """Adjugate and determinant of a square matrix: matrix @ adjugate = determinant * identity."""
    n = matrix.shape[0]
    minors = Minors(matrix, symmetric)
    everything = tuple(range(n))
    result = ca.SX(n, n)
    for row, column in ((r, c) for r in everything for c in everything):
        rows, columns = (everything[:i] + everything[i + 1 :] for i in (row, column))
        result[column, row] = (-1) ** (row + column) * minors.minor(rows, columns)
    return result, minors.minor(everything, everything)
