"""A path's time law gives the motion of the pose, and that the motion of the joints and the drives."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Mechanism
from kinematics.dynamics import inverse_dynamics
from kinematics.motion import JointMotion, actuator_motion
from trajectory.path import Array, Path
from trajectory.timing import PathMotion


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


def largest_rates(along: PathMotion, half: Array) -> tuple[Array, Array, Array]:
    """Bounds of the first three derivatives' moduli (k,) within `half` of the times of `along`; the third is fixed."""
    jerk = np.abs(along.jerk)
    acceleration = np.abs(along.acceleration) + half * jerk
    return np.abs(along.speed) + half * acceleration, acceleration, jerk


def steepest_travelled(
    second: Array, third: Array, fourth: Array, away: Array, rates: tuple[Array, Array, Array]
) -> Array:
    """Bounds of the modulus of p(s(t))'s fourth derivative (k, n), by the chain rule, each term bounded.

    Args:
        second, third: (k, n) derivatives of p by s.
        fourth: (k, n) bounds of the fourth one's modulus wherever s goes.
        away: (k,) how far s goes from where `second` and `third` are.
        rates: bounds of the first three derivatives of s, (k,) each.
    """
    third = np.abs(third) + away[:, None] * fourth
    second = np.abs(second) + away[:, None] * third
    v, a, j = (rate[:, None] for rate in rates)
    return fourth * v**4 + 6 * third * v**2 * a + second * (4 * v * j + 3 * a**2)


def motion_of(robot: Mechanism, tool: PoseMotion, payload: float) -> Motion:
    """Joints and torque that belong to a motion of the pose; NaN where a limb cannot reach.

    Args:
        robot: any mechanism with this kind of pose.
        tool: (..., n) the pose and its time derivatives.
        payload: mass at the tool [kg].
    """
    torque = inverse_dynamics(robot, payload, tool.pose, tool.velocity, tool.acceleration)
    return Motion(tool, actuator_motion(robot, *tool), torque)
