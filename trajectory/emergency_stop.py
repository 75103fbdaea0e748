"""An emergency stop along the path: from any instant of a motion to rest, on the way that it was on.

The motion p(tau) is travelled at a pace tau(t) that falls from 1 to 0. With x = tau'^2 and u = tau'' every limit on
acceleration and torque is linear in (u, x), as in Bobrow, Dubowsky and Gibson, "Time-optimal control of robotic
manipulators along specified paths", IJRR 1985:

    joint acceleration   q' u + q'' x
    torque               i u + k x + c,  its parts by the rate, Coulomb friction in c (`torque_terms`)
    tool acceleration    |p' u + p'' x|, a disc

with a dash for the derivative by tau. The pace takes the least u that they allow, all the way down. No other pace has
a lower x anywhere, since it would have to cross this one with less than the least u: so this is the shortest way to
rest. (0, 0) and (0, 1), the motion held still and the motion itself, are within the limits, and so by convexity is
(0, x) between them: u is never above 0, speeds never rise, and the end of the motion is never passed. The jerk is not
limited: the acceleration steps where braking starts and where it ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from kinematics import InvalidValue, Mechanism
from kinematics.dynamics import inverse_dynamics
from kinematics.motion import actuator_motion
from trajectory.errors import LimitsExceeded
from trajectory.limits import Limits
from trajectory.paced import PacedMotion, one_sided
from trajectory.path import Array
from trajectory.proof import proved_use
from trajectory.timed import TimedMotion
from trajectory.timing import TimeLaw
from trajectory.torque_terms import torque_by_rate
from trajectory.verification import Verification, verify

COARSE = 200  # steps to see about how long the braking is
STEPS = 1000  # of the braking, at least
_WITHIN = 1.0 - 1e-4  # of the limits, for braking to keep them between the steps too
Rows = tuple[Array, Array, Array]  # by_u, by_x, still; each (n, 2, rows), over the limit, at both ends of a step


@dataclass(frozen=True, eq=False)
class EmergencyStop:
    """A stop that was verified.

    Attributes:
        motion: from the state at `start` to rest.
        start: when it interrupts the motion [s].
        verification: of the stop, against every limit but the jerk's.
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
        return self.motion.ends[1]


def emergency_stop(robot: Mechanism, timed: TimedMotion, start: float, limits: Limits, payload: float) -> EmergencyStop:
    """The shortest stop on the motion's own way, within every limit but the jerk's.

    Args:
        robot: any mechanism whose pose is [x, y, z, theta].
        timed: a motion within these limits.
        start: when the braking starts, inside (0, T) [s].
        limits: of joints and tool; a limit of the jerk is not kept.
        payload: mass at the tool [kg].

    Raises:
        InvalidValue: a start at which there is no motion, or nothing that limits the braking.
        LimitsExceeded: the stop breaks a limit, as where the motion already does.
    """
    if not 0.0 < start < timed.duration:
        raise InvalidValue("start of an emergency stop", start, f"inside (0, {timed.duration:.6g}) s")
    if limits.acceleration is limits.torque is limits.tool_acceleration is None:
        raise InvalidValue(
            "Limits for an emergency stop", limits.as_dict(), "acceleration, torque or tool_acceleration"
        )
    rest = _pace(robot, timed, np.linspace(start, timed.duration, COARSE + 1), limits, payload)[0][-1]
    tau, pace = _pace(robot, timed, _steps(timed, start, rest), limits, payload)
    motion = PacedMotion(timed, TimeLaw.constant_acceleration("emergency stop", tau, pace))
    found = verify(robot, motion, replace(limits, jerk=None), payload)
    failures = {name: value for name, value in found.failures.items() if name != "start speed"}  # it starts in motion
    proved = proved_use(robot, motion, replace(limits, jerk=None), payload)
    failures |= {f"{name}, proved": bound for name, bound in proved.items() if not bound <= 1.0}
    if failures:
        raise LimitsExceeded(failures, 1.0)
    return EmergencyStop(motion, start, replace(found, proved=proved))


def _steps(timed: TimedMotion, start: float, rest: float) -> Array:
    """Times from the start to the end of the motion: its knots, and more between where it is about to be at rest."""
    least = 1e-3 * (rest - start) / STEPS  # a shorter step would be rounding's
    later = timed.times[timed.times > start + least]
    even = np.linspace(start, rest, STEPS + 1)[1:]
    apart = np.abs(even[:, None] - later[np.searchsorted(later, even).clip(1, later.size - 1)[:, None] + [-1, 0]])
    return np.concatenate([[start], np.union1d(even[apart.min(axis=1) > least], later)])


def _pace(robot: Mechanism, timed: TimedMotion, knots: Array, limits: Limits, payload: float) -> tuple[Array, Array]:
    """Times of the motion (k,) and the pace there, from 1 to 0."""
    pose, first, second, _ = timed.at(one_sided(knots, np.stack([knots[:-1], knots[1:]], axis=1)))
    return _brake(knots, _rows(robot, pose, first, second, limits, payload), _disc(first, second, limits))


def _rows(robot: Mechanism, pose: Array, first: Array, second: Array, limits: Limits, payload: float) -> Rows:
    """Joint acceleration and torque over their limits: |by_u u + by_x x + still| <= 1."""
    count, none = len(robot.joint_names), np.zeros_like(pose)
    joints = actuator_motion(robot, pose, first, second, none)
    rows = [(np.zeros((*pose.shape[:-1], 0)),) * 3]
    acceleration, torque = limits.of_joints("acceleration", count), limits.of_joints("torque", count)
    if acceleration is not None:
        rows.append((joints.first / acceleration, joints.second / acceleration, np.zeros_like(joints.first)))
    if torque is not None:
        along = torque_by_rate(robot, payload, pose, first, second)
        by_u = inverse_dynamics(robot, payload, pose, first, second + first) - sum(along)
        # Friction as at full speed, without the viscous part, and none as at rest: so all that lies between.
        still = inverse_dynamics(robot, payload, pose, none, none)
        constants = (along.constant + along.linear, along.constant, still)
        rows += [(by_u / torque, along.quadratic / torque, constant / torque) for constant in constants]
    by_u, by_x, still = (np.concatenate(part, axis=-1) for part in zip(*rows, strict=True))
    return by_u, by_x, still


def _disc(first: Array, second: Array, limits: Limits) -> tuple[Array, Array] | None:
    """The tool's acceleration over its cap, (n, 2, 3) by u and by x; None where there is no cap."""
    cap = limits.tool_acceleration
    return None if cap is None else (first[..., :3] / cap, second[..., :3] / cap)


def _brake(knots: Array, rows: Rows, disc: tuple[Array, Array] | None) -> tuple[Array, Array]:
    """Knots and pace (k,) of the braking, as far as it goes."""
    steps = np.diff(knots)
    x, tau, pace = 1.0, [knots[0]], [1.0]
    for k, step in enumerate(steps):
        # at the end of the step x is x + 2 step u
        ahead = np.array([0.0, 2.0 * step])[:, None]
        by_u, by_x, still = (part[k] for part in rows)
        least = _least(by_u + ahead * by_x, by_x * x + still)
        if disc is not None:
            least = max(least, _least_in_disc(disc[0][k] + ahead * disc[1][k], disc[1][k] * x))
        u = min(least, 0.0)
        if x + 2.0 * step * u <= 0.0:
            return np.array([*tau, tau[-1] - x / (2.0 * u)]), np.array([*pace, 0.0])
        x += 2.0 * step * u
        tau.append(knots[k + 1])
        pace.append(math.sqrt(x))
    return np.array(tau), np.array(pace)


def _least(by_u: Array, rest: Array) -> float:
    """The least u with |by_u u + rest| <= `_WITHIN` in every row."""
    with np.errstate(divide="ignore", invalid="ignore"):
        least = (-_WITHIN * np.sign(by_u) - rest) / by_u
    return float(np.where(by_u == 0.0, -np.inf, least).max(initial=-np.inf))


def _least_in_disc(by_u: Array, rest: Array) -> float:
    """The least u with |by_u u + rest| <= `_WITHIN` at both ends, (2, 3) each."""
    a, b, c = (by_u**2).sum(-1), (by_u * rest).sum(-1), (rest**2).sum(-1) - _WITHIN**2
    with np.errstate(divide="ignore", invalid="ignore"):
        least = (-b - np.sqrt(np.maximum(b**2 - a * c, 0.0))) / a
    return float(np.where(a == 0.0, -np.inf, least).max())
