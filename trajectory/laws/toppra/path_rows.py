"""What the limits allow at points of a path: with u = s'' and x = s'^2, and a dash for the derivative by s,

    joint acceleration   q' u + q'' x
    torque               (tau(p, 0, p') - w) u + (tau(p, p', p'') - f - w) x + w + f,  w = tau(p, 0, 0)
    tool acceleration    p' u + p'' x, in the plane of the path's tangent and normal
    joint speed          |q'| sqrt(x),  tool speed  |p'| sqrt(x)

Each but the speeds is a u + b x + c, over its limit; f is the Coulomb friction, whose sign along the path is that of
q'. The coefficients are exact.
"""

from __future__ import annotations

import math
from typing import NamedTuple, Self

import numpy as np

from kinematics import Array, Mechanism, actuator_motion, inverse_dynamics
from trajectory.limits import Limits
from trajectory.paths import Path, places

_FACETS = 32  # of the half disc inside the tool acceleration's; the cap is kept and at most 0.12 % is given away


class PathRows(NamedTuple):
    """At points of a path in order: |a u + b x + c| <= 1 and x <= highest.

    Attributes:
        s: (k,) arc lengths [m].
        highest: (k,) of x, by the limits of speed [m^2/s^2].
        a, b, c: (k, rows) over their limits, c of the torque without friction.
        friction: (k, rows) what it adds to c.
    """

    s: Array
    highest: Array
    a: Array
    b: Array
    c: Array
    friction: Array

    def merged(self, others: PathRows) -> Self:
        """These and others, in order."""
        order = np.argsort(np.append(self.s, others.s), kind="stable")
        return type(self)(*(np.concatenate(pair)[order] for pair in zip(self, others, strict=True)))

    def chosen(self, which: Array | slice) -> Self:
        """Some of them."""
        return type(self)(*(v[which] for v in self))


def path_rows(robot: Mechanism, path: Path, limits: Limits, payload: float, s: Array) -> PathRows:
    """The rows: joint accelerations, torques, facets of the tool's acceleration, each if limited.

    Args:
        robot: any mechanism with the path's kind of pose, that reaches each pose.
        path: any path.
        limits: of joints and tool; those of speed, acceleration and torque are used.
        payload: mass at the tool [kg].
        s: (k,) increasing arc lengths [m].
    """
    pose, first, second = path.evaluate(s, 2)
    count, none = len(robot.joint_names), np.zeros_like(pose)
    joints = actuator_motion(robot, pose, first, second, none)
    tool = places(robot.pose_names)
    groups = [np.empty((3, s.size, 0))]
    if (most := limits.of_joints("acceleration", count)) is not None:
        groups.append(np.stack([joints.first, joints.second, np.zeros_like(joints.first)]) / most)
    if (most := limits.of_joints("torque", count)) is not None:
        weight = inverse_dynamics(robot, payload, pose, none, none)
        by_u = inverse_dynamics(robot, payload, pose, none, first) - weight
        ways = [inverse_dynamics(robot, payload, pose, way * first, second) for way in (1.0, -1.0)]
        by_x = sum(ways) / 2 - weight  # friction changes its sign with the way
        groups.append(np.stack([by_u, by_x, weight]) / most)
    if limits.tool_acceleration is not None:
        groups.append(_tool_rows(first[:, :tool], second[:, :tool], limits.tool_acceleration))
    with np.errstate(divide="ignore"):  # what is at rest bounds nothing
        highest = (np.abs(joints.first) / limits.of_joints("speed", count)).max(axis=-1) ** -2.0
        if limits.tool_speed is not None:
            highest = np.minimum(highest, (np.linalg.norm(first[:, :tool], axis=-1) / limits.tool_speed) ** -2.0)
    a, b, c = np.concatenate(groups, axis=-1)
    return PathRows(s, highest, a, b, c, _friction(robot, limits, joints.first))


def _friction(robot: Mechanism, limits: Limits, rates: Array) -> Array:
    """The Coulomb friction over its limit, to be added to c, where the joints move at these rates by s (k, m)."""
    friction = [np.zeros_like(rates)] if limits.acceleration is not None else []
    if limits.torque is not None:
        friction.append(robot.inertia.drive_train.friction(rates)[0] / limits.of_joints("torque", rates.shape[1]))
    if limits.tool_acceleration is not None:
        friction.append(np.zeros((len(rates), _FACETS)))
    return np.hstack([np.empty((len(rates), 0)), *friction])


def _tool_rows(first: Array, second: Array, cap: float) -> Array:
    """(3, k, facets) of a polygon inside the disc of the tool's acceleration; the normal part is never negative."""
    length = np.linalg.norm(first, axis=-1, keepdims=True)
    along = np.divide((second * first).sum(axis=-1, keepdims=True), length, where=length > 0.0, out=0.0 * length)
    tangent = np.divide(first, length, where=length > 0.0, out=np.zeros_like(first))
    normal = np.linalg.norm(second - along * tangent, axis=-1, keepdims=True)
    angles = (np.arange(_FACETS) + 0.5) * math.pi / _FACETS  # a vertex on the tangent: straight ahead all is used
    inside = cap * math.cos(math.pi / (2 * _FACETS))
    a = length * np.cos(angles) / inside
    b = (along * np.cos(angles) + normal * np.sin(angles)) / inside
    return np.stack([a, b, np.zeros_like(a)])
