"""A path's time law gives the motion of the pose, and that the motion of the joints and the drives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kinematics import Array, JointMotion, Mechanism, actuator_motion, inverse_dynamics
from trajectory.motions.time_law import PathMotion
from trajectory.paths import Path


class PoseMotion(NamedTuple):
    """The pose and its time derivatives, each (..., n)."""

    pose: Array
    velocity: Array
    acceleration: Array
    jerk: Array


class Motion(NamedTuple):
    """All that moves: pose; joints as their actuators count them, with time derivatives; torque there (..., m)."""

    tool: PoseMotion
    joints: JointMotion
    torque: Array


def pose_motion(path: Path, along: PathMotion) -> PoseMotion:
    """The pose in time, by the chain rule on p(s(t)).

    Args:
        path: of the pose.
        along: (...,) arc length and its time derivatives.
    """
    return travelled(path.evaluate(along.position, 3), along)


def travelled(derivatives: tuple[Array, ...], along: PathMotion) -> PoseMotion:
    """The pose in time, by the chain rule.

    Args:
        derivatives: pose (..., n) and its first three derivatives by the parameter along the way.
        along: (...,) that parameter and its time derivatives.
    """
    pose, first, second, third = derivatives
    v, a, j = (x[..., None] for x in (along.speed, along.acceleration, along.jerk))
    return PoseMotion(pose, first * v, second * v**2 + first * a, third * v**3 + 3 * second * v * a + first * j)


def largest_speed(along: PathMotion, half: Array) -> Array:
    """(k,) within `half` of the times of `along`, if its snap is the same there."""
    steepest = np.abs(along.snap)
    for rate in (along.jerk, along.acceleration, along.speed):
        steepest = np.abs(rate) + half * steepest
    result: Array = steepest
    return result


def travelled_snap(derivatives: Sequence[Array], fourth: Array, along: PathMotion, half: Array) -> Array:
    """(2, k, n) bounds of p(s(t))'s fourth derivative within `half` of the times of `along`, by the chain rule.

    Args:
        derivatives: of p by s, the first four, (k, n) each, at the times of `along`.
        fourth: (k, n) how far the last of them may be from that, wherever s goes.
        along: (k,) s and its time derivatives; its snap is the same within `half`.
        half: (k,) [s].
    """
    away = (half * largest_speed(along, half))[:, None]
    p1, p2, p3, p4 = _around(derivatives, fourth, away)
    v, a, j, snap = _around([rate[:, None] for rate in along[1:]], np.zeros((half.size, 1)), half[:, None])
    square = _times(v, v)
    terms = [
        _times(p4, _times(square, square)),
        _times(p3, _times(_times(square, a), (6.0, 0.0))),
        _times(p2, _times(_times(v, j), (4.0, 0.0))),
        _times(p2, _times(_times(a, a), (3.0, 0.0))),
        _times(p1, snap),
    ]
    value, radius = (sum(parts) for parts in zip(*terms, strict=True))
    return np.stack([value - radius, value + radius])


_Ball = tuple[Array | float, Array | float]  # a value, and how far from it the quantity may be


def _around(values: Sequence[Array], last: Array, away: Array) -> list[_Ball]:
    """Each quantity about its value, where the next one is its derivative, by no more than `away` times that."""
    balls: list[_Ball] = []
    radius = last
    for value in reversed(values):
        balls.insert(0, (value, radius))
        radius = away * (np.abs(value) + radius)
    return balls


def _times(x: _Ball, y: _Ball) -> _Ball:
    return x[0] * y[0], np.abs(x[0]) * y[1] + x[1] * (np.abs(y[0]) + y[1])


def motion_of(robot: Mechanism, tool: PoseMotion, payload: float) -> Motion:
    """Joints and torque that belong to a motion of the pose; NaN where a limb cannot reach.

    Args:
        robot: any mechanism with this kind of pose.
        tool: (..., n) the pose and its time derivatives.
        payload: mass at the tool [kg].
    """
    torque = inverse_dynamics(robot, payload, tool.pose, tool.velocity, tool.acceleration)
    return Motion(tool, actuator_motion(robot, *tool), torque)
