"""A lower bound of the time that any motion along a path takes within its limits of speed, acceleration and torque.

This finds no law. It takes conditions that every law must satisfy, averages them over intervals of s and relaxes them.
Then it finds the largest x = s'^2 that they allow, backward from rest at the end and then forward from rest at the
start. Each step is a linear program in x at both ends of an interval. With x~ the mean of x over an interval of length
d, a row |a u + b x + c| <= 1 (see `interval_rows`) gives

    (a_1 x_1 - a_0 x_0) / (2 d) + w x~ + c <= 1,  w and c anywhere in their bounds, and likewise below,

and x~ differs from (x_0 + x_1) / 2 by at most (U - L) d / 4, where L <= u <= U are the least and the largest u that the
rows allow in the interval. The motion takes at least the integral of 1 / sqrt of the largest x. Limits of jerk and root
mean square are left out, as they can only make a motion slower. Redundant actuators share the load by the least norm.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from kinematics import Array, Mechanism
from trajectory.errors import TimingFailed
from trajectory.laws.bounds.interval_rows import interval_rows
from trajectory.limits import IntervalRows, Limits
from trajectory.paths import Path, require_poses_of

_ROUNDING = 1e-9  # relative: far more than the rounding error of the linear programs
_LINE = 1e-12  # relative to a row's or a bound's size
_MOST = 1e9  # 1/s^2: a bound of u and x over the path's length and its square, above that of any motion


def lower_bound(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int = 4000) -> float:
    """A time that every motion from rest to rest along the path, within the limits, needs at least [s].

    Args:
        robot: any mechanism with the path's kind of pose.
        path: a path without a jump of its tangent, within reach and without singular poses.
        limits: limits of joints and tool; only those with rows over intervals are used.
        payload: mass at the tool [kg].
        intervals: number of intervals of s. More intervals give a closer bound.

    Raises:
        InvalidValue: the robot has another kind of pose.
        TimingFailed: no motion along the path keeps the limits.
    """
    require_poses_of(robot, path)
    shares = (1.0 - np.cos(np.linspace(0.0, math.pi, intervals + 1))) / 2  # finer at both ends, where x starts from 0
    edges = np.union1d(path.length * shares, path.knots)
    edges = edges[np.append(np.diff(edges) > 1e-12 * path.length, True)]
    rows, highest = interval_rows(robot, path, limits, payload, edges)
    most = _MOST * path.length
    highest, lengths = np.minimum(highest, most * path.length), np.diff(edges)
    steepest = _steepest(rows, highest, most)
    x, at_edges = np.empty(edges.size), np.minimum(np.append(highest, np.inf), np.append(np.inf, highest))
    blocked = _profile(*_averaged(rows, lengths, steepest), at_edges, x)
    if blocked >= 0:
        asked = {**limits.as_dict(), "payload": payload, "path": path.as_dict()}
        raise TimingFailed("lower bound", asked, f"no motion within the limits passes s = {edges[blocked]:.6g} m")
    return _least_time(x, lengths, steepest, highest) * (1.0 - _ROUNDING)


def _steepest(rows: IntervalRows, highest: Array, limit: float) -> Array:
    """(2, k) the largest values of u and -u in each interval [m/s^2]; 0 if there is no such u."""
    by_x = np.hstack([rows.b - rows.b_radius, -rows.b - rows.b_radius])
    rest = np.hstack([1.0 - rows.c + rows.c_radius, 1.0 + rows.c + rows.c_radius])
    found = np.empty((2, highest.size))
    for most, sign in zip(found, (1.0, -1.0), strict=True):
        by_u = np.hstack([sign * rows.a - rows.a_radius, -sign * rows.a - rows.a_radius])
        _largest_each(*_usable(by_u, by_x, rest), np.full(highest.size, limit), highest, most)
    return found * (1.0 + _ROUNDING)


def _averaged(rows: IntervalRows, lengths: Array, steepest: Array) -> tuple[Array, Array, Array]:
    """(k, 2 rows) g, h and r with g x_0 + h x_1 <= r, averaged over each interval."""
    d = lengths[:, None]
    away = steepest.sum(axis=0)[:, None] * d / 4
    w = np.hstack([rows.w, -rows.w]) - np.hstack([rows.w_radius, rows.w_radius])
    by_first = np.hstack([-rows.a_start, rows.a_start]) / (2 * d) + w / 2
    by_last = np.hstack([rows.a_end, -rows.a_end]) / (2 * d) + w / 2
    rest = np.hstack([1.0 - rows.c + rows.c_radius, 1.0 + rows.c + rows.c_radius]) + np.abs(w) * away
    return _usable(by_first, by_last, rest)


def _usable(first: Array, second: Array, rest: Array) -> tuple[Array, Array, Array]:
    """The rows, with 0 <= 1 instead of unbounded ones."""
    good = np.isfinite(first) & np.isfinite(second) & np.isfinite(rest)
    return np.where(good, first, 0.0), np.where(good, second, 0.0), np.where(good, rest, 1.0)


def _least_time(x: Array, lengths: Array, steepest: Array, highest: Array) -> float:
    """The integral of 1 / sqrt(x) over the largest x: a tent from both ends of each interval, or Jensen's mean."""
    first, last = x[:-1], x[1:]
    rise, fall = np.maximum(steepest, _LINE * steepest.max())
    ridge = np.clip((last - first + 2 * fall * lengths) / (2 * (rise + fall)), 0.0, lengths)
    up = (np.sqrt(first + 2 * rise * ridge) - np.sqrt(first)) / rise
    down = (np.sqrt(last + 2 * fall * (lengths - ridge)) - np.sqrt(last)) / fall
    mean = np.minimum((first + last) / 2 + (rise + fall) * lengths / 4, highest)
    return float(np.maximum(up + down, lengths / np.sqrt(mean)).sum())


@numba.njit(cache=True, error_model="numpy")
def _largest_each(g, h, r, most_x, most_y, found):  # type: ignore[no-untyped-def]
    for k in range(found.size):
        found[k] = max(0.0, _largest_x(g[k], h[k], r[k], most_x[k], most_y[k]))


@numba.njit(cache=True, error_model="numpy")
def _profile(g, h, r, highest, x):  # type: ignore[no-untyped-def]
    """Backward, then forward. Fills x and returns -1, or the interval that no motion passes."""
    last = x.size - 1
    x[last] = 0.0
    for k in range(last - 1, -1, -1):
        x[k] = _largest_x(g[k], h[k], r[k], highest[k], x[k + 1]) * (1.0 + _ROUNDING)
        if x[k] < 0.0:
            return k
    x[0] = 0.0
    for k in range(last):
        x[k + 1] = _largest_x(h[k], g[k], r[k], x[k + 1], x[k]) * (1.0 + _ROUNDING)
        if x[k + 1] < 0.0:
            return k
    return -1


@numba.njit(cache=True, error_model="numpy")
def _largest_x(g, h, r, most_x, most_y):  # type: ignore[no-untyped-def]
    """max x with g x + h y <= r (rows,), 0 <= x <= most_x, 0 <= y <= most_y; -1 if there is none.

    Rows are added one by one. If the best point so far breaks the new row, the new best point is on that row's line.
    """
    x, y = most_x, most_y
    for i in range(g.size):
        if g[i] * x + h[i] * y <= r[i]:
            continue
        if abs(h[i]) * most_y >= abs(g[i]) * most_x:
            low, high = _on_line(g, h, r, i, most_x, most_y)
            x = high
            y = min(max((r[i] - g[i] * x) / h[i], 0.0), most_y)
        else:
            low, high = _on_line(h, g, r, i, most_y, most_x)
            y = high if h[i] * g[i] < 0.0 else low
            x = min(max((r[i] - h[i] * y) / g[i], 0.0), most_x)
        if not low <= high * (1.0 + _LINE) + _LINE:
            return -1.0
    return x


@numba.njit(cache=True, error_model="numpy")
def _on_line(g, h, r, i, most_x, most_y):  # type: ignore[no-untyped-def]
    """Least and largest x on the line g_i x + h_i y = r_i, h_i not 0, within the rows before it and the bounds.

    Along a row that is parallel to the line only rounding is left of x, such as for joints that move alike. It says
    nothing of x.
    """
    low, high = 0.0, most_x
    slope, start = -g[i] / h[i], r[i] / h[i]  # y = start + slope x
    for j in range(-2, i):
        if j == -2:
            by, rest, size = slope, most_y - start, 0.0
        elif j == -1:
            by, rest, size = -slope, start, 0.0
        else:
            by, rest = g[j] + h[j] * slope, r[j] - h[j] * start
            size = abs(g[j]) + abs(h[j] * slope)
        rest += _LINE * (1.0 if j >= 0 else most_y)
        if abs(by) <= _LINE * size:
            if rest < -abs(by) * most_x:
                return 1.0, -1.0
        elif by > 0.0:
            high = min(high, rest / by)
        else:
            low = max(low, rest / by)
    return low, high
