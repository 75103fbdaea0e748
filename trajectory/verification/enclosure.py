"""Bounds of the joints' motion and the torque between samples.

Over a time of length 2 r, a quantity f is within r max |f'| of its value in the middle. Interval arithmetic, rounded
outward, bounds f' from bounds of the pose's motion. These follow from bounds of the pose's fourth derivative, one order
after the other. So the bounds hold at every instant between the samples.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics import Array, BoxProgram, JointMotion, Mechanism, Program, derivatives_along, enclose, torques
from trajectory.motions import Motion, PoseMotion, TimedMotion, motion_of

_ALL = (-np.inf, np.inf)
_REST = 1e-9  # of the largest speed
_LOOKED_AT = 101  # instants, for the largest speed of a motion
_ROUNDED = 1e-6  # of a speed's slack: far more than what rounding the times of short parts is worth
_SLACK = (
    1e-12  # relative, to a value and to the largest one: far more than what evaluation in double arithmetic is off by
)


class Slack(NamedTuple):
    """How far a motion may be over parts of it from what it is in their middles.

    Attributes:
        motion: bounds of |f(t) - f(middle)|, (k, ...), in the layout of the motion itself; of |f(t)| - |f(middle)| for
            the torque where friction changes its sign.
        mean_torque: (k, m) by how much the mean of |torque| may exceed that in the middle: of the second order in the
            parts' lengths, but where friction changes its sign.
    """

    motion: Motion
    mean_torque: Array


@np.errstate(over="ignore")  # a bound beyond all numbers proves nothing, and the part is cut
def slack(robot: Mechanism, timed: TimedMotion, payload: float, low: Array, high: Array) -> Slack:
    """How far the motion may be over each part from what it is in its middle.

    Args:
        robot: any mechanism with this kind of pose.
        timed: the motion.
        payload: mass at the tool [kg].
        low, high: (k,) times between which a part lies, each inside one interval of the motion [s].
    """
    half = ((high - low) * (0.5 + _SLACK))[:, None]
    tool, snap, away = timed.at(0.5 * low + 0.5 * high), timed.enclose_snap(low, high), list[Array]()
    steepest = np.abs(snap).max(axis=0)
    for value in tool[::-1]:
        away.insert(0, half * steepest + _SLACK * (np.abs(value).max() + np.abs(value)))
        steepest = np.abs(value) + away[0]
    bounds = [np.stack([value - d, value + d]) for value, d in zip(tool, away, strict=True)]
    boxes = np.concatenate([*bounds, snap, np.full((2, low.size, 1), payload)], axis=-1)
    least, most = (np.nan_to_num(v, nan=n) for v, n in zip(enclose(_slopes(robot), *boxes), _ALL, strict=True))
    found = half * np.maximum(np.abs(least), np.abs(most))
    count = len(robot.joint_names)
    *joints, torque = (found[:, k * count : (k + 1) * count] for k in range(5))
    speeds = np.abs(timed.at(np.linspace(0.0, timed.duration, _LOOKED_AT)).velocity).max(axis=-1)
    starts, ends = speeds[[0, -1]] <= _REST * speeds.max()
    at_rest = (starts & (low <= 0.0)) | (ends & (high >= timed.duration))
    friction, unknown = _friction_slack(robot, tool, payload, joints, at_rest)
    # Up to the middle the torque is at most the line of least slope through it, beyond it that of the largest.
    uneven = half * (most - least)[:, -count:] / 4.0 + np.where(unknown, torque + friction, friction)
    return Slack(Motion(PoseMotion(*away), JointMotion(*joints), torque + friction), uneven)


def _friction_slack(
    robot: Mechanism, tool: PoseMotion, payload: float, joints: list[Array], at_rest: Array
) -> tuple[Array, Array]:
    """By how much friction may add to the size of the torque in the middle, and where its sign is not known, (k, m)."""
    drives, count = robot.inertia.drive_train, joints[0].shape[1]
    coulomb, viscous = (drives.of_actuators(name, count) for name in ("coulomb", "viscous"))
    if not (coulomb.any() or viscous.any()):
        return np.zeros_like(joints[0]), np.zeros(joints[0].shape, dtype=bool)
    motion = motion_of(robot, tool, payload)
    speed, acceleration = motion.joints.first, motion.joints.second
    own = drives.friction(speed)[0]
    without, size = motion.torque - own, np.abs(motion.torque)
    unknown = (
        np.abs(speed) <= joints[1] * (1.0 + _ROUNDED) + _REST * np.abs(speed).max()
    )  # where it is at rest it bears none
    # From rest and to rest the speed keeps its sign where the acceleration does.
    starting = at_rest[:, None] & (np.abs(acceleration) > joints[2])
    most = np.where(starting, np.maximum(np.abs(without), size), np.abs(without) + coulomb)
    return viscous * joints[1] + np.where(unknown, most - size, 0.0), unknown


@lru_cache(maxsize=16)
def _slopes(robot: Mechanism) -> BoxProgram:
    """Pose, its rates up to the fourth and payload -> the actuators' first four derivatives, the torque's first."""
    model, payload = robot.model(), ca.SX.sym("payload")
    rates = velocity, acceleration, jerk, _ = [
        ca.SX.sym(name, model.pose.shape[0]) for name in ("velocity", "acceleration", "jerk", "rate")
    ]
    joints = derivatives_along(model.drives @ model.inverse, model.pose, rates)[1:]
    tau = torques(robot, payload, velocity, acceleration)
    state, following = ca.vertcat(model.pose, velocity, acceleration), ca.vertcat(velocity, acceleration, jerk)
    slopes = ca.vertcat(*joints, ca.jtimes(tau, state, following))
    function = ca.Function("slopes", [model.pose, *rates, payload, model.geometry], [ca.cse(ca.densify(slopes))])
    return BoxProgram.of(Program.of(function), robot.geometry.vector().tolist())
