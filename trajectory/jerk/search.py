"""The interior point: the squared rate x of least time under `Rows`, in numba, without a general sparse solver.

Unknowns are x and w = x' / 2 at the knots of u, a cubic between; the time is the integral of 1 / sqrt(x). Every iterate
keeps every row strictly, so each is a motion; mean squares are met at the end alone. A row that is not linear is met by
its tangent: that of the jerk, |linear| <= 1 / sqrt(x), and those with sqrt(x) ahead of it are kept by what keeps their
tangents, so that a step needs no search; the others are convex. Their curvature is left out where it is negative.
Neighbours alone are coupled: the Newton matrix has three diagonals below its own, but for the mean square torque, which
adds one rank a joint.
"""

from __future__ import annotations

import math

import numpy as np

from trajectory.jerk.banded import LEAD
from trajectory.jerk.compiled import compiled
from trajectory.jerk.newton import assemble, room_for, solve_step
from trajectory.jerk.rows import Array, Rows
from trajectory.jerk.stations import (
    STATIONS,
    all_bases,
    gradients_of,
    means_of,
    row_count,
    slacks_of,
    states_of,
)

SOLVED, OUTSIDE, SINGULAR, STUCK, SLOW = 0, 1, 2, 3, 4
_TO_EDGE = 0.95  # share of the way to the nearest row that a step goes
_MEAN_SLACK = 1e-2  # in units of the time: what a mean square has left at first, at least
_BACK = 0.7  # of a step that broke a row
_TRIES = 40


@compiled
def _to_the_edge(value: float, change: float, size: float) -> float:
    """The share of a change, at most `size`, that leaves a little of a positive value."""
    return -_TO_EDGE * value / change if -change * size > _TO_EDGE * value else size


@compiled
def _dual_step(
    moved: Array,
    states: Array,
    slack: Array,
    dual: Array,
    gradient: Array,
    target: float,
    loosened: float,
    change: Array,
) -> tuple[float, float]:
    """The change of the duals, and how far x and duals can go along their changes, the rows being loosened."""
    fastest_fall, fastest_dual = _TO_EDGE, _TO_EDGE
    for k in range(slack.shape[0]):
        for i in range(STATIONS):
            x, w, z = moved[k, i, 0], moved[k, i, 1], moved[k, i, 2]
            fastest_fall = max(fastest_fall, -x / states[k, i, 0])
            falls, duals = _row_steps(x, w, z, loosened, slack[k, i], dual[k, i], gradient[k, i], target, change[k, i])
            fastest_fall, fastest_dual = max(fastest_fall, falls), max(fastest_dual, duals)
    return _TO_EDGE / fastest_fall, _TO_EDGE / fastest_dual


@compiled
def _row_steps(
    x: float,
    w: float,
    z: float,
    loosened: float,
    slack: Array,
    dual: Array,
    gradient: Array,
    target: float,
    change: Array,
) -> tuple[float, float]:
    """Of one station: the change of the duals; the largest shares that slacks and duals lose."""
    by_x, by_w, by_z, by_tight = gradient
    falls, duals = 0.0, 0.0
    for e in range(slack.size):
        inverse = 1.0 / slack[e]
        fall = by_x[e] * x + by_w[e] * w + by_z[e] * z - by_tight[e] * loosened
        change[e] = (target + dual[e] * fall) * inverse - dual[e]
        lost, lost_dual = fall * inverse, -change[e] / dual[e]
        falls = lost if lost > falls else falls
        duals = lost_dual if lost_dual > duals else duals
    return falls, duals


@compiled
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
    loose: float,
    price: float,
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
        loose: what is added to all that the rows are kept to.
        price: of that, in units of the time; then it is lowered too, and the search ends where none of it is left.
            With 0 it stays.

    Returns:
        How it ended, SOLVED or another, after how many steps; the time, and how far above the least it is at most.
    """
    n, count = sizes.size, rows.mean.shape[1]
    shape = (n, STATIONS, row_count(rows))
    bases, slack, next_slack = all_bases(sizes), np.empty(shape), np.empty(shape)
    states, tried, moved = np.empty((n, STATIONS, 3)), np.empty((n, STATIONS, 3)), np.empty((n, STATIONS, 3))
    gradient, change, equations = np.empty((n, STATIONS, 4, shape[2])), np.empty(shape), room_for(y.size, count)
    mean_left, mean_fall, mean_change = np.empty(count), np.empty(count), np.empty(count)
    kept = tight + loose
    states_of(bases, y, states)
    if not slacks_of(states, sizes, rows, kept, slack) > 0.0:
        return OUTSIDE, 0, math.nan, math.nan
    means_of(states, sizes, rows, mean_tight, mean_left)
    mean_slack = np.maximum(mean_left, _MEAN_SLACK)
    dual[:], mean_dual[:] = np.maximum(dual, barrier / slack), np.maximum(mean_dual, barrier / mean_slack)
    centring, time, gap = 0.15, math.nan, math.nan
    for step in range(most_steps):
        gap = (slack * dual).sum() + (mean_slack * mean_dual).sum()
        target = centring * gap / (slack.size + count)
        gradients_of(states, sizes, rows, kept, gradient)
        time = assemble(states, bases, sizes, rows, slack, dual, gradient, mean_tight, mean_dual, target, equations)
        missed = mean_slack - mean_left
        close = gap + np.abs(missed).sum() <= tolerance * time
        if (step and close and not price) or (price and loose < 0.0):
            return SOLVED, step, time, gap
        found, looser = solve_step(equations, mean_slack, mean_dual, (target + mean_dual * missed) / mean_slack, price)
        if not found:
            return SINGULAR, step, time, gap
        states_of(bases, equations.right[LEAD:], moved)
        primal, of_dual = _dual_step(moved, states, slack, dual, gradient, target, looser, change)
        for j in range(count):
            mean_fall[j] = -missed[j] - (equations.means[j] * equations.right).sum()
            mean_change[j] = (target - mean_dual[j] * mean_fall[j]) / mean_slack[j] - mean_dual[j]
            primal = _to_the_edge(mean_slack[j], mean_fall[j], primal)
            of_dual = _to_the_edge(mean_dual[j], mean_change[j], of_dual)
        inside = False
        for _ in range(_TRIES):
            tried[:] = states + primal * moved
            kept[:] = tight + (loose + primal * looser)
            inside = slacks_of(tried, sizes, rows, kept, next_slack) > 0.0
            if inside:
                break
            primal *= _BACK
        if not inside:
            return STUCK, step, time, gap
        y += primal * equations.right[LEAD:]
        loose += primal * looser
        states[:], slack[:] = tried, next_slack
        mean_slack += primal * mean_fall
        means_of(states, sizes, rows, mean_tight, mean_left)
        dual += of_dual * change
        mean_dual += of_dual * mean_change
        reached = min(primal, of_dual)
        centring = 0.05 if reached > 0.9 else (0.15 if reached > 0.6 else (0.3 if reached > 0.3 else 0.6))
    return SLOW, most_steps, time, gap
