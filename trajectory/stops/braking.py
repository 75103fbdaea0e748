"""The pace of the shortest stop on a motion's own way, where no limit of jerk is kept.

The motion p(tau) is travelled at a pace tau(t) that falls from 1 to 0. With x = tau'^2 and u = tau'' every limit on
acceleration and torque is linear in (u, x), as in Bobrow, Dubowsky and Gibson, "Time-optimal control of robotic
manipulators along specified paths", IJRR 1985:

    joint acceleration   q' u + q'' x
    torque               i u + k x + c,  its parts by the rate, Coulomb friction in c (`torque_terms`)
    tool acceleration    |p' u + p'' x|, a disc

with a dash for the derivative by tau. The pace always takes the least u that the limits allow. No other pace has a
lower x anywhere, since it would have to cross this one with less than the least u. So this is the shortest way to
rest. The points (0, 0) and (0, 1), which are rest and the motion itself, are within the limits. By convexity so is
every (0, x) between them. So u is never above 0, speeds never rise, and the end of the motion is never passed. The
acceleration steps where braking starts and where it ends.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics import Array, Mechanism, actuator_motion, inverse_dynamics
from trajectory.limits import Along, Disc, Limits, Linear, TorqueAlong
from trajectory.motions import SAME, PoseMotion, TimedMotion, TimeLaw, torque_by_rate
from trajectory.paths import interval_of, places

COARSE = 200  # steps to see about how long the braking is
STEPS = 1000  # of the braking, at least
_WITHIN = 1.0 - 1e-4  # of the limits, for braking to keep them between the steps too
Rows = tuple[Array, Array, Array]  # by_u, by_x, still; each (n, 2, rows), over the limit, at both ends of a step


def braking(robot: Mechanism, timed: TimedMotion, start: float, limits: Limits, payload: float) -> TimeLaw:
    """The time of the motion as a law of the time since `start`; arguments as for `emergency_stop`."""
    rest = _pace(robot, timed, np.linspace(start, timed.duration, COARSE + 1), limits, payload)[0][-1]
    even = np.linspace(start, rest, STEPS + 1)
    tau, pace = _pace(robot, timed, with_knots(timed, even, 1e-3 * (rest - start) / STEPS), limits, payload)
    return TimeLaw.constant_acceleration("emergency stop", tau, pace)


def with_knots(timed: TimedMotion, even: Array, least: float | Array) -> Array:
    """From the first of (k,) increasing times to the motion's end: all its knots, and the times not too close to them.

    Args:
        timed, even: the motion and the times [s].
        least: how far from each knot they are at least; one number or (k,) [s].
    """
    least = np.broadcast_to(least, even.shape)
    inside = timed.times[1:-1]
    later = np.append(inside[inside > even[0] + SAME * timed.duration], timed.duration)
    apart = np.abs(even[:, None] - later[np.searchsorted(later, even).clip(1, later.size - 1)[:, None] + [-1, 0]])
    return np.concatenate([even[:1], np.union1d(even[1:][apart.min(axis=1)[1:] > least[1:]], later)])


def steps_of(timed: TimedMotion, knots: Array, fractions: Array) -> PoseMotion:
    """The motion at fractions (j,) from 0 to 1 of the k steps between its times `knots`; each step's own limit at 1."""
    tau = (1.0 - fractions) * knots[:-1, None] + fractions * knots[1:, None]
    interval = interval_of(timed.times, tau)
    interval[:, -1] = interval_of(timed.times, tau[:, -1], "left")
    return timed.inside(interval, tau - timed.times[interval])


def along_itself(robot: Mechanism, tool: PoseMotion, payload: float) -> Along:
    """A motion as a way whose parameter is its own time (..., n); what friction a pace loses at rest is kept apart."""
    pose, first, second, _ = tool
    point, none = places(robot.pose_names), np.zeros_like(pose)

    def split() -> TorqueAlong:
        parts = torque_by_rate(robot, payload, pose, first, second)
        by_u = inverse_dynamics(robot, payload, pose, first, second + first) - sum(parts)
        still = inverse_dynamics(robot, payload, pose, none, none)
        return TorqueAlong(by_u, parts.quadratic, parts.linear, parts.constant, still - parts.constant, parts.constant)

    joints = actuator_motion(robot, *tool)
    return Along(joints, (first[..., :point], second[..., :point]), split)


def _pace(robot: Mechanism, timed: TimedMotion, knots: Array, limits: Limits, payload: float) -> tuple[Array, Array]:
    """Times of the motion (k,) and the pace there, from 1 to 0."""
    along = along_itself(robot, steps_of(timed, knots, np.array([0.0, 1.0])), payload)
    return _brake(knots, _rows(limits, along), limits.constraints(Disc, along))


def _rows(limits: Limits, along: Along) -> Rows:
    """What is linear, over its limit: |by_u u + by_x x + still| <= 1."""
    none = along.joints.first[..., :0]
    rows = [(none, none, none)]
    for row in limits.constraints(Linear, along):
        # With what grows with the rate as at full speed, without it, and without friction: so all that lies between.
        constants = [row.constant, row.constant + row.by_rate, row.constant + row.friction]
        different = [constants[0], *(c for c in constants[1:] if (c != constants[0]).any())]
        rows += [(row.by_u, row.by_x, constant) for constant in different]
    by_u, by_x, still = (np.concatenate(part, axis=-1) for part in zip(*rows, strict=True))
    return by_u, by_x, still


def _brake(knots: Array, rows: Rows, discs: list[Disc]) -> tuple[Array, Array]:
    """Knots and pace (k,) of the braking, as far as it goes."""
    steps = np.diff(knots)
    x, tau, pace = 1.0, [knots[0]], [1.0]
    for k, step in enumerate(steps):
        # at the end of the step x is x + 2 step u
        ahead = np.array([0.0, 2.0 * step])[:, None]
        by_u, by_x, still = (part[k] for part in rows)
        least = _least(by_u + ahead * by_x, by_x * x + still)
        for disc in discs:
            least = max(least, _least_in_disc(disc.by_u[k] + ahead * disc.by_x[k], disc.by_x[k] * x))
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
    """The least u with |by_u u + rest| <= `_WITHIN` at both ends, (2, .) each."""
    a, b, c = (by_u**2).sum(-1), (by_u * rest).sum(-1), (rest**2).sum(-1) - _WITHIN**2
    with np.errstate(divide="ignore", invalid="ignore"):
        least = (-b - np.sqrt(np.maximum(b**2 - a * c, 0.0))) / a
    return float(np.where(a == 0.0, -np.inf, least).max())
