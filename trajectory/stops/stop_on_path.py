"""An emergency stop along the path: from any instant of a motion to rest, on the motion's own way.

The pace of the motion falls from 1 to 0. With a jerk limit the acceleration is continuous (`smooth_braking`). Without
one the stop is as short as possible, and the acceleration steps where braking starts and where it ends (`braking`).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from kinematics import Array, InvalidValue, Mechanism, Value
from trajectory.errors import LimitsExceeded, TimingFailed
from trajectory.limits import LIMITS, Disc, Limits, Linear, Squared, Third
from trajectory.motions import PacedMotion, TimedMotion, TimeLaw
from trajectory.stops.braking import braking
from trajectory.stops.smooth_braking import smooth_braking
from trajectory.verification import Verification, verify

_MARGINS = (1e-3, 4e-3, 1e-2, 3e-2)  # of the limits: the first with which they are proved between the knots too
_LATER = 2  # knots of the motion at which braking may start where it does not succeed at once
_BRAKING = [limit for limit in LIMITS if limit.kind in (Linear, Disc, Third)]


@dataclass(frozen=True, eq=False)
class EmergencyStop(Value):
    """A verified stop.

    Attributes:
        motion: the motion from the state at `start` to rest.
        start: the time when the stop interrupts the motion [s].
        verification: the measurements of the stop; they include that it continues the motion at `start`.
    """

    motion: PacedMotion
    start: float
    verification: Verification

    @property
    def duration(self) -> float:
        """From the start of the braking to rest [s]."""
        return self.motion.duration

    @property
    def pose(self) -> Array:
        """(n,) where it rests."""
        result: Array = self.motion.ends[1]
        return result


def emergency_stop(robot: Mechanism, timed: TimedMotion, start: float, limits: Limits, payload: float) -> EmergencyStop:
    """A stop on the motion's own way, within every limit except the RMS torque, which belongs to whole ways.

    Without a jerk limit it is the shortest stop. With one, the mean square of its pace over the way is small. If no
    pace is found from `start`, the motion goes on to its next knot, or the one after, and brakes from there.

    Args:
        robot: any mechanism with the motion's kind of pose.
        timed: a motion within these limits.
        start: the time when the stop interrupts the motion, inside (0, T) [s].
        limits: limits of joints and tool.
        payload: mass at the tool [kg].

    Raises:
        InvalidValue: the start is outside the motion, or no limit bounds the braking.
        LimitsExceeded: the stop breaks a limit, for example because the motion does.
        TimingFailed: no pace was found that keeps the jerk limit.
    """
    if not 0.0 < start < timed.duration:
        raise InvalidValue("start of an emergency stop", start, f"inside (0, {timed.duration:.6g}) s")
    if not any(limit.is_set(limits) for limit in _BRAKING):
        names = ", ".join(limit.fields[0].name for limit in _BRAKING)
        raise InvalidValue("Limits for an emergency stop", limits.as_dict(), f"one of {names}")
    kept, before = limits.without(Squared), timed.at(np.array(start))
    why: list[LimitsExceeded | TimingFailed] = []
    margins = _MARGINS if limits.has(Third) else (0.0,)
    later = timed.times[(timed.times > start) & (timed.times < timed.duration)][:_LATER]
    for passed, margin in product(range(later.size + 1), margins):
        cruise = np.append(start, later[:passed])
        try:
            pace = _pace(robot, timed, cruise[-1], kept, payload, margin)
            motion = PacedMotion(timed, _after(cruise, pace))
        except TimingFailed as failed:
            why.append(failed)
            continue
        found = verify(robot, motion, kept, payload, before)
        if found.ok:
            return EmergencyStop(motion, start, found)
        why.append(LimitsExceeded(found.failures, 1.0))
    raise why[-1]


def _after(cruise: Array, pace: TimeLaw) -> TimeLaw:
    """The pace from the last of these times (k + 1,) of the motion on, and the motion's own up to there."""
    held, none = np.ones(cruise.size - 1), np.zeros(cruise.size - 1)
    return TimeLaw(
        pace.name,
        np.append(cruise[:-1] - cruise[0], pace.times + (cruise[-1] - cruise[0])),
        np.append(cruise[:-1], pace.position),
        np.append(held, pace.speed),
        *(np.append(none, part) for part in (pace.acceleration, pace.jerk, pace.snap)),
    )


def _pace(robot: Mechanism, timed: TimedMotion, start: float, limits: Limits, payload: float, margin: float) -> TimeLaw:
    """The constraints that ask for more than their limit are left out: the motion itself would not keep them."""
    limits = limits.less(*(limit for limit in limits if not limit.exact))
    if not limits.has(Third):
        return braking(robot, timed, start, limits, payload)
    return smooth_braking(robot, timed, start, limits, payload, margin)
