"""Joint motion along a motion of the pose: exact chain-rule derivatives of the inverse model."""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.interpreter import evaluate
from kinematics.mechanism import Array, Build, Mechanism, checked
from kinematics.model import Model


class JointMotion(NamedTuple):
    """Joints and their first three derivatives, each (..., m)."""

    position: Array
    first: Array
    second: Array
    third: Array


def joint_motion(robot: Mechanism, pose: Array, first: Array, second: Array, third: Array) -> JointMotion:
    """Derivatives of the joints by whatever parameter the pose's derivatives are by (time, arc length).

    Args:
        pose, first, second, third: (..., n) the pose and its first three derivatives by that parameter.

    Returns:
        Joints and derivatives; NaN rows where a limb cannot reach.
    """

    def build(model: Model) -> Build:
        rates = [ca.SX.sym(name, model.pose.shape[0]) for name in ("first", "second", "third")]
        return [model.pose, *rates], derivatives_along(model.inverse, model.pose, rates)

    named = {"pose": pose, "first derivative": first, "second derivative": second, "third derivative": third}
    given = [checked(v, name, robot.pose_names) for name, v in named.items()]
    motion = JointMotion(*evaluate(robot.program("joint_motion", build), *np.broadcast_arrays(*given)))
    unreachable = np.isnan(motion.position).any(axis=-1)
    for part in motion:
        part[unreachable] = np.nan
    return motion


def derivatives_along(expression: ca.SX, variable: ca.SX, rates: list[ca.SX]) -> list[ca.SX]:
    """The expression and its derivatives along a curve, one for each given derivative of the variable."""
    result = [expression]
    state, following = [variable], []
    for rate in rates:
        following.append(rate)
        result.append(ca.jtimes(result[-1], ca.vertcat(*state), ca.vertcat(*following)))
        state.append(rate)
    return result
