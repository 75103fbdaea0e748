"""Repair of a motion that breaks its limits by a little: the least stretch of time that brings every peak within.

Stretching time by f divides speeds by f, accelerations by f^2 and jerks by f^3. Torque keeps the weight's part c, so
with g = 1 / f^2 it is c + g (tau - c), linear in g: each sample that is too high gives its largest g, and the least
of them is the factor. The stretched motion is then verified from scratch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinematics import Mechanism
from kinematics.dynamics import inverse_dynamics
from trajectory.errors import LimitsExceeded
from trajectory.limits import Limits
from trajectory.motion import motion_of
from trajectory.timed import TimedMotion
from trajectory.verification import Verification, sampling, verify

REPAIRABLE = 1.01  # the largest peak over limit that is repaired
_POWERS = {
    "joint speed": 1.0,
    "joint acceleration": 2.0,
    "joint jerk": 3.0,
    "tool speed": 1.0,
    "tool acceleration": 2.0,
}
_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class Repaired:
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
    beyond = {name: value for name, value in before.failures.items() if name not in peaks or not value <= REPAIRABLE}
    if beyond:
        raise LimitsExceeded(beyond, REPAIRABLE)
    factors = [peaks[name] ** (1 / power) for name, power in _POWERS.items() if name in peaks]
    factor = max(1.0, *factors, _torque_factor(robot, timed, limits, payload)) * (1.0 + _ROUNDING)
    stretched = timed.stretched(factor)
    after = verify(robot, stretched, limits, payload)
    if not after.ok:
        raise LimitsExceeded(after.failures, 1.0)
    return Repaired(stretched, factor, before, after)


def _torque_factor(robot: Mechanism, timed: TimedMotion, limits: Limits, payload: float) -> float:
    """The least stretch that keeps the torque limits.

    Raises:
        LimitsExceeded: the weight alone is beyond a limit.
    """
    limit = limits.of_joints("torque", len(robot.joint_names))
    if limit is None:
        return 1.0
    motion = motion_of(robot, timed.within(sampling(timed))[1], payload)
    rest = np.zeros_like(motion.tool.pose)
    weight = inverse_dynamics(robot, payload, motion.tool.pose, rest, rest)
    static = float((np.abs(weight) / limit).max())
    if not static < 1.0:
        raise LimitsExceeded({"torque at rest": static}, 1.0)
    over = np.abs(motion.torque) > limit
    if not over.any():
        return 1.0
    allowed = (np.sign(motion.torque) * limit - weight)[over] / (motion.torque - weight)[over]
    return float(allowed.min() ** -0.5)
