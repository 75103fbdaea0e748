"""Newton's step of the interior point: its banded matrix, the mean square torques' ranks and the loosening's border."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics import Array
from trajectory.laws.jerk.banded import LEAD, factorise, solve_factorised
from trajectory.laws.jerk.compiled import compiled
from trajectory.laws.jerk.limit_rows import PARTS, Rows
from trajectory.laws.jerk.stations import STATIONS, WEIGHTS

_LEAST_CURVATURE = 0.1  # of the time's, which a mean square torque can use up


@compiled
def _row_curvature(x: float, duals: Array, force: Array, tool: Array, local: Array) -> None:
    """Of the rows whose curvature is positive: sqrt(x) that helps, and the tool's acceleration."""
    cube = 0.25 / (x * math.sqrt(x))
    for j in range(force.shape[0]):
        for side in range(2):
            by_root = force[j, 4] + (force[j, 2] if side == 0 else -force[j, 2])
            local[0] += max(-by_root, 0.0) * duals[2 * j + side] * cube
    for j in range(tool.shape[0]):
        dual = duals[duals.size - 1 - tool.shape[0] + j]
        local[0] += 2.0 * tool[j, 2] * dual
        local[1] += tool[j, 1] * dual
        local[2] += 2.0 * tool[j, 0] * dual


@compiled
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


class Newton(NamedTuple):
    """The equations of a step; columns have LEAD zeros before them.

    Attributes:
        band: of the motion's unknowns alone.
        right: its right-hand side, then the step.
        means: (m or 0, n) the mean squares' gradients.
        border: (n,) how the loosening of the rows meets the unknowns.
        corner: (2,) the loosening's own curvature, and what pulls at it.
    """

    band: Array
    right: Array
    means: Array
    border: Array
    corner: Array


@compiled
def room_for(unknowns: int, means: int) -> Newton:
    """Equations to fill."""
    n = unknowns + LEAD
    return Newton(np.empty((n, 4)), np.empty(n), np.empty((means, n)), np.empty(n), np.empty(2))


@compiled
def assemble(
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
    to: Newton,
) -> float:
    """Fill the equations; the motion's time."""
    to.band[:], to.right[:], to.means[:], to.border[:], to.corner[:], time = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    bend = max(1.0 - (mean_dual * mean_tight).sum(), _LEAST_CURVATURE)
    local, force, loose, slopes = np.empty(6), np.empty(3), np.empty(3), np.empty((mean_dual.size, 2))
    for k in range(sizes.size):
        for i in range(STATIONS):
            x, g = states[k, i, 0], PARTS * k + i
            share = WEIGHTS[i] * sizes[k] / math.sqrt(x)
            time += share
            local[:], force[:], loose[:] = 0.0, 0.0, 0.0
            local[0], force[0] = 0.75 * bend * share / (x * x), 0.5 * share / x
            _add_rows(slack[k, i], dual[k, i], gradient[k, i], target, local, force, loose, to.corner)
            _row_curvature(x, dual[k, i], rows.force[g], rows.tool[g], local)
            _mean_terms(share, x, states[k, i, 1], rows.mean[g], mean_tight, mean_dual, local, slopes)
            _add_station(bases[k, i], LEAD + 2 * k, local, force, loose, slopes, to)
    return time


@compiled
def _add_rows(
    slack: Array,
    dual: Array,
    gradient: Array,
    target: float,
    local: Array,
    force: Array,
    loose: Array,
    corner: Array,
) -> None:
    """What the rows of a station press with, and how that changes."""
    xx, xw, ww, xz, wz, zz, x, w, z = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    x_loose, w_loose, z_loose, stiff, pulled = 0.0, 0.0, 0.0, 0.0, 0.0
    by_x, by_w, by_z, by_tight = gradient
    for e in range(slack.size):
        inverse = 1.0 / slack[e]
        pull, q = target * inverse, dual[e] * inverse
        a, b, c, t = by_x[e], by_w[e], by_z[e], by_tight[e]
        x += pull * a
        w += pull * b
        z += pull * c
        xx += q * a * a
        xw += q * a * b
        ww += q * b * b
        xz += q * a * c
        wz += q * b * c
        zz += q * c * c
        x_loose += q * a * t
        w_loose += q * b * t
        z_loose += q * c * t
        stiff += q * t * t
        pulled += pull * t
    force[0] -= x
    force[1] -= w
    force[2] -= z
    local[0] += xx
    local[1] += xw
    local[2] += ww
    local[3] += xz
    local[4] += wz
    local[5] += zz
    loose[0], loose[1], loose[2] = -x_loose, -w_loose, -z_loose
    corner[0] += stiff
    corner[1] += pulled


@compiled
def _add_station(base: Array, at: int, local: Array, force: Array, loose: Array, slopes: Array, to: Newton) -> None:
    """From x, w and z of a station to the four unknowns of its interval."""
    for a in range(4):
        x, w, z = base[0, a], base[1, a], base[2, a]
        to.right[at + a] += force[0] * x + force[1] * w + force[2] * z
        to.border[at + a] += loose[0] * x + loose[1] * w + loose[2] * z
        by_x = local[0] * x + local[1] * w + local[3] * z
        by_w = local[1] * x + local[2] * w + local[4] * z
        by_z = local[3] * x + local[4] * w + local[5] * z
        for b in range(a + 1):
            to.band[at + a, 3 - a + b] += by_x * base[0, b] + by_w * base[1, b] + by_z * base[2, b]
        for j in range(slopes.shape[0]):
            to.means[j, at + a] += slopes[j, 0] * x + slopes[j, 1] * w


@compiled
def solve_step(of: Newton, mean_slack: Array, mean_dual: Array, mean_pull: Array, price: float) -> tuple[bool, float]:
    """The step in place of the right-hand side.

    Args:
        of: the equations.
        mean_slack, mean_dual, mean_pull: (m or 0,) of the mean squares; the last what each presses with.
        price: of the loosening, in units of the time.

    Returns:
        Whether there is one, and that of the loosening; 0 where it has no price.
    """
    if not factorise(of.band):
        return False, 0.0
    count = mean_slack.size
    apart, small = of.means.copy(), np.empty((count, count))
    for j in range(count):
        of.right[:] -= mean_pull[j] * of.means[j]
        solve_factorised(of.band, apart[j])
    for i in range(count):
        for j in range(count):
            small[i, j] = (of.means[i] * apart[j]).sum()
        small[i, i] += mean_slack[i] / mean_dual[i]
    _solve_with_ranks(of, apart, small, of.right)
    if price == 0.0:
        return True, 0.0
    along = of.border.copy()
    _solve_with_ranks(of, apart, small, along)
    pulled = of.corner[1] - price - (of.border * of.right).sum()
    looser = pulled / (of.corner[0] - (of.border * along).sum())
    of.right[:] -= looser * along
    return True, looser


@compiled
def _solve_with_ranks(of: Newton, apart: Array, small: Array, x: Array) -> None:
    """In place, by the factor and what each mean square torque adds to it (Woodbury)."""
    solve_factorised(of.band, x)
    if small.size:
        shares = np.linalg.solve(small, np.array([(of.means[j] * x).sum() for j in range(small.shape[0])]))
        for j in range(shares.size):
            x -= shares[j] * apart[j]
