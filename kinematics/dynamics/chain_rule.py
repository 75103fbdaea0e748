"""Joint motion along a motion of the pose: exact chain-rule derivatives of the inverse model."""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked
from kinematics.evaluation import evaluate
from kinematics.model import Build, Mechanism, Model, Write


class JointMotion(NamedTuple):
    """Joints (or actuators) and their first three derivatives, each (..., m)."""

    position: Array
    first: Array
    second: Array
    third: Array


def joint_motion(robot: Mechanism, pose: Array, first: Array, second: Array, third: Array) -> JointMotion:
    """Derivatives of the joints by the same parameter as the pose's derivatives (time or arc length).

    Args:
        pose, first, second, third: (..., n) the pose and its first three derivatives by that parameter.

    Returns:
        Joints and derivatives; NaN rows where a limb cannot reach.
    """
    return _motion(robot, _of_joints, (pose, first, second, third))


def actuator_motion(robot: Mechanism, pose: Array, first: Array, second: Array, third: Array) -> JointMotion:
    """As `joint_motion`, for the actuators, which have the limits. It is the same unless drives couple joints."""
    return _motion(robot, _of_actuators, (pose, first, second, third))


def _of_joints(_: Mechanism, model: Model) -> Build:
    return _derivatives(model, model.inverse)


def _of_actuators(_: Mechanism, model: Model) -> Build:
    return _derivatives(model, model.drives @ model.inverse)


def _derivatives(model: Model, expression: ca.SX) -> Build:
    rates = [ca.SX.sym(name, model.pose.shape[0]) for name in ("first", "second", "third")]
    return [model.pose, *rates], derivatives_along(expression, model.pose, rates)


def _motion(robot: Mechanism, write: Write, motion: tuple[Array, Array, Array, Array]) -> JointMotion:
    named = zip(("pose", "first derivative", "second derivative", "third derivative"), motion, strict=True)
    given = [checked(v, name, robot.pose_names) for name, v in named]
    found = JointMotion(*evaluate(robot.program(write), *np.broadcast_arrays(*given)))
    unreachable = np.isnan(found.position).any(axis=-1)
    for part in found:
        part[unreachable] = np.nan
    return found


def derivatives_along(expression: ca.SX, variable: ca.SX, rates: list[ca.SX]) -> list[ca.SX]:
    """The expression and its derivatives along a curve, one for each given derivative of the variable."""
    result = [expression]
    state, following = [variable], []
    for rate in rates:
        following.append(rate)
        result.append(ca.jtimes(result[-1], ca.vertcat(*state), ca.vertcat(*following)))
        state.append(rate)
    return result
