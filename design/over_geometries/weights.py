"""Whether a weighted sum of rows is below 0 on a whole box, and which variable moves the rows the most.

Near the best geometry no row alone is below 0: one row falls where another one rises. Then weights can be found whose
sum has no slope, as at an optimum. Any weights that are not negative prove the same; those that are tried come from a
few steps of the exponentiated gradient (Kivinen and Warmuth, 1997).
"""

from __future__ import annotations

import numba
import numpy as np

from kinematics import Array, over_spans

_STEPS = 25
_MOST = 10  # rows, the lowest for their widths
_LEADING = 3  # of them say which variable to cut
_SURE = 1e-9  # rows are scaled to about 1: this covers the rounding of their sums many times


def weighted(most: Array, slopes: Array, bends: Array, leads: Array) -> tuple[Array, Array]:
    """Search weights for each box.

    Args:
        most, slopes, bends: (n, r), (n, r, k), (n, r, k) of the rows, as in `AffineForms`.
        leads: (r,) whether a row may say which variable to cut.

    Returns:
        (n,) whether a weighted sum is shown to be below 0 everywhere on the box, and (n, k) how much each variable
        moves or blurs the leading rows; 0 if no row that may fail is known.
    """
    found, spread = np.zeros(len(most), dtype=bool), np.zeros((len(most), slopes.shape[2]))
    over_spans(len(most), lambda s: _search(most[s], slopes[s], bends[s], leads, found[s], spread[s]))
    return found, spread


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _search(most, slopes, bends, leads, found, spread):  # type: ignore[no-untyped-def]
    rows, k = slopes.shape[1:]
    widths, lowness = np.empty(rows), np.empty(rows)
    p, a = np.empty(_MOST), np.empty((_MOST, k))
    for i in range(most.shape[0]):
        for j in range(rows):
            widths[j] = 1e-12 + np.abs(slopes[i, j]).sum()
            lowness[j] = most[i, j] / widths[j]
            lowness[j] = lowness[j] if np.isfinite(lowness[j]) else np.inf
        count, leading = 0, 0
        for j in np.argsort(lowness)[:_MOST]:
            if lowness[j] == np.inf:
                break
            size = widths[j] + abs(most[i, j]) * 1e-3
            p[count] = most[i, j] / size
            lead = leads[j] and leading < _LEADING and lowness[j] < 1.0  # others hold on all of the box
            for v in range(k):
                a[count, v] = slopes[i, j, v] / size
                if lead:
                    spread[i, v] += abs(a[count, v]) + bends[i, j, v] / size
            count, leading = count + 1, leading + lead
        found[i] = count > 0 and _below_zero(p[:count], a[:count])


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _below_zero(p, a):  # type: ignore[no-untyped-def]
    """Whether weights are found for rows p + a t with t anywhere in [-1, 1]."""
    count, k = a.shape
    weight, step, sums = np.full(count, 1.0 / count), np.empty(count), np.empty(k)
    for t in range(_STEPS):
        value = (weight * p).sum()
        sums[:] = 0.0
        for j in range(count):
            for v in range(k):
                sums[v] += weight[j] * a[j, v]
        if value + np.abs(sums).sum() < -_SURE:
            return True
        for j in range(count):
            step[j] = p[j]
            for v in range(k):
                step[j] += a[j, v] if sums[v] >= 0.0 else -a[j, v]
        weight *= np.exp(-0.75 / np.sqrt(t + 1.0) * (step - step.min()))
        weight /= weight.sum()
    return False
