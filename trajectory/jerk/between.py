"""What a motion uses of its rows between the stations at which a search keeps them."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from trajectory.jerk.barrier import COMPILED, cubic_basis
from trajectory.jerk.rows import Array, Rows


@njit(**COMPILED)
def used(sizes: Array, values: Array, rows: Rows, parts: int, out: Array) -> None:
    """The most that each interval uses of each row.

    Args:
        sizes: (n,) of the intervals.
        values: (2 n + 2,) x and w at the knots.
        rows: at the stations of so many parts of each interval.
        parts: of each interval.
        out: (n, f + m + 1 + c) over its limit: forces, jerks, x and tool, the last two squares.
    """
    forces, joints, tools = rows.force.shape[1], rows.jerk.shape[1], rows.tool.shape[1]
    base = np.empty((3, 4))
    out[:] = 0.0
    for k in range(sizes.size):
        most = out[k]
        for i in range(parts + 1):
            cubic_basis(i / parts, sizes[k], base)
            x, w, z = 0.0, 0.0, 0.0
            for a in range(4):
                value = values[2 * k + a]
                x += base[0, a] * value
                w += base[1, a] * value
                z += base[2, a] * value
            if not x > 0.0:
                most[:] = math.inf
                continue
            g, root = parts * k + i, math.sqrt(x)
            for j in range(forces):
                c = rows.force[g, j]
                use = abs(c[0] * w + c[1] * x + c[2] * root + c[3]) + c[4] * root + c[5]
                most[j] = max(most[j], use)
            for j in range(joints):
                c = rows.jerk[g, j]
                most[forces + j] = max(most[forces + j], root * abs(c[0] * z + c[1] * w + c[2] * x))
            at = forces + joints
            most[at] = max(most[at], x / rows.most[g])
            for j in range(tools):
                c = rows.tool[g, j]
                most[at + 1] = max(most[at + 1], c[0] * w * w + c[1] * w * x + c[2] * x * x)
