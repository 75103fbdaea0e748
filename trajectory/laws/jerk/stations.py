"""A motion at the stations of its intervals: its cubic there, what is left of each row, and the rows' slopes."""

from __future__ import annotations

import math

import numpy as np

from kinematics import Array
from trajectory.laws.jerk.compiled import compiled
from trajectory.laws.jerk.limit_rows import PARTS, Rows

STATIONS = PARTS + 1  # of each interval
WEIGHTS = np.array([1.0, 3.0, 3.0, 1.0]) / 8.0  # of their integral: Simpson's 3/8
_TRIES = 40
# Of an interval's size times w, added to x: the points of Bezier of its cubic, above 0 so that the cubic is.
_POSITIVE = np.array([2.0 / 3.0, *np.zeros(PARTS - 1), -2.0 / 3.0])


@compiled
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


@compiled
def all_bases(sizes: Array) -> Array:
    found = np.empty((sizes.size, STATIONS, 3, 4))
    for k in range(sizes.size):
        for i in range(STATIONS):
            cubic_basis(i / PARTS, sizes[k], found[k, i])
    return found


@compiled
def states_of(bases: Array, y: Array, out: Array) -> None:
    """x, w and z at the stations."""
    for k in range(bases.shape[0]):
        a, b, c, d = y[2 * k], y[2 * k + 1], y[2 * k + 2], y[2 * k + 3]
        for i in range(STATIONS):
            base = bases[k, i]
            for e in range(3):
                out[k, i, e] = base[e, 0] * a + base[e, 1] * b + base[e, 2] * c + base[e, 3] * d


@compiled
def slacks_of(states: Array, sizes: Array, rows: Rows, tight: Array, out: Array) -> float:
    """What is left of each row; the least of it, of x too, over all stations."""
    least = math.inf
    forces, joints, tools = rows.force.shape[1], rows.jerk.shape[1], rows.tool.shape[1]
    for k in range(states.shape[0]):
        for i in range(STATIONS):
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
                left[at + 1 + j] = t[forces + joints + 1 + j] - (c[0] * w * w + c[1] * w * x + c[2] * x * x)
            left[left.size - 1] = x + _POSITIVE[i] * sizes[k] * w
            for e in range(left.size):
                least = min(least, left[e])
    return least


@compiled
def means_of(states: Array, sizes: Array, rows: Rows, tight: Array, out: Array) -> None:
    """What is left of each mean square torque, integrated over the time."""
    out[:] = 0.0
    for k in range(sizes.size):
        for i in range(STATIONS):
            x, w = states[k, i, 0], states[k, i, 1]
            root = math.sqrt(x)
            share = WEIGHTS[i] * sizes[k] / root
            for j in range(out.size):
                c = rows.mean[PARTS * k + i, j]
                out[j] += share * (tight[j] - (c[0] * w + c[1] * x + c[2] * root + c[3]) ** 2)


@compiled
def gradients_of(states: Array, sizes: Array, rows: Rows, tight: Array, out: Array) -> None:
    """Of each row's use by x, w and z; and of what is left by what the row is kept to; (n, stations, 4, rows)."""
    forces, joints, tools = rows.force.shape[1], rows.jerk.shape[1], rows.tool.shape[1]
    out[:] = 0.0
    for k in range(states.shape[0]):
        for i in range(STATIONS):
            g = PARTS * k + i
            x, w = states[k, i, 0], states[k, i, 1]
            rate = 1.0 / math.sqrt(x)
            half, steep = 0.5 * rate, 0.5 * rate / x
            by_x, by_w, by_z, by_tight = out[k, i]
            by_tight[:] = 1.0
            for j in range(forces):
                c = rows.force[g, j]
                by_x[2 * j], by_w[2 * j] = c[1] + (c[4] + c[2]) * half, c[0]
                by_x[2 * j + 1], by_w[2 * j + 1] = (c[4] - c[2]) * half - c[1], -c[0]
            at = 2 * forces
            for j in range(joints):
                c, edge = rows.jerk[g, j], tight[k, forces + j] * steep
                by_x[at], by_w[at], by_z[at], by_tight[at] = c[2] + edge, c[1], c[0], rate
                by_x[at + 1], by_w[at + 1], by_z[at + 1], by_tight[at + 1] = edge - c[2], -c[1], -c[0], rate
                at += 2
            by_x[at], by_tight[at] = 1.0, rows.most[g]
            for j in range(tools):
                c = rows.tool[g, j]
                by_x[at + 1 + j], by_w[at + 1 + j] = c[1] * w + 2.0 * c[2] * x, 2.0 * c[0] * w + c[1] * x
            last = by_x.size - 1
            by_x[last], by_w[last], by_tight[last] = -1.0, -_POSITIVE[i] * sizes[k], 0.0


@compiled
def keeping(sizes: Array, rows: Rows, tight: Array, y: Array) -> float:
    """The share of a motion's squared rate, below 1, that keeps all the rows strictly; 0 where none is found."""
    bases, states = all_bases(sizes), np.empty((sizes.size, STATIONS, 3))
    slack, given = np.empty((sizes.size, STATIONS, row_count(rows))), 0.005
    for _ in range(_TRIES):
        share = 1.0 - given if given < 0.7 else 0.7 * 0.64 / given
        states_of(bases, y * share, states)
        if slacks_of(states, sizes, rows, tight, slack) > 0.0:
            return share
        given *= 2.0
    return 0.0


@compiled
def row_count(rows: Rows) -> int:
    """At each station: both sides of forces and jerks, x at most, tool, and x above 0."""
    result: int = 2 * rows.force.shape[1] + 2 * rows.jerk.shape[1] + 1 + rows.tool.shape[1] + 1
    return result
