"""An interior point method for the squared rate x of least time under `Rows`, in numba, without a general sparse
solver.

Unknowns are x and w = x' / 2 at the knots of u, with a cubic between. The time is the integral of 1 / sqrt(x). Every
iterate keeps every row strictly, so each is a motion. Only the mean squares are met at the end alone. A row that is not
linear is replaced by its tangent. For the jerk, |linear| <= 1 / sqrt(x), and for rows with a factor sqrt(x), the
tangent is stricter than the row, so that a step needs no search. The other rows are convex. Negative curvature is left
out. Only neighbours are coupled, so the Newton matrix has three diagonals below its own. The mean square torque adds
one rank for each joint.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics import Array
from trajectory.laws.jerk.banded import LEAD
from trajectory.laws.jerk.compiled import compiled
from trajectory.laws.jerk.limit_rows import Rows
from trajectory.laws.jerk.newton_step import Newton, assemble, room_for, solve_step
from trajectory.laws.jerk.stations import STATIONS, all_bases, gradients_of, means_of, row_count, slacks_of, states_of

SOLVED, OUTSIDE, SINGULAR, STUCK, SLOW = 0, 1, 2, 3, 4
_TO_EDGE = 0.95  # share of the distance to the nearest row that a step may go
_MEAN_SLACK = 1e-2  # in units of the time: least slack of a mean square at the start
_BACK = 0.7  # factor that shortens a step that broke a row
_TRIES = 40


class Kept(NamedTuple):
    """What a motion of n intervals keeps.

    Attributes:
        sizes: (n,) of the intervals of u.
        rows: at their stations.
        tight: (n, f + j + 1 + t) what each interval's rows are kept to: forces, jerks, x, tool.
        mean_tight: (m or 0,) what the mean squares are kept to.
    """

    sizes: Array
    rows: Rows
    tight: Array
    mean_tight: Array


class _Room(NamedTuple):
    """Of a search: at the stations the motion, the one that is tried and the step, and what is left of the rows."""

    bases: Array
    states: Array
    tried: Array
    moved: Array
    tight: Array
    slack: Array
    next_slack: Array
    gradient: Array
    change: Array
    mean_left: Array
    mean_fall: Array
    mean_change: Array


@compiled
def _room_for(kept: Kept, loose: float) -> _Room:
    n, rows, count = kept.sizes.size, row_count(kept.rows), kept.mean_tight.size
    at, of_rows = (n, STATIONS, 3), (n, STATIONS, rows)
    return _Room(
        all_bases(kept.sizes),
        np.empty(at),
        np.empty(at),
        np.empty(at),
        kept.tight + loose,
        np.empty(of_rows),
        np.empty(of_rows),
        np.empty((n, STATIONS, 4, rows)),
        np.empty(of_rows),
        np.empty(count),
        np.empty(count),
        np.empty(count),
    )


@compiled
def _to_the_edge(value: float, change: float, size: float) -> float:
    """The share of a change, at most `size`, that leaves a little of a positive value."""
    return -_TO_EDGE * value / change if -change * size > _TO_EDGE * value else size


@compiled
def _dual_step(
    room: _Room, dual: Array, target: float, loosened: float, primal: float, of_dual: float
) -> tuple[float, float]:
    """The change of the duals, and how far x and duals can go along their changes, the rows being loosened."""
    fastest_fall, fastest_dual = _TO_EDGE / primal, _TO_EDGE / of_dual
    for k in range(dual.shape[0]):
        for i in range(STATIONS):
            x, w, z = room.moved[k, i, 0], room.moved[k, i, 1], room.moved[k, i, 2]
            fastest_fall = max(fastest_fall, -x / room.states[k, i, 0])
            at = room.slack[k, i], dual[k, i], room.gradient[k, i], target, room.change[k, i]
            falls, duals = _row_steps(x, w, z, loosened, *at)
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
def descend(
    kept: Kept,
    y: Array,
    dual: Array,
    mean_dual: Array,
    barrier: float,
    tolerance: float,
    most_steps: int,
    loose: float,
    price: float,
) -> tuple[int, int, float]:
    """Descend from a motion that keeps the rows strictly.

    Args:
        kept: the rows and their bounds.
        y: (2 n + 2,) x and w at the knots. The answer replaces them.
        dual, mean_dual: least values of the duals, from a similar problem, or 0. The answer's duals replace them.
        barrier: product of each row's slack and dual at the start.
        tolerance: relative tolerance of the time.
        most_steps: the most steps.
        loose: a number that is added to the bounds of all rows.
        price: the price of `loose`, in units of the time. With a price, `loose` is lowered too, and the search ends
            when it is 0. Without (0), `loose` stays.

    Returns:
        The end (SOLVED or another), the number of steps, and the time.
    """
    room, equations = _room_for(kept, loose), room_for(y.size, mean_dual.size)
    states_of(room.bases, y, room.states)
    if not slacks_of(room.states, kept.sizes, kept.rows, room.tight, room.slack) > 0.0:
        return OUTSIDE, 0, math.nan
    means_of(room.states, kept.sizes, kept.rows, kept.mean_tight, room.mean_left)
    mean_slack = np.maximum(room.mean_left, _MEAN_SLACK)
    dual[:], mean_dual[:] = np.maximum(dual, barrier / room.slack), np.maximum(mean_dual, barrier / mean_slack)
    centring, time = 0.15, math.nan
    for step in range(most_steps):
        gap, missed = (room.slack * dual).sum() + (mean_slack * mean_dual).sum(), mean_slack - room.mean_left
        target = centring * gap / (room.slack.size + mean_slack.size)
        gradients_of(room.states, kept.sizes, kept.rows, room.tight, room.gradient)
        pressed = room.slack, dual, room.gradient
        time = assemble(
            room.states, room.bases, kept.sizes, kept.rows, *pressed, kept.mean_tight, mean_dual, target, equations
        )
        if loose < 0.0 if price else step and gap + np.abs(missed).sum() <= tolerance * time:
            return SOLVED, step, time
        pull = (target + mean_dual * missed) / mean_slack
        found, looser = solve_step(equations, mean_slack, mean_dual, pull, price)
        if not found:
            return SINGULAR, step, time
        states_of(room.bases, equations.right[LEAD:], room.moved)
        primal, of_dual = _mean_step(equations, missed, mean_slack, mean_dual, target, room)
        primal, of_dual = _dual_step(room, dual, target, looser, primal, of_dual)
        primal = _inside(room, kept, loose, looser, primal)
        if primal == 0.0:
            return STUCK, step, time
        y += primal * equations.right[LEAD:]
        loose += primal * looser
        room.states[:], room.slack[:] = room.tried, room.next_slack
        means_of(room.states, kept.sizes, kept.rows, kept.mean_tight, room.mean_left)
        mean_slack += primal * room.mean_fall
        mean_dual += of_dual * room.mean_change
        dual += of_dual * room.change
        centring = _centring(min(primal, of_dual))
    return SLOW, most_steps, time


@compiled
def _centring(reached: float) -> float:
    """The share of the barrier that is left, by how far along the last step went."""
    return 0.05 if reached > 0.9 else (0.15 if reached > 0.6 else (0.3 if reached > 0.3 else 0.6))


@compiled
def _inside(room: _Room, kept: Kept, loose: float, looser: float, size: float) -> float:
    """The share of the step, at most `size`, that keeps the rows; 0 where none was found."""
    for _ in range(_TRIES):
        room.tried[:] = room.states + size * room.moved
        room.tight[:] = kept.tight + (loose + size * looser)
        if slacks_of(room.tried, kept.sizes, kept.rows, room.tight, room.next_slack) > 0.0:
            return size
        size *= _BACK
    return 0.0


@compiled
def _mean_step(
    equations: Newton, missed: Array, mean_slack: Array, mean_dual: Array, target: float, room: _Room
) -> tuple[float, float]:
    """The changes of the mean squares' slacks and duals, and how far both can go along them."""
    primal, of_dual = 1.0, 1.0
    for j in range(mean_slack.size):
        fall = -missed[j] - (equations.means[j] * equations.right).sum()
        room.mean_fall[j] = fall
        room.mean_change[j] = (target - mean_dual[j] * fall) / mean_slack[j] - mean_dual[j]
        primal = _to_the_edge(mean_slack[j], fall, primal)
        of_dual = _to_the_edge(mean_dual[j], room.mean_change[j], of_dual)
    return primal, of_dual
