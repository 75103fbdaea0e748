"""How more actuators than freedoms share a load so that the largest torque over its limit is as small as possible.

All torques that do the same work are tau + N y, with N a basis of the null space of J^T, k = m - n columns. The least
of max |r_i|, r = (tau + N y) / limit, is a small linear programme. By its dual it is the largest of |l . r| / sum |l_i|
over the choices of k + 1 actuators, l their one relation l N = 0; in that choice all ratios have the size of the peak
and the signs of l. If l has zeros, this does not fix y, and the best vertex of all choices and signs is taken. If
several shares have the least peak, one of them is returned, and it may change between one pose and the next.
"""

from __future__ import annotations

from itertools import combinations, product

import numpy as np

from kinematics.arrays import Array
from kinematics.errors import InvalidValue

_ROUNDING = 1e-12


def least_peak(jacobian: Array, torque: Array, limits: Array) -> Array:
    """The torques that do the same work with the least peak over their limits.

    Args:
        jacobian: (..., m, n) actuators' rates from the twist, of rank n.
        torque: (..., m) any torques that do the work.
        limits: (m,) > 0, the limit of each torque.

    Returns:
        (..., m) torques; NaN where an input is NaN.

    Raises:
        InvalidValue: the limits are not m positive numbers.
    """
    m, n = jacobian.shape[-2:]
    if limits.shape != (m,) or not (np.isfinite(limits).all() and (limits > 0.0).all()):
        raise InvalidValue("torque limits", limits, f"{m} finite numbers > 0")
    lead = torque.shape[:-1]
    ratio, scaled = (torque / limits).reshape(-1, m), (jacobian * limits[:, None])
    scaled = np.broadcast_to(scaled, (*lead, m, n)).reshape(-1, m, n)
    good = np.isfinite(ratio).all(axis=-1) & np.isfinite(scaled).all(axis=(-2, -1))
    result = np.full(ratio.shape, np.nan)
    result[good] = _least(ratio[good], np.linalg.svd(scaled[good])[0][..., n:])
    answer: Array = (result * limits).reshape(*lead, m)
    return answer


def _least(ratio: Array, null: Array) -> Array:
    """(p, m) ratios and (p, m, k) basis of the null space -> (p, m) the ratios of least peak."""
    count, m, k = null.shape
    level, choice, relation = np.full(count, -1.0), np.zeros((count, k + 1), int), np.zeros((count, k + 1))
    minors = {rows: np.linalg.det(null[:, rows]) for rows in combinations(range(m), k)}
    for rows in combinations(range(m), k + 1):
        parts = [minors[rows[:i] + rows[i + 1 :]] for i in range(k + 1)]
        own = np.stack(parts, axis=-1) * (-1.0) ** np.arange(k + 1)
        size = np.abs(own).sum(axis=-1)
        load = (own * ratio[:, rows]).sum(axis=-1)
        value = np.divide(np.abs(load), size, out=np.zeros(count), where=size > 0.0)
        higher = value > level
        level[higher], choice[higher] = value[higher], rows
        relation[higher] = own[higher] * np.sign(load[higher, None])
    chosen = np.take_along_axis(null, choice[..., None], axis=1)
    wanted = level[:, None] * np.sign(relation) - np.take_along_axis(ratio, choice, axis=1)
    shared = ratio + np.einsum("pik,pkj,pj->pi", null, np.linalg.pinv(chosen), wanted)
    slack = _ROUNDING * np.abs(ratio).max(axis=-1)
    left = ~(np.abs(shared).max(axis=-1) <= level + slack)  # no share can be below the level
    shared[left] = _best_vertex(ratio[left], null[left])
    result: Array = shared
    return result


def _best_vertex(ratio: Array, null: Array) -> Array:
    """(p, m) ratios and (p, m, k) basis of the null space -> (p, m) the ratios of least peak."""
    m, k = null.shape[1:]
    signs = np.array([(1.0, *s) for s in product((1.0, -1.0), repeat=k)])  # t takes the sign of all of them
    best, least = ratio.copy(), np.abs(ratio).max(axis=-1)
    for rows in map(list, combinations(range(m), k + 1)):
        matrix = np.empty((len(ratio), len(signs), k + 1, k + 1))
        matrix[..., :k] = -null[:, None, rows]
        matrix[..., k] = signs
        regular = np.abs(np.linalg.det(matrix)) > 1e-12
        safe = np.where(regular[..., None, None], matrix, np.eye(k + 1))
        y = np.linalg.solve(safe, np.broadcast_to(ratio[:, None, rows, None], (*safe.shape[:-1], 1)))[..., :k, 0]
        shared = ratio[:, None] + np.einsum("pik,psk->psi", null, y)
        peak = np.where(regular, np.abs(shared).max(axis=-1), np.inf)
        first = peak.argmin(axis=-1)
        picked = np.take_along_axis(peak, first[:, None], axis=1)[:, 0]
        better = picked < least
        best[better] = shared[better, first[better]]
        least[better] = picked[better]
    return best
