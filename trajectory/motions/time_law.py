"""A time law: the exact motion along a path in time. Any method may find it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from kinematics import Array, InvalidField, InvalidShape, InvalidValue, Value, bisected
from trajectory.paths import located, throughout

_FINEST = 2.0**-60  # of an interval: how closely the time is found at which a place is passed
_ROUNDING = 1e-9  # of the length or the speed
_ULPS = 2.0  # of the duration: both knots of an interval are rounded
_SAME = 1e-13  # of the length: closer knots are one


class PathMotion(NamedTuple):
    """Arc length and its time derivatives, each of one shape [m, m/s, m/s^2, m/s^3, m/s^4]."""

    position: Array
    speed: Array
    acceleration: Array
    jerk: Array
    snap: Array


@dataclass(frozen=True, eq=False)
class TimeLaw(Value):
    """Arc length as a piecewise quartic of time: s''' is linear in each interval.

    Attributes:
        name: the name of the method that found it.
        times: (n + 1,) knots, the first at 0 [s].
        position: (n + 1,) s at the knots [m].
        speed: (n + 1,) s' at the knots, never negative [m/s].
        acceleration: (n,) s'' where each interval starts [m/s^2].
        jerk: (n,) s''' where each interval starts [m/s^3].
        snap: (n,) s'''' of each interval [m/s^4].

    Raises:
        InvalidShape, InvalidValue: arrays do not fit together, are not finite, or intervals do not join at the knots.
    """

    name: str
    times: Array
    position: Array
    speed: Array
    acceleration: Array
    jerk: Array
    snap: Array

    def __post_init__(self) -> None:
        for field in ("times", "position", "speed", "acceleration", "jerk", "snap"):
            array = np.array(getattr(self, field), dtype=float)
            expected = np.shape(self.times)[0] - (field in ("acceleration", "jerk", "snap"))
            if array.shape != (expected,):
                raise InvalidShape(f"TimeLaw {field}", [str(k) for k in range(expected)], array.shape)
            if not np.isfinite(array).all():
                raise InvalidField("TimeLaw", field, "a number that is not finite", "finite numbers")
            array.setflags(write=False)
            object.__setattr__(self, field, array)
        if self.times.size < 2 or self.times[0] != 0.0 or not (np.diff(self.times) > 0).all():
            raise InvalidField("TimeLaw", "times", "knots that do not increase from 0", "increasing from 0 s")
        if (self.speed < 0).any():
            raise InvalidField("TimeLaw", "speed", float(self.speed.min()), "at least 0 m/s, as a law never goes back")
        self._require_joined()

    @classmethod
    def constant_acceleration(cls, name: str, position: Array, speed: Array) -> TimeLaw:
        """The law whose s'' is constant between gridpoints, so that s'^2 is linear in s.

        Args:
            name: of the method.
            position: (n + 1,) increasing arc lengths [m].
            speed: (n + 1,) path speed there, zero at most at one end of an interval [m/s].

        Raises:
            InvalidValue: an interval that is never left.
        """
        position, speed = np.asarray(position, dtype=float), np.asarray(speed, dtype=float)
        steps, sums = np.diff(position), speed[1:] + speed[:-1]
        if not (steps > 0).all():
            raise InvalidField("TimeLaw", "position", "gridpoints that do not increase", "increasing arc lengths")
        if not (sums > 0).all():
            at = float(position[int(np.argmin(sums))])
            raise InvalidField(
                "TimeLaw", "speed", f"rest all through the interval at s = {at:.6g} m", "a speed > 0 m/s"
            )
        times = np.concatenate([[0.0], np.cumsum(2 * steps / sums)])
        none = np.zeros_like(steps)
        return cls(name, times, position, speed, np.diff(speed) * sums / (2 * steps), none, none)

    @classmethod
    def joined(cls, laws: Sequence[TimeLaw]) -> TimeLaw:
        """One after another, each from where the one before it ends and at its speed; the first law's name."""
        times = np.cumsum([0.0, *(law.duration for law in laws)])
        ways = np.cumsum([laws[0].position[0], *(np.ptp(law.position) for law in laws)])
        after = [slice(0 if k == 0 else 1, None) for k in range(len(laws))]
        return cls(
            laws[0].name,
            np.concatenate([t + law.times[k] for t, law, k in zip(times[:-1], laws, after, strict=True)]),
            np.concatenate(
                [s + law.position[k] - law.position[0] for s, law, k in zip(ways[:-1], laws, after, strict=True)]
            ),
            np.concatenate([law.speed[k] for law, k in zip(laws, after, strict=True)]),
            *(np.concatenate([getattr(law, name) for law in laws]) for name in ("acceleration", "jerk", "snap")),
        )

    @property
    def duration(self) -> float:
        """T [s]."""
        return float(self.times[-1])

    def at(self, t: Array) -> PathMotion:
        """Exact motion at times (...,) in [0, T]; the right-hand limit at a knot, the left-hand one at T.

        Raises:
            InvalidValue: a time outside the law by more than rounding, or not a number.
        """
        return self.inside(*located(self.times, t))

    def within(self, fractions: Array) -> tuple[Array, PathMotion]:
        """Every interval at fractions (k,) of its own time, so that 0 and 1 give its one-sided limits.

        Returns:
            Times (n, k) [s] and the motion there, (n, k) each.
        """
        interval, since = throughout(self.times, fractions)
        return self.times[interval] + since, self.inside(interval, since)

    def stretched(self, factor: float) -> TimeLaw:
        """The same path travelled `factor` times as long.

        Raises:
            InvalidValue: the factor is not finite and positive.
        """
        if not (np.isfinite(factor) and factor > 0):
            raise InvalidValue("factor of a stretched law", factor, "finite and > 0")
        return replace(
            self,
            times=self.times * factor,
            speed=self.speed / factor,
            acceleration=self.acceleration / factor**2,
            jerk=self.jerk / factor**3,
            snap=self.snap / factor**4,
        )

    def cut(self, positions: Array) -> TimeLaw:
        """The same law with knots where it passes these arc lengths (k,) too [m]; a knot that it has stays one."""
        interval, since = self._passing(positions)
        times = self.times[interval] + since
        new = (times > self.times[interval]) & (times < self.times[interval + 1])
        times, there = times[new], self.inside(interval[new], since[new])
        at_knots, starts = (np.argsort(np.append(own, times), kind="stable") for own in (self.times, self.times[:-1]))
        return replace(
            self,
            times=np.append(self.times, times)[at_knots],
            position=np.append(self.position, there.position)[at_knots],
            speed=np.append(self.speed, there.speed)[at_knots],
            acceleration=np.append(self.acceleration, there.acceleration)[starts],
            jerk=np.append(self.jerk, there.jerk)[starts],
            snap=np.append(self.snap, there.snap)[starts],
        )

    def _passing(self, positions: Array) -> tuple[Array, Array]:
        """The intervals in which it passes arc lengths away from its knots, and how long after each one's start."""
        after = np.clip(np.searchsorted(self.position, positions), 1, self.position.size - 1)
        apart = np.minimum(positions - self.position[after - 1], self.position[after] - positions)
        away = apart > _SAME * np.ptp(self.position)
        interval, positions = after[away] - 1, positions[away]
        low, high = np.zeros(interval.size), np.diff(self.times)[interval]
        finest = _FINEST * high
        return interval, bisected(lambda since: self.inside(interval, since).position < positions, low, high, finest)[0]

    def inside(self, interval: Array, since: Array) -> PathMotion:
        """In these intervals (...,), from 0, so long (...,) after each one's start [s]: its one-sided limits too."""
        coefficients = (self.position, self.speed, self.acceleration, self.jerk, self.snap)
        s, v, a, j, d = (x[interval] for x in coefficients)
        position = s + since * (v + since * (a / 2 + since * (j / 6 + since * d / 24)))
        speed = v + since * (a + since * (j / 2 + since * d / 6))
        acceleration, jerk = a + since * (j + since * d / 2), j + since * d
        return PathMotion(np.clip(position, self.position[0], self.position[-1]), speed, acceleration, jerk, d)

    def _require_joined(self) -> None:
        """Each interval must end where the next one starts."""
        _, ends = self.within(np.array([1.0]))
        late = _ULPS * np.finfo(float).eps * self.duration  # by which a knot's time may be rounded
        gaps = (
            ("position", np.abs(ends.position[:, 0] - self.position[1:]), np.ptp(self.position), self.speed[1:]),
            ("speed", np.abs(ends.speed[:, 0] - self.speed[1:]), self.speed.max(), np.abs(ends.acceleration[:, 0])),
        )
        for field, gap, scale, steepness in gaps:
            if not (gap <= _ROUNDING * scale + late * steepness).all():
                k = int(np.argmax(gap))
                raise InvalidField("TimeLaw", field, f"a gap of {gap[k]:.3g} at knot {k + 1}", "intervals that join")
