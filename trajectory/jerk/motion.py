"""A motion of the jerk law between its knots: a cubic x(u) in each interval, its time, and its law in time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from trajectory.jerk.rows import Array, smoothstep
from trajectory.timing import TimeLaw


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

    def finer(self, parts: int) -> SquaredRate:
        """The same on so many times as many intervals."""
        inside = self.knots[:-1, None] + np.diff(self.knots)[:, None] * (np.arange(parts) / parts)
        knots = np.append(inside.ravel(), 1.0)
        return SquaredRate(knots, self.at(knots))

    def times(self) -> Array:
        """(n + 1,) about, at the knots."""
        pace = 1.0 / np.sqrt(self.values[::2])
        return np.concatenate([[0.0], np.cumsum((pace[1:] + pace[:-1]) / 2 * np.diff(self.knots))])


def law_in_time(motion: SquaredRate, length: float, unit: float) -> TimeLaw:
    """The law whose arc length, speed and acceleration at the knots are the motion's, quartic in between.

    Over an interval of time h a quartic that joins (s, v, a) and (s + ds, v+, a+) exists for one h alone:
    ds = h (v + v+) / 2 + h^2 (a - a+) / 12. With V = (v+ - v - a h) / h^2 and A = (a+ - a) / h its third derivative
    goes from 6 V - 2 A to 4 A - 6 V.

    Args:
        motion: in a unit of time.
        length: of the path [m].
        unit: of time [s].
    """
    share, first, second, _ = smoothstep(motion.knots)
    x, w = motion.values[::2] / unit**2, motion.values[1::2] / unit**2
    s, v, a = length * share, length * first * np.sqrt(x), length * (second * x + first * w)
    s[-1] = length
    v[[0, -1]] = a[[0, -1]] = 0.0
    step, mean, bend = np.diff(s), (v[:-1] + v[1:]) / 2, (a[:-1] - a[1:]) / 12
    h = 2.0 * step / (mean + np.sqrt(mean**2 + 4.0 * bend * step))
    by_speed, by_acceleration = (np.diff(v) - a[:-1] * h) / h**2, np.diff(a) / h
    first_jerk, last_jerk = 6.0 * by_speed - 2.0 * by_acceleration, 4.0 * by_acceleration - 6.0 * by_speed
    times = np.concatenate([[0.0], np.cumsum(h)])
    return TimeLaw("jerk", times, s, v, a[:-1], first_jerk, (last_jerk - first_jerk) / h)
