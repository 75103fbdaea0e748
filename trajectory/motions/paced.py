"""A timed motion at another pace: the motion's own time tau is a function of the time t."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from kinematics import Array, InvalidValue, Value
from trajectory.motions.motion import PoseMotion, largest_speed, travelled, travelled_snap
from trajectory.motions.time_law import PathMotion, TimeLaw
from trajectory.motions.timed_motion import TimedMotion
from trajectory.paths import interval_of, located, throughout

SAME = 1e-12  # of the motion's duration: times that are closer are one
_ROUNDING = 1e-9  # of a part


@dataclass(frozen=True, eq=False)
class PacedMotion(Value):
    """p(tau(t)): the same way in space, or a part of it, whatever the pace. tau' = 1 is the motion itself.

    Attributes:
        motion: p(tau).
        pace: tau in time; each knot of the motion that it passes is one of its own.

    Raises:
        InvalidValue: the pace leaves the motion's time, turns back, or passes a knot of the motion between two of its
            own.
    """

    motion: TimedMotion
    pace: TimeLaw

    def __post_init__(self) -> None:
        tau, knots, same = self.pace.position, self.motion.times, SAME * self.motion.duration
        if tau[0] < -same or tau[-1] > self.motion.duration + same or (np.diff(tau) < 0.0).any():
            found = f"knots from {tau[0]:.9g} to {tau[-1]:.9g} s of the motion's time"
            raise InvalidValue("pace of a motion", found, f"rising knots in [0, {self.motion.duration:.9g}] s")
        passed = knots[(knots > tau[0] + same) & (knots < tau[-1] - same)]
        after = np.searchsorted(tau, passed)
        hidden = passed[np.minimum(tau[after] - passed, passed - tau[after - 1]) > same]
        if hidden.size:
            found = f"no knot at {hidden[0]:.12g} s of the motion's time"
            raise InvalidValue("pace of a motion", found, "a knot at each knot of the motion that it passes")

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
        result: Array = (along - along[0]) / (along[-1] - along[0])
        return result

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
        return self.inside(*located(self.times, t))

    def within(self, fractions: Array) -> tuple[Array, PoseMotion]:
        """As `TimedMotion.within`."""
        interval, since = throughout(self.times, fractions)
        return self.times[interval] + since, self.inside(interval, since)

    def inside(self, interval: Array, since: Array) -> PoseMotion:
        """As `TimedMotion.inside`."""
        along = self.pace.inside(interval, since)
        return travelled(self._passed(interval, along)[1], along)

    def stretched(self, factor: float) -> PacedMotion:
        """As `TimedMotion.stretched`."""
        return replace(self, pace=self.pace.stretched(factor))

    @property
    def kink(self) -> float:
        """That of the motion."""
        return self.motion.kink

    def enclose_snap(self, low: Array, high: Array) -> Array:
        """As `TimedMotion.enclose_snap`."""
        interval, since = located(self.times, 0.5 * low + 0.5 * high)
        along, half = self.pace.inside(interval, since), (high - low) * (0.5 + _ROUNDING)
        theirs, (_, *derivatives) = self._passed(interval, along)
        away, knots = half * largest_speed(along, half) + SAME * self.motion.duration, self.motion.times
        first, last = (np.clip(along.position + d, knots[theirs], knots[theirs + 1]) for d in (-away, away))
        least, most = self.motion.enclose_snap(first, last)
        return travelled_snap([*derivatives, 0.5 * least + 0.5 * most], 0.5 * (most - least), along, half)

    def _passed(self, interval: Array, along: PathMotion) -> tuple[Array, PoseMotion]:
        """The motion's interval in which each interval of the pace lies, and the motion there."""
        tau, knots = self.pace.position, self.motion.times
        theirs = interval_of(knots, 0.5 * tau[:-1] + 0.5 * tau[1:])[interval]
        since = np.clip(along.position - knots[theirs], 0.0, np.diff(knots)[theirs])
        return theirs, self.motion.inside(theirs, since)
