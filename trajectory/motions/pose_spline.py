"""A motion of the pose itself: piecewise cubic in time, with no path and no law apart."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from kinematics import Array, InvalidField, InvalidShape, InvalidValue, Value
from trajectory.motions.motion import PoseMotion
from trajectory.paths import PathBox, located, throughout

_ROUNDING = 1e-9  # of the largest value, or of an interval
_SLACK = (
    1e-12  # relative, to a value and to the largest one: far more than the error of evaluation in double arithmetic
)


@dataclass(frozen=True, eq=False)
class PoseSpline(Value):
    """The pose with a piecewise constant third derivative.

    Attributes:
        name: of the method that found it.
        times: (k + 1,) knots, the first at 0 [s].
        pose, velocity, acceleration: (k, n) where each interval starts.
        jerk: (k, n) of each interval.
        ends: (2, n) the poses that were asked for at the start and at the end.

    Raises:
        InvalidShape, InvalidValue: arrays that do not fit together, are not finite or do not join at the knots.
    """

    name: str
    times: Array
    pose: Array
    velocity: Array
    acceleration: Array
    jerk: Array
    ends: Array

    def __post_init__(self) -> None:
        if self.times.ndim != 1 or self.times[0] != 0.0 or not (np.diff(self.times) > 0.0).all():
            raise InvalidField("PoseSpline", "times", "knots that do not increase from 0", "increasing from 0 s")
        shape = (self.times.size - 1, np.shape(self.ends)[-1])
        for field in ("pose", "velocity", "acceleration", "jerk"):
            values = getattr(self, field)
            if np.shape(values) != shape:
                raise InvalidShape(f"PoseSpline {field}", [str(k) for k in range(shape[1])], np.shape(values))
            if not np.isfinite(values).all():
                raise InvalidField("PoseSpline", field, "a number that is not finite", "finite numbers")
        _, motion = self.within(np.array([0.0, 1.0]))
        for field, values in zip(("pose", "velocity", "acceleration"), motion, strict=False):
            gap = np.abs(values[:-1, 1] - values[1:, 0])
            if not (gap <= _ROUNDING * np.abs(values).max()).all():
                k = int(gap.max(axis=-1).argmax()) + 1
                raise InvalidField("PoseSpline", field, f"a gap of {gap.max():.3g} at knot {k}", "intervals that join")

    @property
    def progress(self) -> Array:
        """(k + 1,) share of the duration at each knot."""
        result: Array = self.times / self.times[-1]
        return result

    @property
    def duration(self) -> float:
        """T [s]."""
        return float(self.times[-1])

    def at(self, t: Array) -> PoseMotion:
        """As `TimedMotion.at`."""
        return self.inside(*located(self.times, t))

    def within(self, fractions: Array) -> tuple[Array, PoseMotion]:
        """As `TimedMotion.within`."""
        interval, since = throughout(self.times, fractions)
        return self.times[interval] + since, self.inside(interval, since)

    def stretched(self, factor: float) -> PoseSpline:
        """As `TimedMotion.stretched`."""
        if not (np.isfinite(factor) and factor > 0.0):
            raise InvalidValue("factor of a stretched motion", factor, "finite and > 0")
        return replace(
            self,
            times=self.times * factor,
            velocity=self.velocity / factor,
            acceleration=self.acceleration / factor**2,
            jerk=self.jerk / factor**3,
        )

    def enclose_snap(self, low: Array, high: Array) -> Array:  # noqa: ARG002
        """As `TimedMotion.enclose_snap`: the jerk is constant in each interval."""
        return np.zeros((2, low.size, self.ends.shape[-1]))

    @property
    def kink(self) -> float:
        """None: the intervals join to the second derivative."""
        return 0.0

    def inside(self, interval: Array, since: Array) -> PoseMotion:
        """As `TimedMotion.inside`."""
        p, v, a, j = (x[interval] for x in (self.pose, self.velocity, self.acceleration, self.jerk))
        t = since[..., None]
        return PoseMotion(p + t * (v + t * (a / 2 + t * j / 6)), v + t * (a + t * j / 2), a + t * j, j)


@dataclass(frozen=True)
class InTime:
    """A spline as a path by the time in place of the arc length, to be proved as one (`certify_path`)."""

    spline: PoseSpline
    pose_names: tuple[str, ...]

    @property
    def length(self) -> float:
        """T [s]."""
        return self.spline.duration

    @property
    def knots(self) -> tuple[float, ...]:
        """(k + 1,) of the spline [s]."""
        return tuple(self.spline.times.tolist())

    def evaluate(self, s: Array, order: int = 3) -> tuple[Array, ...]:
        """The pose and its derivatives by time."""
        return tuple(self.spline.at(s)[: order + 1])

    def waypoint(self, s: float) -> int | None:  # noqa: ARG002
        """None."""
        return None

    def enclose(self, low: Array, high: Array) -> PathBox:
        """As `Path.enclose`: from the middle, where the jerk is known, one order after the other."""
        pose, velocity, acceleration, jerk = self.spline.at(0.5 * low + 0.5 * high)
        half = ((high - low) * (0.5 + _ROUNDING))[:, None]
        rate = half * (np.abs(acceleration) + half * np.abs(jerk)) + _SLACK * (
            np.abs(self.spline.velocity).max() + np.abs(velocity)
        )
        away = half * (np.abs(velocity) + rate) + _SLACK * (np.abs(self.spline.pose).max() + np.abs(pose))
        return PathBox(pose - away, pose + away, velocity - rate, velocity + rate)
