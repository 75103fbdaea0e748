"""A motion of the jerk law between its knots: a cubic x(u) in each interval, its time, and its law in time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Array
from trajectory.laws.jerk.limit_rows import smoothstep
from trajectory.motions import TimeLaw

_FAITHFUL = 3e-4  # of a limit of jerk: how far the law's may be from the motion's
_HALVINGS = 40
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)  # exact for the slope of S5, of degree 4
_STEEPEST = 1.35  # w times an interval's size over x; from 1.5 on a cubic may pass below 0
_LOWEST = 0.01  # of x between two knots, over the lower of theirs


class SquaredRate(NamedTuple):
    """x = u'^2 as a cubic of u in each interval.

    Attributes:
        knots: (n + 1,) of u, from 0 to 1.
        values: (2 n + 2,) x and w = x' / 2 at the knots, in turn.
    """

    knots: Array
    values: Array

    def at(self, u: Array) -> Array:
        """(2 k,) x and w at other knots (k,)."""
        n = self.knots.size - 1
        k = np.clip(np.searchsorted(self.knots, u, side="right") - 1, 0, n - 1)
        size = self.knots[k + 1] - self.knots[k]
        t = (u - self.knots[k]) / size
        a, b, c, d = (self.values[2 * k + e] for e in range(4))
        found = np.empty(2 * u.size)
        found[::2] = (
            a * (1.0 + t**2 * (2.0 * t - 3.0))
            + c * t**2 * (3.0 - 2.0 * t)
            + 2.0 * size * t * (b * (1.0 - t) ** 2 - d * t * (1.0 - t))
        )
        found[1::2] = 3.0 * (c - a) * t * (1.0 - t) / size + b * (1.0 - t) * (1.0 - 3.0 * t) + d * t * (3.0 * t - 2.0)
        return found

    def on(self, knots: Array) -> SquaredRate:
        """About the same on other knots, with slopes so small that x stays above 0."""
        values, sizes = self.at(knots), np.diff(knots)
        steepest = _STEEPEST * values[::2]
        values[1:-1:2] = np.maximum(values[1:-1:2], -steepest[:-1] / sizes)
        values[3::2] = np.minimum(values[3::2], steepest[1:] / sizes)
        return SquaredRate(knots, values)

    def finer(self, parts: int) -> SquaredRate:
        """The same on so many times as many intervals; x stays above 0 where a steep cubic dips below it."""
        inside = self.knots[:-1, None] + np.diff(self.knots)[:, None] * (np.arange(parts) / parts)
        knots, x = np.append(inside.ravel(), 1.0), self.values[::2]
        values = self.at(knots)
        lowest = np.repeat(_LOWEST * np.minimum(x[1:], x[:-1]), parts)
        values[:-2:2] = np.maximum(values[:-2:2], lowest)
        return SquaredRate(knots, values)

    def times(self) -> Array:
        """(n + 1,) about, at the knots."""
        pace = 1.0 / np.sqrt(self.values[::2])
        return np.concatenate([[0.0], np.cumsum((pace[1:] + pace[:-1]) / 2 * np.diff(self.knots))])


def law_in_time(motion: SquaredRate, length: float, unit: float, per_jerk: Array) -> TimeLaw | None:
    """The law whose arc length, speed and acceleration at the knots are the motion's, quartic in between.

    Over an interval of time h a quartic that joins (s, v, a) and (s + ds, v+, a+) exists for one h alone:
    ds = h (v + v+) / 2 + h^2 (a - a+) / 12. With V = (v+ - v - a h) / h^2 and A = (a+ - a) / h its third derivative
    goes from 6 V - 2 A to 4 A - 6 V. Intervals are halved until that is close to the motion's own; None where
    it does not come close.

    Args:
        motion: in a unit of time.
        length: of the path [m].
        unit: of time [s].
        per_jerk: (n + 1,) at the motion's knots, the share of the limits of jerk that one m/s^3 along the path uses.
    """
    knots = motion.knots
    for _ in range(_HALVINGS):
        if not (motion.at(knots)[::2] > 0.0).all():
            return None
        found = _quartics(knots, motion, length, unit)
        own = _third_derivatives(knots, motion, length, unit)
        away = np.abs(found.jerks - own).max(axis=0) * np.interp((knots[1:] + knots[:-1]) / 2, motion.knots, per_jerk)
        rough = ~(away <= _FAITHFUL)  # where no quartic joins the ends too
        if not rough.any():
            break
        knots = np.sort(np.append(knots, (knots[1:] + knots[:-1])[rough] / 2))
    s, v, a, h, (first, last) = found
    if not (h > 0.0).all():
        return None
    times = np.concatenate([[0.0], np.cumsum(h)])
    return TimeLaw("jerk", times, s, v, a[:-1], first, (last - first) / h)


class _Quartics(NamedTuple):
    """Arc length, speed and acceleration (n + 1,) at knots; times (n,) and jerks (2, n) of the intervals."""

    position: Array
    speed: Array
    acceleration: Array
    steps: Array
    jerks: Array


def _quartics(knots: Array, motion: SquaredRate, length: float, unit: float) -> _Quartics:
    share, first, second, _ = smoothstep(knots)
    at_knots = motion.at(knots)
    x, w = at_knots[::2] / unit**2, at_knots[1::2] / unit**2
    s, v, a = length * share, length * first * np.sqrt(x), length * (second * x + first * w)
    s[-1] = length
    v[[0, -1]] = a[[0, -1]] = 0.0
    step = length * _shares(knots)
    mean, bend = (v[:-1] + v[1:]) / 2, (a[:-1] - a[1:]) / 12
    with np.errstate(invalid="ignore"):
        h = 2.0 * step / (mean + np.sqrt(mean**2 + 4.0 * bend * step))
    by_speed, by_acceleration = (np.diff(v) - a[:-1] * h) / h**2, np.diff(a) / h
    jerks = np.stack([6.0 * by_speed - 2.0 * by_acceleration, 4.0 * by_acceleration - 6.0 * by_speed])
    return _Quartics(s, v, a, h, jerks)


def _shares(knots: Array) -> Array:
    """(n,) of the arc length, one for each interval: differences of the whole, which is rounded, tell no small ones."""
    sizes = np.diff(knots)
    inside = knots[:-1, None] + sizes[:, None] * (_NODES + 1.0) / 2.0
    return sizes / 2.0 * (smoothstep(inside)[1] @ _WEIGHTS)


def _third_derivatives(knots: Array, motion: SquaredRate, length: float, unit: float) -> Array:
    """(2, n) of the arc length by time, where each interval starts and where it ends."""
    _, first, second, third = smoothstep(knots)
    at_knots = motion.at(knots)
    x, w = at_knots[::2], at_knots[1::2]
    smooth = 3.0 * second * w + third * x
    size, slope = np.diff(knots), np.diff(x) / np.diff(knots)
    z = (3.0 * slope - 4.0 * w[:-1] - 2.0 * w[1:]) / size, (2.0 * w[:-1] + 4.0 * w[1:] - 3.0 * slope) / size
    ends = slice(None, -1), slice(1, None)
    return np.stack([np.sqrt(x[e]) * (first[e] * z[k] + smooth[e]) for k, e in enumerate(ends)]) * (length / unit**3)
