"""Repair of a motion that breaks its limits by a little: the least stretch of time that brings every peak within.

Stretching time by f divides speeds by f, accelerations by f^2 and jerks by f^3. Torque keeps what it needs at rest:
with r = 1 / f it is quadratic in r, and its mean square a quartic, so that each sample that is too high gives its
largest r. No stretch changes a position. The stretched motion is then verified from scratch, and stretched by a little
more where a bound that was proved is still above a limit that the samples keep.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kinematics import Array, Mechanism, Value
from trajectory.errors import LimitsExceeded
from trajectory.limits import Limits
from trajectory.motions import ByRate, TimedMotion, motion_of, torque_by_rate
from trajectory.verification import Verification, integrals, parts_of, verify

REPAIRABLE = 1.01  # the largest peak over limit that is repaired
_POWERS = {
    "joint speed": 1.0,
    "joint acceleration": 2.0,
    "joint jerk": 3.0,
    "tool speed": 1.0,
    "tool acceleration": 2.0,
}
_OF_TORQUE = ("torque", "torque at speed", "rms torque")
_ROUNDING = 1e-12
# Steps of a further stretch: few and coarse, so that the answer does not hang on a bound's last digits.
_LITTLE, _TRIES = 1e-5, 11
_NEEDED = 0.5  # of a bound's excess; accelerations fall by the square


@dataclass(frozen=True, eq=False)
class Repaired(Value):
    """A motion within its limits.

    Attributes:
        motion: stretched where it had to be.
        factor: by how much time was stretched; 1 where nothing was.
        before, verification: what was measured before and after.
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
        LimitsExceeded: a peak is over `REPAIRABLE` times its limit, something else than a peak fails, or the stretched
            motion still fails.
    """
    before = verify(robot, timed, limits, payload)
    if before.ok:
        return Repaired(timed, 1.0, before, before)
    peaks = before.peak_over_limit
    mendable = {*_POWERS, *_OF_TORQUE} & peaks.keys()
    mendable |= {f"{name}, proved" for name in mendable}
    beyond = {name: value for name, value in before.failures.items() if name not in mendable or not value <= REPAIRABLE}
    if beyond:
        raise LimitsExceeded(beyond, REPAIRABLE)
    factors = [peaks[name] ** (1 / power) for name, power in _POWERS.items() if name in peaks]
    factor, after = max(1.0, *factors, 1.0 / _slowest(robot, timed, limits, payload)) * (1.0 + _ROUNDING), before
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


def _slowest(robot: Mechanism, timed: TimedMotion, limits: Limits, payload: float) -> float:
    """The largest share r = 1 / f of the speed that keeps the torque, the speed-torque line and the RMS torque.

    Raises:
        LimitsExceeded: what the torque keeps at rest is beyond a limit already.
    """
    parts = parts_of(timed)
    times, tool = parts.times(timed), parts.tool(timed)
    torque = torque_by_rate(robot, payload, tool.pose, tool.velocity, tool.acceleration)
    count = len(robot.actuator_names)
    peak, stall, fastest, rms = (
        limits.of_joints(name, count) for name in ("torque", "stall_torque", "no_load_speed", "rms_torque")
    )
    shares = [1.0]
    if peak is not None:
        shares.append(_share("torque", torque, peak, np.zeros_like(torque.linear)))
    if stall is not None and fastest is not None:
        slope = stall / fastest * np.abs(motion_of(robot, tool, payload).joints.first)
        shares.append(_share("torque at speed", torque, stall, slope))
    if rms is not None:
        shares += [_rms_share(times, ByRate(*(c[..., k] for c in torque)), float(rms[k])) for k in range(count)]
    return min(shares)


def _share(quantity: str, torque: ByRate, limit: Array, slope: Array) -> float:
    """The largest r with |constant + linear r + quadratic r^2| + slope r <= limit at each sample that exceeds it."""
    sign = np.sign(sum(torque))
    rest = limit - sign * torque.constant
    if not rest.min() > 0.0:
        raise LimitsExceeded({f"{quantity} at rest": float((1.0 - rest / limit).max())}, 1.0)
    linear, quadratic = sign * torque.linear + slope, sign * torque.quadratic
    over = linear + quadratic > rest
    c, b, a = rest[over], linear[over], quadratic[over]
    # The first root, free of cancellation; it is real, as the limit is kept at r = 0 and broken at r = 1.
    return float(np.min(2 * c / (b + np.sqrt(b**2 + 4 * a * c)), initial=1.0))


def _rms_share(times: Array, torque: ByRate, limit: float) -> float:
    """The largest r in [0, 1] up to which one joint's mean square torque, a quartic in r, keeps its limit."""
    c, b, a = (x[..., None] for x in torque)
    terms = np.concatenate([a * a, 2 * a * b, b * b + 2 * a * c, 2 * b * c, c * c], axis=-1)
    quartic = integrals(times, terms).sum(axis=0) / times[-1, -1]
    quartic[-1] -= limit**2
    if not quartic[-1] < 0.0:
        raise LimitsExceeded({"rms torque at rest": math.sqrt(quartic[-1] + limit**2) / limit}, 1.0)
    if quartic.sum() <= 0.0:
        return 1.0
    roots = np.roots(quartic)
    real = roots.real[np.abs(roots.imag) < _ROUNDING]
    return float(real[(real > 0.0) & (real <= 1.0)].max())
