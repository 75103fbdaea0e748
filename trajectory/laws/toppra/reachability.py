"""Linear programs in two variables, and the fastest profile of x = s'^2 that rows on it allow, by reachability.

Pham and Pham, "A new approach to time-optimal path parameterization based on reachability analysis", IEEE T-RO 2018:
backward from rest at the end, the interval of x from which the end can still be reached; forward from rest at the
start, always the largest x that stays inside. All tolerances are relative.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from kinematics import Array

_KEPT = 1e-10  # of a row's bound: a row that is exceeded by less is kept
_LINE = 1e-12  # relative: what rounding may put a point beyond a line


def fastest_profile(lengths: Array, rows: tuple[Array, ...], highest: Array, x: Array) -> int:
    """Fill x (k + 1,) with the fastest profile from rest to rest.

    Args:
        lengths: (k,) of the intervals between the points.
        rows: a, b, c and friction, (k + 1, rows) each: |a u + b x + c + f| <= 1 at both ends of each interval with its
            own u = x' / 2, and with the friction f of both ends.
        highest: (k + 1,) of x, finite.
        x: to be filled.

    Returns:
        -1, or the interval from whose start the end cannot be reached.
    """
    a, b, c, friction = rows
    return int(_fastest(lengths, a, b, c, friction, highest, x))


@numba.njit(cache=True, error_model="numpy")
def _fastest(lengths, a, b, c, friction, highest, x):  # type: ignore[no-untyped-def]
    count = (8 if friction.any() else 4) * a.shape[1]
    g, h, r = np.empty(count + 2), np.empty(count + 2), np.empty(count + 2)
    last = x.size - 1
    least = np.zeros(x.size)
    x[last] = 0.0
    for k in range(last - 1, -1, -1):
        _fill(lengths[k], a, b, c, friction, k, g, h, r)
        step, most = 2.0 * lengths[k], max(highest[k], x[k + 1])
        steepest, unit = most / step, x[k + 1] if x[k + 1] > 0.0 else most
        g[count], h[count], r[count] = 1.0 / unit, step / unit, x[k + 1] / unit
        g[count + 1], h[count + 1], r[count + 1] = -g[count], -h[count], -least[k + 1] / unit
        x[k] = _largest(g, h, r, 0.0, highest[k], steepest)
        if not x[k] >= 0.0:
            return k
        if least[k + 1] > 0.0 or not _kept(g, h, r, 0.0, 0.0):
            least[k] = min(max(-_largest(-g, h, r, -x[k], 0.0, steepest), 0.0), x[k])
    if least[0] > 0.0:
        return 0
    x[0] = 0.0
    for k in range(last):
        _fill(lengths[k], a, b, c, friction, k, g, h, r)
        u = _steepest(g[:count], h[:count], r[:count], x[k], (x[k + 1] - x[k]) / (2.0 * lengths[k]))
        x[k + 1] = min(max(x[k] + 2.0 * lengths[k] * u, least[k + 1]), x[k + 1])
    return -1


@numba.njit(cache=True, error_model="numpy")
def _fill(length, a, b, c, friction, k, g, h, r):  # type: ignore[no-untyped-def]
    """The rows of one interval as g x + h u <= r, x where it starts: where it ends x is 2 u length more."""
    i = 0
    for end in range(2):
        for j in range(a.shape[1]):
            by_x = b[k + end, j]
            by_u = a[k + end, j] + (2.0 * length * by_x if end else 0.0)
            for f in range((g.size - 2) // (4 * a.shape[1])):
                constant = c[k + end, j] + friction[k + f, j]
                g[i], h[i], r[i] = by_x, by_u, 1.0 - constant
                g[i + 1], h[i + 1], r[i + 1] = -by_x, -by_u, 1.0 + constant
                i += 2


@numba.njit(cache=True, error_model="numpy")
def _kept(g, h, r, x, u):  # type: ignore[no-untyped-def]
    """Whether a point keeps every row."""
    return (g * x + h * u <= r).all()


@numba.njit(cache=True, error_model="numpy")
def _steepest(g, h, r, x, most):  # type: ignore[no-untyped-def]
    """The largest u <= most with g x + h u <= r; where rounding leaves none, the least that is too much."""
    least = -math.inf
    for i in range(g.size):
        rest = r[i] - g[i] * x
        if h[i] > 0.0:
            most = min(most, rest / h[i])
        elif h[i] < 0.0:
            least = max(least, rest / h[i])
    return max(most, least)


@numba.njit(cache=True, error_model="numpy")
def _largest(g, h, r, low, high, most):  # type: ignore[no-untyped-def]
    """max x with g x + h u <= r (rows,), low <= x <= high, |u| <= most; NaN where there is none.

    Row by row: where the best point so far breaks one, the new best lies on its line.
    """
    x, u = high, 0.0
    for i in range(g.size):
        if g[i] * x + h[i] * u <= r[i] + _KEPT:
            continue
        if abs(h[i]) * most >= abs(g[i]) * max(abs(low), abs(high)):
            first, last = _on_line(g, h, r, i, low, high, -most, most)
            x = last
            u = min(max((r[i] - g[i] * x) / h[i], -most), most)
        else:
            first, last = _on_line(h, g, r, i, -most, most, low, high)
            u = last if h[i] * g[i] < 0.0 else first
            x = min(max((r[i] - h[i] * u) / g[i], low), high)
        if not first <= last + _LINE * (abs(first) + abs(last)):
            return math.nan
    return x


@numba.njit(cache=True, error_model="numpy")
def _on_line(g, h, r, i, low_x, high_x, low_y, high_y):  # type: ignore[no-untyped-def]
    """Least and largest x on the line g_i x + h_i y = r_i, h_i not 0, within the rows before it and the bounds."""
    low, high = low_x, high_x
    slope, start = -g[i] / h[i], r[i] / h[i]  # y = start + slope x
    for j in range(-2, i):
        if j == -2:
            by, rest = slope, high_y - start + _LINE * abs(start)
        elif j == -1:
            by, rest = -slope, start - low_y + _LINE * abs(start)
        else:
            by, rest = g[j] + h[j] * slope, r[j] - h[j] * start + _LINE
        if by > 0.0:
            high = min(high, rest / by)
        elif by < 0.0:
            low = max(low, rest / by)
        elif rest < 0.0:
            return 1.0, -1.0
    return low, high
