"""A timed motion travelled at another pace: its own time tau becomes a function of the time t."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from trajectory.knots import interval_of
from trajectory.motion import PoseMotion, largest_speed, travelled, travelled_snap
from trajectory.path import Array
from trajectory.timed import TimedMotion
from trajectory.timing import TimeLaw

_INSIDE = 1e-9  # of an interval: how far from its knots one-sided limits are taken


@dataclass(frozen=True, eq=False)
class PacedMotion:
    """p(tau(t)): the same way in space, or a part of it, whatever the pace. tau' = 1 is the motion itself.

    Attributes:
        motion: p(tau).
        pace: tau in time; each knot of the motion that it passes is one of its own.
    """

    motion: TimedMotion
    pace: TimeLaw

    @property
    def name(self) -> str:
        """Of the pace."""
        return self.pace.name

    @property
    def times(self) -> Array:
        """(k + 1,) knots of the pace [s]."""
        return self.pace.times

    @property
    def progress(self) -> Array:
        """(k + 1,) share of the way at each knot."""
        along = np.interp(self.pace.position, self.motion.times, self.motion.progress)
        return (along - along[0]) / (along[-1] - along[0])

    @property
    def duration(self) -> float:
        """T [s]."""
        return self.pace.duration

    @property
    def ends(self) -> Array:
        """(2, n) where the pace starts and ends on the motion."""
        return self.motion.at(self.pace.position[[0, -1]]).pose

    def at(self, t: Array) -> PoseMotion:
        """As `TimedMotion.at`."""
        along = self.pace.at(t)
        return travelled(self.motion.at(along.position), along)

    def within(self, fractions: Array) -> tuple[Array, PoseMotion]:
        """As `TimedMotion.within`."""
        times, along = self.pace.within(fractions)
        inside = one_sided(self.pace.position, along.position)
        return times, travelled(self.motion.at(inside), along)

    def stretched(self, factor: float) -> PacedMotion:
        """As `TimedMotion.stretched`."""
        return replace(self, pace=self.pace.stretched(factor))

    @property
    def kink(self) -> float:
        """That of the motion."""
        return self.motion.kink

    def enclose_snap(self, low: Array, high: Array) -> Array:
        """As `TimedMotion.enclose_snap`."""
        along, half = self.pace.at(0.5 * low + 0.5 * high), (high - low) * (0.5 + _INSIDE)
        away, knots = half * largest_speed(along, half), self.motion.times
        interval = interval_of(knots, along.position)
        first, last = (np.clip(along.position + d, knots[interval], knots[interval + 1]) for d in (-away, away))
        least, most = self.motion.enclose_snap(first, last)
        _, *derivatives = self.motion.at(along.position)
        return travelled_snap([*derivatives, 0.5 * least + 0.5 * most], 0.5 * (most - least), along, half)


def one_sided(knots: Array, tau: Array) -> Array:
    """(k, j) times in each interval of (k + 1,) knots, taken off the knots so that each stays in its own interval."""
    first, last = knots[:-1, None], knots[1:, None]
    gap = _INSIDE * (last - first)
    return np.clip(tau, first + gap, last - gap)
