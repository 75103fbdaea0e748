"""The interior point: the squared rate x of least time under `Rows`, in numba, without a general sparse solver.

Unknowns are x and w = x' / 2 at the knots of u, a cubic between; the time is the integral of 1 / sqrt(x). Every iterate
keeps every row strictly, so each is a motion. A row that is not linear is met by its tangent: that of the jerk,
|linear| <= 1 / sqrt(x), and those with sqrt(x) ahead of it are kept by what keeps their tangents, so that a step needs
no search; the others are convex. Their curvature is left out where it is negative. Neighbours alone are coupled: the
Newton matrix has three diagonals below its own, but for the mean square torque, which adds one rank a joint.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from trajectory.jerk.banded import LEAD, factorise, solve_factorised
from trajectory.jerk.rows import PARTS, Array, Rows

_STATIONS = PARTS + 1  # of each interval
_WEIGHTS = np.array([1.0, 3.0, 3.0, 1.0]) / 8.0  # of their integral: Simpson's 3/8
_TO_EDGE = 0.95  # share of the way to the nearest row that a step goes
_BACK = 0.7  # of a step that broke a row
_TRIES = 40
_LEAST_CURVATURE = 0.1  # of the time's, which a mean square torque can use up
SOLVED, OUTSIDE, SINGULAR, STUCK, SLOW = 0, 1, 2, 3, 4

COMPILED = {"cache": True, "error_model": "numpy", "fastmath": {"contract", "reassoc", "nsz", "arcp"}}


class Outcome(NamedTuple):
    """How a search ended: one of the statuses above, its steps, the time and what it is at most above the least."""

    status: int
    steps: int
    time: float
    gap: float


@njit(**COMPILED)
def cubic_basis(at: float, size: float, out: Array) -> None:
    """(3, 4): x, w and z at a share of an interval of that size, by x and w at its start and at its end."""
    square, cube = at * at, at * at * at
    out[0, 0], out[0, 2] = 1.0 - 3.0 * square + 2.0 * cube, 3.0 * square - 2.0 * cube
    out[0, 1], out[0, 3] = 2.0 * size * (at - 2.0 * square + cube), 2.0 * size * (cube - square)
    out[1, 0] = 3.0 * (square - at) / size
    out[1, 2] = -out[1, 0]
    out[1, 1], out[1, 3] = 1.0 - 4.0 * at + 3.0 * square, 3.0 * square - 2.0 * at
    out[2, 0] = (6.0 * at - 3.0) / size**2
    out[2, 2] = -out[2, 0]
    out[2, 1], out[2, 3] = (6.0 * at - 4.0) / size, (6.0 * at - 2.0) / size


@njit(**COMPILED)
def _all_bases(sizes: Array) -> Array:
    found = np.empty((sizes.size, _STATIONS, 3, 4))
    for k in range(sizes.size):
        for i in range(_STATIONS):
            cubic_basis(i / PARTS, sizes[k], found[k, i])
    return found


@njit(**COMPILED)
def _states(bases: Array, y: Array, out: Array) -> None:
    """x, w and z at the stations."""
    for k in range(bases.shape[0]):
        a, b, c, d = y[2 * k], y[2 * k + 1], y[2 * k + 2], y[2 * k + 3]
        for i in range(_STATIONS):
            base = bases[k, i]
            for e in range(3):
                out[k, i, e] = base[e, 0] * a + base[e, 1] * b + base[e, 2] * c + base[e, 3] * d


@njit(**COMPILED)
def _slacks(states: Array, rows: Rows, tight: Array, out: Array) -> float:
    """What is left of each row; the least of it, of x too, over all stations."""
    least = math.inf
    forces, joints, tools = rows.force.shape[1], rows.jerk.shape[1], rows.tool.shape[1]
    for k in range(states.shape[0]):
        for i in range(_STATIONS):
            g = PARTS * k + i
            x, w, z = states[k, i, 0], states[k, i, 1], states[k, i, 2]
            if not x > 0.0:
                return -1.0
            root = math.sqrt(x)
            left, t = out[k, i], tight[k]
            for j in range(forces):
                c = rows.force[g, j]
                value, most = c[0] * w + c[1] * x + c[2] * root + c[3], t[j] - c[4] * root - c[5]
                left[2 * j], left[2 * j + 1] = most - value, most + value
            at = 2 * forces
            for j in range(joints):
                c = rows.jerk[g, j]
                value, most = c[0] * z + c[1] * w + c[2] * x, t[forces + j] / root
                left[at + 2 * j], left[at + 2 * j + 1] = most - value, most + value
            at += 2 * joints
            left[at] = rows.most[g] * t[forces + joints] - x
            for j in range(tools):
                c = rows.tool[g, j]
                left[at + 1] = t[forces + joints + 1] - (c[0] * w * w + c[1] * w * x + c[2] * x * x)
            for e in range(left.size):
                least = min(least, left[e])
    return least


@njit(**COMPILED)
def _means(states: Array, sizes: Array, rows: Rows, tight: Array, out: Array) -> float:
    """What is left of each mean square torque, integrated; the least of them."""
    out[:] = 0.0
    for k in range(sizes.size):
        for i in range(_STATIONS):
            x, w = states[k, i, 0], states[k, i, 1]
            root = math.sqrt(x)
            share = _WEIGHTS[i] * sizes[k] / root
            for j in range(out.size):
                c = rows.mean[PARTS * k + i, j]
                out[j] += share * (tight[j] - (c[0] * w + c[1] * x + c[2] * root + c[3]) ** 2)
    least = math.inf
    for j in range(out.size):
        least = min(least, out[j])
    return least


@njit(**COMPILED)
def _gradients(states: Array, rows: Rows, tight: Array, out: Array) -> None:
    """Of each row's use by x, w and z."""
    forces, joints, tools = rows.force.shape[1], rows.jerk.shape[1], rows.tool.shape[1]
    out[:] = 0.0
    for k in range(states.shape[0]):
        for i in range(_STATIONS):
            g = PARTS * k + i
            x, w = states[k, i, 0], states[k, i, 1]
            half, steep, of = 0.5 / math.sqrt(x), 0.5 / (x * math.sqrt(x)), out[k, i]
            for j in range(forces):
                c = rows.force[g, j]
                of[2 * j, 0], of[2 * j, 1] = c[1] + (c[4] + c[2]) * half, c[0]
                of[2 * j + 1, 0], of[2 * j + 1, 1] = (c[4] - c[2]) * half - c[1], -c[0]
            at = 2 * forces
            for j in range(joints):
                c, edge = rows.jerk[g, j], tight[k, forces + j] * steep
                of[at, 0], of[at, 1], of[at, 2] = c[2] + edge, c[1], c[0]
                of[at + 1, 0], of[at + 1, 1], of[at + 1, 2] = edge - c[2], -c[1], -c[0]
                at += 2
            of[at, 0] = 1.0
            for j in range(tools):
                c = rows.tool[g, j]
                of[at + 1, 0], of[at + 1, 1] = c[1] * w + 2.0 * c[2] * x, 2.0 * c[0] * w + c[1] * x


@njit(**COMPILED)
def _row_curvature(x: float, duals: Array, force: Array, tool: Array, local: Array) -> None:
    """Of the rows whose curvature is positive: sqrt(x) that helps, and the tool's acceleration."""
    cube = 0.25 / (x * math.sqrt(x))
    for j in range(force.shape[0]):
        for side in range(2):
            by_root = force[j, 4] + (force[j, 2] if side == 0 else -force[j, 2])
            local[0] += max(-by_root, 0.0) * duals[2 * j + side] * cube
    for j in range(tool.shape[0]):
        dual = duals[duals.size - 1]
        local[0] += 2.0 * tool[j, 2] * dual
        local[1] += tool[j, 1] * dual
        local[2] += 2.0 * tool[j, 0] * dual


@njit(**COMPILED)
def _mean_terms(
    share: float, x: float, w: float, mean: Array, tight: Array, duals: Array, local: Array, slopes: Array
) -> None:
    """The curvature of the mean squares' convex part, and their slopes by x and w (m, 2)."""
    root = math.sqrt(x)
    for j in range(mean.shape[0]):
        c = mean[j]
        value, by_x, by_w = c[0] * w + c[1] * x + c[2] * root + c[3], c[1] + 0.5 * c[2] / root, c[0]
        slopes[j, 0] = share * (2.0 * value * by_x - 0.5 * (value * value - tight[j]) / x)
        slopes[j, 1] = share * 2.0 * value * by_w
        scale, tilted = 2.0 * duals[j] * share, by_x - 0.5 * value / x
        local[0] += scale * (tilted * tilted + 0.125 * (value / x) ** 2)
        local[1] += scale * tilted * by_w
        local[2] += scale * by_w * by_w


@njit(**COMPILED)
def _assemble(
    states: Array,
    bases: Array,
    sizes: Array,
    rows: Rows,
    slack: Array,
    dual: Array,
    gradient: Array,
    mean_tight: Array,
    mean_dual: Array,
    target: float,
    band: Array,
    right: Array,
    mean_gradient: Array,
) -> float:
    """Newton's matrix and right-hand side without the mean squares' ranks; the time."""
    band[:], right[:], mean_gradient[:], time = 0.0, 0.0, 0.0, 0.0
    bend = max(1.0 - (mean_dual * mean_tight).sum(), _LEAST_CURVATURE)
    local, force, slopes = np.empty(6), np.empty(3), np.empty((mean_dual.size, 2))
    for k in range(sizes.size):
        for i in range(_STATIONS):
            x = states[k, i, 0]
            share = _WEIGHTS[i] * sizes[k] / math.sqrt(x)
            time += share
            local[:], force[:] = 0.0, 0.0
            local[0], force[0] = 0.75 * bend * share / (x * x), 0.5 * share / x
            for e in range(slack.shape[2]):
                left, a, b, c = slack[k, i, e], gradient[k, i, e, 0], gradient[k, i, e, 1], gradient[k, i, e, 2]
                inverse = 1.0 / left
                pull, q = target * inverse, dual[k, i, e] * inverse
                force[0] -= pull * a
                force[1] -= pull * b
                force[2] -= pull * c
                local[0] += q * a * a
                local[1] += q * a * b
                local[2] += q * b * b
                local[3] += q * a * c
                local[4] += q * b * c
                local[5] += q * c * c
            g = PARTS * k + i
            _row_curvature(x, dual[k, i], rows.force[g], rows.tool[g], local)
            _mean_terms(share, x, states[k, i, 1], rows.mean[g], mean_tight, mean_dual, local, slopes)
            base, at = bases[k, i], LEAD + 2 * k
            for a in range(4):
                x_a, w_a, z_a = base[0, a], base[1, a], base[2, a]
                right[at + a] += force[0] * x_a + force[1] * w_a + force[2] * z_a
                by_x = local[0] * x_a + local[1] * w_a + local[3] * z_a
                by_w = local[1] * x_a + local[2] * w_a + local[4] * z_a
                by_z = local[3] * x_a + local[4] * w_a + local[5] * z_a
                for b in range(a + 1):
                    band[at + a, 3 - a + b] += by_x * base[0, b] + by_w * base[1, b] + by_z * base[2, b]
                for j in range(mean_dual.size):
                    mean_gradient[j, at + a] += slopes[j, 0] * x_a + slopes[j, 1] * w_a
    return time


@njit(**COMPILED)
def _newton_step(
    band: Array, right: Array, mean_gradient: Array, mean_slack: Array, mean_dual: Array, target: float
) -> bool:
    """The step in place of the right-hand side; each mean square torque adds its rank (Woodbury)."""
    if not factorise(band):
        return False
    count = mean_slack.size
    for j in range(count):
        right -= target / mean_slack[j] * mean_gradient[j]
    solve_factorised(band, right)
    if count:
        small, apart = np.empty((count, count)), np.empty((count, right.size))
        for j in range(count):
            apart[j] = mean_gradient[j]
            solve_factorised(band, apart[j])
        for i in range(count):
            for j in range(count):
                small[i, j] = (mean_gradient[i] * apart[j]).sum()
            small[i, i] += mean_slack[i] / mean_dual[i]
        along = np.array([(mean_gradient[j] * right).sum() for j in range(count)])
        share = np.linalg.solve(small, along)
        for j in range(count):
            right -= share[j] * apart[j]
    return True


@njit(**COMPILED)
def _to_the_edge(value: float, change: float, size: float) -> float:
    """The share of a change, at most `size`, that leaves a little of a positive value."""
    return -_TO_EDGE * value / change if -change * size > _TO_EDGE * value else size


@njit(**COMPILED)
def _dual_step(
    moved: Array, states: Array, slack: Array, dual: Array, gradient: Array, target: float, change: Array
) -> tuple[float, float]:
    """The change of the duals, and how far x and duals can go along their changes."""
    primal, of_dual = 1.0, 1.0
    for k in range(slack.shape[0]):
        for i in range(_STATIONS):
            x, w, z = moved[k, i, 0], moved[k, i, 1], moved[k, i, 2]
            primal = _to_the_edge(states[k, i, 0], x, primal)
            for e in range(slack.shape[2]):
                left, d = slack[k, i, e], dual[k, i, e]
                fall = -(gradient[k, i, e, 0] * x + gradient[k, i, e, 1] * w + gradient[k, i, e, 2] * z)
                change[k, i, e] = (target - d * fall) / left - d
                primal = _to_the_edge(left, fall, primal)
                of_dual = _to_the_edge(d, change[k, i, e], of_dual)
    return primal, of_dual


@njit(**COMPILED)
def keeping(sizes: Array, rows: Rows, tight: Array, mean_tight: Array, y: Array) -> float:
    """The share of a motion's squared rate, below 1, that keeps all the rows strictly; 0 where none is found."""
    bases, states = _all_bases(sizes), np.empty((sizes.size, _STATIONS, 3))
    slack = np.empty((sizes.size, _STATIONS, row_count(rows)))
    mean_slack, given = np.empty(mean_tight.size), 0.005
    for _ in range(_TRIES):
        share = 1.0 - given if given < 0.7 else 0.7 * 0.64 / given
        _states(bases, y * share, states)
        if _slacks(states, rows, tight, slack) > 0.0 and _means(states, sizes, rows, mean_tight, mean_slack) > 0.0:
            return share
        given *= 2.0
    return 0.0


@njit(**COMPILED)
def row_count(rows: Rows) -> int:
    """At each station."""
    return 2 * rows.force.shape[1] + 2 * rows.jerk.shape[1] + 1 + rows.tool.shape[1]


@njit(**COMPILED)
def search(
    sizes: Array,
    rows: Rows,
    tight: Array,
    mean_tight: Array,
    y: Array,
    dual: Array,
    mean_dual: Array,
    barrier: float,
    tolerance: float,
    most_steps: int,
) -> tuple[int, int, float, float]:
    """Descend from a motion that keeps the rows strictly.

    Args:
        sizes: (n,) of the intervals of u.
        rows: at their stations.
        tight: (n, f + m + 1 + c) what each interval's rows are kept to: forces, jerks, x, tool.
        mean_tight: (m or 0,) what the mean squares are kept to.
        y: (2 n + 2,) x and w at the knots; the answer comes in its place.
        dual, mean_dual: at least these, of a problem that is close; 0 is none. The answer's come in their place.
        barrier: product of each row's slack and dual at the start.
        tolerance: of the time, relative.
        most_steps: before it gives up.

    Returns:
        As `Outcome`.
    """
    n, count = sizes.size, rows.mean.shape[1]
    shape = (n, _STATIONS, row_count(rows))
    bases, states, tried, moved = _all_bases(sizes), np.empty((n, _STATIONS, 3)), np.empty((n, _STATIONS, 3)), np.empty((n, _STATIONS, 3))
    slack, next_slack, gradient, change = np.empty(shape), np.empty(shape), np.empty((*shape, 3)), np.empty(shape)
    mean_slack, next_mean = np.empty(count), np.empty(count)
    band, right, mean_gradient = np.empty((2 * n + 2 + LEAD, 4)), np.empty(2 * n + 2 + LEAD), np.empty((count, 2 * n + 2 + LEAD))
    _states(bases, y, states)
    if not (_slacks(states, rows, tight, slack) > 0.0 and _means(states, sizes, rows, mean_tight, mean_slack) > 0.0):
        return OUTSIDE, 0, math.nan, math.nan
    dual[:], mean_dual[:] = np.maximum(dual, barrier / slack), np.maximum(mean_dual, barrier / mean_slack)
    centring, time, gap = 0.15, math.nan, math.nan
    for step in range(most_steps):
        gap = (slack * dual).sum() + (mean_slack * mean_dual).sum()
        target = centring * gap / (slack.size + count)
        _gradients(states, rows, tight, gradient)
        time = _assemble(
            states, bases, sizes, rows, slack, dual, gradient, mean_tight, mean_dual, target, band, right, mean_gradient
        )
        if step and gap <= tolerance * time:
            return SOLVED, step, time, gap
        if not _newton_step(band, right, mean_gradient, mean_slack, mean_dual, target):
            return SINGULAR, step, time, gap
        _states(bases, right[LEAD:], moved)
        primal, of_dual = _dual_step(moved, states, slack, dual, gradient, target, change)
        mean_change = np.empty(count)
        for j in range(count):
            fall = -(mean_gradient[j] * right).sum()
            mean_change[j] = (target - mean_dual[j] * fall) / mean_slack[j] - mean_dual[j]
            primal = _to_the_edge(mean_slack[j], fall, primal)
            of_dual = _to_the_edge(mean_dual[j], mean_change[j], of_dual)
        inside = False
        for _ in range(_TRIES):
            tried[:] = states + primal * moved
            inside = (
                _slacks(tried, rows, tight, next_slack) > 0.0
                and _means(tried, sizes, rows, mean_tight, next_mean) > 0.0
            )
            if inside:
                break
            primal *= _BACK
        if not inside:
            return STUCK, step, time, gap
        y += primal * right[LEAD:]
        states[:], slack[:], mean_slack[:] = tried, next_slack, next_mean
        dual += of_dual * change
        mean_dual += of_dual * mean_change
        reached = min(primal, of_dual)
        centring = 0.05 if reached > 0.9 else (0.15 if reached > 0.6 else (0.3 if reached > 0.3 else 0.6))
    return SLOW, most_steps, time, gap
