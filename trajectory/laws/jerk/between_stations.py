"""How much of its rows a motion uses between the stations where a search keeps them."""

from __future__ import annotations

import math

import numpy as np

from kinematics import Array
from trajectory.laws.jerk.compiled import compiled
from trajectory.laws.jerk.limit_rows import PARTS, Rows
from trajectory.laws.jerk.stations import cubic_basis

_FINER = 4  # times as many places as stations
_PLACES = np.linspace(0.0, 1.0, _FINER * PARTS + 1)  # of each interval
_NODES = np.arange(PARTS + 1) / PARTS
_LAGRANGE = np.array(
    [[np.prod([(u - b) / (a - b) for b in _NODES if b != a]) for a in _NODES] for u in _PLACES]
)  # from a coefficient at the stations to the cubic through it


@compiled
def used(sizes: Array, values: Array, rows: Rows, out: Array) -> None:
    """The most that each interval uses of each row, by the parabola through the highest of many places.

    Args:
        sizes: (n,) of the intervals.
        values: (2 n + 2,) x and w at the knots.
        rows: at the stations.
        out: (n, f + j + 1 + t) over its limit: forces, jerks, x and tool, the last two squares.
    """
    found, base = np.empty((_PLACES.size, out.shape[1])), np.empty((3, 4))
    for k in range(sizes.size):
        for i in range(_PLACES.size):
            cubic_basis(_PLACES[i], sizes[k], base)
            x, w, z = 0.0, 0.0, 0.0
            for a in range(4):
                value = values[2 * k + a]
                x += base[0, a] * value
                w += base[1, a] * value
                z += base[2, a] * value
            _used_at(x, w, z, PARTS * k, _LAGRANGE[i], rows, found[i])
        for j in range(out.shape[1]):
            out[k, j] = _peak(found[:, j])


@compiled
def _used_at(x: float, w: float, z: float, first: int, shares: Array, rows: Rows, out: Array) -> None:
    """Of coefficients that are shares of those at the stations from `first` on."""
    out[:] = 0.0
    if not x > 0.0:
        out[:] = math.inf
        return
    forces, joints, tools, root = rows.force.shape[1], rows.jerk.shape[1], rows.tool.shape[1], math.sqrt(x)
    at = forces + joints
    for j in range(forces):
        value, either = 0.0, 0.0
        for i in range(PARTS + 1):
            c = rows.force[first + i, j]
            value += shares[i] * (c[0] * w + c[1] * x + c[2] * root + c[3])
            either += shares[i] * (c[4] * root + c[5])
        out[j] = abs(value) + either
    for j in range(joints):
        value = 0.0
        for i in range(PARTS + 1):
            c = rows.jerk[first + i, j]
            value += shares[i] * (c[0] * z + c[1] * w + c[2] * x)
        out[forces + j] = root * abs(value)
    for j in range(tools):
        for i in range(PARTS + 1):
            c = rows.tool[first + i, j]
            out[at + 1 + j] += shares[i] * (c[0] * w * w + c[1] * w * x + c[2] * x * x)
    inverse = 0.0
    for i in range(PARTS + 1):
        inverse += shares[i] / rows.most[first + i]
    out[at] = x * max(inverse, 0.0)


@compiled
def _peak(values: Array) -> float:
    i = int(np.argmax(values))
    result: float = values[i]
    if 0 < i < values.size - 1:
        rise, bend = values[i + 1] - values[i - 1], 2.0 * values[i] - values[i + 1] - values[i - 1]
        if bend > 0.0:
            result += rise * rise / (8.0 * bend)
    return result
