"""Path tracking for homogeneous quadratic systems over the complex numbers.

A system is a stack of symmetric matrices, one a quadric: x^T M_k x = 0, k = 1..n-1, in the n homogeneous coordinates
of x, which come in two blocks. Along a path the matrices are a polynomial of degree two in t,
M(t) = M_0 + t M_1 + t^2 M_2, and each solution at t = 0 is followed to t = 1 by a Runge-Kutta predictor and Newton's
method, both on the patch orthogonal to the current point, so that no coordinate has to stay away from zero. Each block
is measured by its own norm: a path may pass near a point where one of them vanishes. The kernel is compiled once per
machine and then cached.
"""

from __future__ import annotations

import numba
import numpy as np

from kinematics.arrays import Array

CORRECTION = 1e-3  # the largest first Newton step after a prediction, blocks having norm 1: or the path might be left
CONVERGED = 1e-6  # the Newton step that ends a correction: the error left is about its square
SHORTEST = 1e-13  # a step in t below this means that the path runs into a singular end
STEPS = 20_000


def track(path: Array, starts: Array, block: int, correction: float = CORRECTION) -> tuple[Array, Array]:
    """Follow solutions from t = 0 to t = 1.

    Args:
        path: (3, n - 1, n, n) M_0, M_1 and M_2, complex and symmetric.
        starts: (k, n) solutions of M_0.
        block: how many coordinates the first block has.
        correction: the largest first Newton step that is accepted, for blocks of norm 1.

    Returns:
        (k, n) ends of norm 1 and (k,) the t that each path came to: 1 where it arrived; less where its steps shrank to
        nothing, as before a singular end. There, the end is the last point on it.
    """
    path, starts = (np.ascontiguousarray(a, dtype=complex) for a in (path, starts))
    result: tuple[Array, Array] = _track(path, starts, block, float(correction))
    return result


def refine(system: Array, points: Array, block: int, iterations: int = 5) -> tuple[Array, Array]:
    """Newton's method at points near solutions of one system.

    Args:
        system: (n - 1, n, n) symmetric matrices.
        points: (k, n).
        block: how many coordinates the first block has.

    Returns:
        (k, n) points of norm 1 and (k,) the last Newton step, for blocks of norm 1: NaN where the Jacobian is singular.
    """
    path = np.zeros((3, *system.shape), dtype=complex)
    path[0] = system
    result: tuple[Array, Array] = _refine(path, np.ascontiguousarray(points, dtype=complex), block, iterations)
    return result


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _track(path, starts, block, correction):  # type: ignore[no-untyped-def]
    count, n = starts.shape
    ends, reached = starts.copy(), np.zeros(count)
    slope, rows = np.empty((4, n), dtype=np.complex128), np.empty((n, n + 1), dtype=np.complex128)
    for k in range(count):
        x = starts[k] / np.linalg.norm(starts[k])
        t, step, good = 0.0, 0.02, 0
        for _ in range(STEPS):
            step = min(step, 1.0 - t)
            trial = _predict(path, x, block, t, step, slope, rows)
            if _correct(path, trial, x, block, t + step, rows, correction):
                x = trial / np.linalg.norm(trial)
                t = 1.0 if step == 1.0 - t else t + step
                good += 1
                if t >= 1.0:
                    break
                if good >= 3:
                    step, good = 2.0 * step, 0
            else:
                step, good = 0.5 * step, 0
                if step < SHORTEST:
                    break
        ends[k], reached[k] = x, t
    return ends, reached


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _refine(path, points, block, iterations):  # type: ignore[no-untyped-def]
    count, n = points.shape
    ends, last = points.copy(), np.full(count, np.nan)
    rows = np.empty((n, n + 1), dtype=np.complex128)
    for k in range(count):
        x = points[k] / np.linalg.norm(points[k])
        for _ in range(iterations):
            weight = _weight(x, block)
            _fill(path, x, x, weight, 0.0, rows, True)
            if not _solve(rows):
                last[k] = np.nan
                break
            x -= weight * rows[:, n]
            last[k] = np.linalg.norm(rows[:, n])
            x /= np.linalg.norm(x)
        ends[k] = x
    return ends, last


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _predict(path, x, block, t, step, slope, rows):  # type: ignore[no-untyped-def]
    """The classical Runge-Kutta step along dx/dt = -H_x^-1 H_t."""
    weight = _weight(x, block)
    for stage in range(4):
        part = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
        point = x if stage == 0 else x + part * step * slope[stage - 1]
        _fill(path, point, x, weight, t + part * step, rows, False)
        if not _solve(rows):
            slope[stage] = 0.0
        else:
            slope[stage] = -weight * rows[:, x.shape[0]]
    return x + step / 6.0 * (slope[0] + 2.0 * slope[1] + 2.0 * slope[2] + slope[3])


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _correct(path, x, patch, block, t, rows, correction):  # type: ignore[no-untyped-def]
    """Newton's method at t, in place; False unless it converges as fast as on a regular path."""
    n = x.shape[0]
    weight, bound = _weight(patch, block), correction
    for _ in range(4):
        _fill(path, x, patch, weight, t, rows, True)
        if not _solve(rows):
            return False
        size = np.linalg.norm(rows[:, n])
        if not size <= bound:
            return False
        x -= weight * rows[:, n]
        if size <= CONVERGED:
            return True
        bound = max(0.01 * size, CONVERGED)
    return False


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _weight(x, block):  # type: ignore[no-untyped-def]
    """(n,) the norm of the block that each coordinate belongs to."""
    weight = np.empty(x.shape[0])
    weight[:block], weight[block:] = np.linalg.norm(x[:block]), np.linalg.norm(x[block:])
    return weight


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _fill(path, x, patch, weight, t, rows, newton):  # type: ignore[no-untyped-def]
    """The Jacobian's rows 2 x^T M(t), below them the patch's; to the right the residual or its derivative by t.

    Columns are in units of the weights, and each row is divided by its largest entry.
    """
    n = x.shape[0]
    for k in range(n - 1):
        total, largest = 0.0j, 1e-300
        for i in range(n):
            entry, moving = 0.0j, 0.0j
            for j in range(n):
                m1, m2 = path[1, k, i, j], path[2, k, i, j]
                entry += (path[0, k, i, j] + t * (m1 + t * m2)) * x[j]
                if not newton:
                    moving += (m1 + 2.0 * t * m2) * x[j]
            rows[k, i] = 2.0 * weight[i] * entry
            largest = max(largest, abs(rows[k, i]))
            total += (entry if newton else moving) * x[i]
        rows[k, n] = total
        for i in range(n + 1):
            rows[k, i] /= largest
    for i in range(n):
        rows[n - 1, i] = np.conj(patch[i]) / weight[i]
    rows[n - 1, n] = 0.0


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _solve(rows):  # type: ignore[no-untyped-def]
    """Gaussian elimination with row pivots; the last column becomes the solution."""
    n = rows.shape[0]
    for p in range(n):
        best, size = p, 0.0
        for i in range(p, n):
            magnitude = abs(rows[i, p].real) + abs(rows[i, p].imag)
            if magnitude > size:
                best, size = i, magnitude
        if not size > 0.0:
            return False
        if best != p:
            for j in range(p, n + 1):
                rows[p, j], rows[best, j] = rows[best, j], rows[p, j]
        inverse = 1.0 / rows[p, p]
        for j in range(p, n + 1):
            rows[p, j] *= inverse
        for i in range(p + 1, n):
            factor = rows[i, p]
            for j in range(p + 1, n + 1):
                rows[i, j] -= factor * rows[p, j]
    for p in range(n - 2, -1, -1):
        for j in range(p + 1, n):
            rows[p, n] -= rows[p, j] * rows[j, n]
    return True
