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
from trajectory.limits import Along, Cap, Disc, Limits, Linear, TorqueAlong
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
    """The rows that are linear, and facets of discs.

    Args:
        robot: any mechanism with the path's kind of pose, that reaches each pose.
        path: any path.
        limits: of joints and tool; those are used that are a `Cap`, `Linear` or a `Disc`.
        payload: mass at the tool [kg].
        s: (k,) increasing arc lengths [m].
    """
    along = _along(robot, path, payload, s)
    none = np.zeros_like(along.joints.first)[:, :0]
    linear = [(row.by_u, row.by_x, row.constant, row.friction) for row in limits.constraints(Linear, along)]
    rows = [(none,) * 4, *linear, *(_facets(disc) for disc in limits.constraints(Disc, along))]
    highest = np.min([cap.most for cap in limits.constraints(Cap, along)], axis=0)
    return PathRows(s, highest, *(np.concatenate(part, axis=-1) for part in zip(*rows, strict=True)))


def _along(robot: Mechanism, path: Path, payload: float, s: Array) -> Along:
    pose, first, second = path.evaluate(s, 2)
    none, tool = np.zeros_like(pose), places(robot.pose_names)
    joints = actuator_motion(robot, pose, first, second, none)

    def split() -> TorqueAlong:
        weight = inverse_dynamics(robot, payload, pose, none, none)
        by_u = inverse_dynamics(robot, payload, pose, none, first) - weight
        ways = [inverse_dynamics(robot, payload, pose, way * first, second) for way in (1.0, -1.0)]
        by_x = (ways[0] + ways[1]) / 2 - weight  # friction changes its sign with the way
        friction = robot.inertia.drive_train.friction(joints.first)[0]
        return TorqueAlong(by_u, by_x, np.zeros_like(weight), weight, friction, weight + friction)

    return Along(joints, (first[:, :tool], second[:, :tool]), split)


def _facets(disc: Disc) -> tuple[Array, Array, Array, Array]:
    """Rows of a polygon inside the disc of the tool's acceleration; the normal part is never negative."""
    first, second = disc.by_u, disc.by_x
    length = np.linalg.norm(first, axis=-1, keepdims=True)
    along = np.divide((second * first).sum(axis=-1, keepdims=True), length, where=length > 0.0, out=0.0 * length)
    tangent = np.divide(first, length, where=length > 0.0, out=np.zeros_like(first))
    normal = np.linalg.norm(second - along * tangent, axis=-1, keepdims=True)
    angles = (np.arange(_FACETS) + 0.5) * math.pi / _FACETS  # a vertex on the tangent: straight ahead all is used
    inside = math.cos(math.pi / (2 * _FACETS))
    by_u = length * np.cos(angles) / inside
    by_x = (along * np.cos(angles) + normal * np.sin(angles)) / inside
    return by_u, by_x, np.zeros_like(by_u), np.zeros_like(by_u)
