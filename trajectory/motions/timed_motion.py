"""Timed motions: the pose as an exact function of time. Any method may find it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol, Self

import numpy as np

from kinematics import Array, InvalidValue, Value
from trajectory.motions.motion import PoseMotion, largest_speed, pose_motion, travelled_snap
from trajectory.motions.time_law import TimeLaw
from trajectory.paths import Path, interval_of, places

_ROUNDING = 1e-9  # of the length
_ULPS = 16.0  # by which arc length, where a knot is, may be rounded


class TimedMotion(Protocol):
    """A motion of the pose from rest to rest, smooth inside each of its intervals of time."""

    @property
    def name(self) -> str:
        """The name of the method that found it."""

    @property
    def times(self) -> Array:
        """(k + 1,) knots, the first at 0 [s]."""

    @property
    def progress(self) -> Array:
        """(k + 1,) how far the motion is at each knot, rising from 0 to 1."""

    @property
    def duration(self) -> float:
        """T [s]."""

    @property
    def ends(self) -> Array:
        """(2, n) the poses that were asked for at the start and at the end."""

    def at(self, t: Array) -> PoseMotion:
        """The motion at times (...,); the right-hand limit at a knot, the left-hand one at T.

        Raises:
            InvalidValue: a time outside [0, T] by more than rounding, or not a number.
        """

    def within(self, fractions: Array) -> tuple[Array, PoseMotion]:
        """Every interval at fractions (j,) of its own time, so that 0 and 1 give its one-sided limits.

        Returns:
            Times (k, j) [s] and the motion there, (k, j, n) each.
        """

    def inside(self, interval: Array, since: Array) -> PoseMotion:
        """The motion in intervals (...,), from 0, so long (...,) after each one's start [s]: one-sided limits too."""

    def stretched(self, factor: float) -> Self:
        """The same motion, `factor` times as slow.

        Raises:
            InvalidValue: the factor is not finite and positive.
        """

    def enclose_snap(self, low: Array, high: Array) -> Array:
        """(2, k, n) bounds of the pose's fourth derivative between two times (k,), each of one interval."""

    @property
    def kink(self) -> float:
        """The largest relative jump of the way or of its first derivatives; 0 is smooth."""


@dataclass(frozen=True, eq=False)
class TimedPath(Value):
    """A path travelled by a time law. Its intervals are those of the law, cut where it passes the path's knots.

    Attributes:
        path: of the pose, by arc length.
        law: arc length in time, over the whole path.

    Raises:
        InvalidValue: the law's arc length is not the path's.
    """

    path: Path
    law: TimeLaw

    def __post_init__(self) -> None:
        ends = (self.law.position[0], self.law.position[-1])
        if not np.allclose(ends, (0.0, self.path.length), rtol=0.0, atol=_ROUNDING * self.path.length):
            raise InvalidValue("arc length of the time law", ends, f"(0, {self.path.length:.9g}) m, the path's")

    @cached_property
    def _cut(self) -> TimeLaw:
        return self.law.cut(np.array(self.path.knots[1:-1]))

    @property
    def name(self) -> str:
        """Of the law."""
        return self.law.name

    @property
    def times(self) -> Array:
        """(k + 1,) knots of the law, and when it passes the path's [s]."""
        return self._cut.times

    @property
    def progress(self) -> Array:
        """(k + 1,) share of the arc length at each knot."""
        result: Array = self._cut.position / self._cut.position[-1]
        return result

    @property
    def duration(self) -> float:
        """T [s]."""
        return self.law.duration

    @property
    def ends(self) -> Array:
        """(2, n) both ends of the path."""
        return self.path.evaluate(np.array([0.0, self.path.length]), 0)[0]

    def at(self, t: Array) -> PoseMotion:
        """As `TimedMotion.at`."""
        return pose_motion(self.path, self._cut.at(t))

    def within(self, fractions: Array) -> tuple[Array, PoseMotion]:
        """As `TimedMotion.within`."""
        times, along = self._cut.within(fractions)
        return times, pose_motion(self.path, along)

    def inside(self, interval: Array, since: Array) -> PoseMotion:
        """As `TimedMotion.inside`."""
        return pose_motion(self.path, self._cut.inside(interval, since))

    def stretched(self, factor: float) -> TimedPath:
        """As `TimedMotion.stretched`."""
        return replace(self, law=self.law.stretched(factor))

    def enclose_snap(self, low: Array, high: Array) -> Array:
        """As `TimedMotion.enclose_snap`."""
        along, half = self._cut.at(0.5 * low + 0.5 * high), (high - low) * (0.5 + _ROUNDING)
        away = half * largest_speed(along, half)
        _, *derivatives = self.path.evaluate(along.position, 4)
        first_s, last_s = (np.clip(along.position + d, 0.0, self.path.length) for d in (-away, away))
        return travelled_snap(derivatives, self._fourth_slack(derivatives[-1], first_s, last_s, away), along, half)

    @property
    def kink(self) -> float:
        """The largest jump, at a knot inside, of one of the first three derivatives by s over the length; of a place
        over the length."""
        knots, length = np.array(self.path.knots), self.path.length
        if knots.size < 3:
            return 0.0
        _, *at_start = self.path.evaluate(knots[:-1], 3)
        _, *at_end = self.path.evaluate(np.nextafter(knots[1:], 0.0), 3)
        unit = np.where(np.arange(len(self.path.pose_names)) < places(self.path.pose_names), 1.0, length)
        steepest, worst = self.path.steepest((knots[1:] + knots[:-1]) / 2, 4), 0.0
        for order in (3, 2, 1):  # each changes within the rounding of s by the most of the next, piece by piece
            start, end = at_start[order - 1], at_end[order - 1]
            rounding = length * np.maximum(steepest[:-1], steepest[1:]) + np.abs(start[1:])
            jump = np.abs(start[1:] - end[:-1]) - _ULPS * np.finfo(float).eps * rounding
            worst = max(worst, float((jump * unit).max()) * length ** (order - 1))
            steepest = np.maximum(np.abs(start), np.abs(end)) + steepest * np.diff(knots)[:, None]
        return worst

    def _fourth_slack(self, fourth: Array, low: Array, high: Array, away: Array) -> Array:
        """How far the fourth derivative by s may be, between two arc lengths (k,), from what it is in the middle.

        Where knots of the path lie between, it may jump.
        """
        knots = np.array(self.path.knots)
        middles = (knots[1:] + knots[:-1]) / 2
        most, slope = (self.path.steepest(middles, order) for order in (4, 5))
        first, last = interval_of(knots, low, "left"), interval_of(knots, high)
        anywhere = most[first]
        for k in range(1, int((last - first).max()) + 1):
            anywhere = np.maximum(anywhere, most[np.minimum(first + k, last)])
        anywhere = anywhere + np.abs(fourth)
        result: Array = np.where((first == last)[:, None], np.minimum(away[:, None] * slope[first], anywhere), anywhere)
        return result
