"""Repair of a motion that breaks its limits by a little: the least stretch of time that brings every peak within
limits.

A stretch of time by f divides speeds by f, accelerations by f^2 and jerks by f^3. The torque at rest does not change.
With r = 1 / f the torque is quadratic in r, and its mean square is a quartic. So each sample that is too high gives a
largest r. No stretch changes a position. The stretched motion is verified again. If the samples keep a limit but its
proved bound is still above it, time is stretched by a little more.
"""

from __future__ import annotations

from dataclasses import dataclass

from kinematics import Array, Mechanism, Value
from trajectory.errors import LimitsExceeded
from trajectory.limits import Limits, Sampled
from trajectory.motions import TimedMotion
from trajectory.verification import Verification, integrals, parts_of, verify

REPAIRABLE = 1.01  # the largest peak over limit that is repaired
_ROUNDING = 1e-12
# Steps of a further stretch. They are few and coarse, so that the answer does not depend on a bound's last digits.
_LITTLE, _TRIES = 1e-5, 11
_NEEDED = 0.5  # share of a bound's excess that the time needs, as accelerations fall with the square of the stretch


@dataclass(frozen=True, eq=False)
class Repaired(Value):
    """A motion within its limits.

    Attributes:
        motion: the motion, stretched if needed.
        factor: the factor that stretched the time; 1 without a stretch.
        before, verification: the measurements before and after.
    """

    motion: TimedMotion
    factor: float
    before: Verification
    verification: Verification


def repair(robot: Mechanism, timed: TimedMotion, limits: Limits, payload: float) -> Repaired:
    """Verify a motion, and stretch it by the least factor that brings it within its limits.

    Args:
        robot, timed, limits, payload: as for `verify`.

    Raises:
        LimitsExceeded: a peak is above `REPAIRABLE` times its limit, something other than a peak fails, or the
            stretched motion still fails.
    """
    before = verify(robot, timed, limits, payload)
    if before.ok:
        return Repaired(timed, 1.0, before, before)
    peaks = before.peak_over_limit
    paced = {limit.name: limit for limit in limits if limit.pace_power and limit.name in peaks}
    mendable = paced.keys() | {f"{name}, proved" for name in paced}
    beyond = {name: value for name, value in before.failures.items() if name not in mendable or not value <= REPAIRABLE}
    if beyond:
        raise LimitsExceeded(beyond, REPAIRABLE)
    motion = _sampled(robot, timed, payload)
    factors = [limit.least_stretch(peaks[name], motion, limits) for name, limit in paced.items()]
    factor, after = max(factors, default=1.0) * (1.0 + _ROUNDING), before
    for more in (0.0, *(_LITTLE * 2.0**k for k in range(_TRIES))):
        if more < _NEEDED * (max(after.proved.values(), default=1.0) - 1.0):
            continue  # not enough
        stretched = timed.stretched(factor * (1.0 + more))
        after = verify(robot, stretched, limits, payload)
        if after.ok:
            return Repaired(stretched, factor * (1.0 + more), before, after)
        if not after.failures.keys() <= mendable:
            break
    raise LimitsExceeded(after.failures, 1.0)


def _sampled(robot: Mechanism, timed: TimedMotion, payload: float) -> Sampled:
    parts = parts_of(timed)
    times = parts.times(timed)

    def mean(values: Array) -> Array:
        found: Array = integrals(times, values).sum(axis=0) / times[-1, -1]
        return found

    return Sampled(robot, parts.tool(timed), payload, mean)
