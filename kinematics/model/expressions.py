"""What the programs of every mechanism compute: each function writes a robot's expressions, in its model's symbols."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import casadi as ca

from kinematics.model import indices
from kinematics.model.abstract_margin import Measure
from kinematics.model.programs import Build
from kinematics.model.symbolic_model import Model

if TYPE_CHECKING:
    from kinematics.model.mechanism import Mechanism


def within_reach(robot: Mechanism, model: Model, write: Callable[..., list[ca.SX]], *given: Any) -> Build:
    """The outputs of `write`, and one more that is NaN where a limb cannot reach."""
    return [model.pose], [*write(robot, model, *given), ca.sum1(robot.limb_roots(model.pose, model.g))]


def reach(robot: Mechanism, model: Model) -> Build:
    return [model.pose], [robot.reach(model.pose, model.g)]


def closure(_: Mechanism, model: Model) -> Build:
    return [model.pose, model.joints], [model.closure]


def closure_gap(robot: Mechanism, model: Model) -> Build:
    rows = model.j_x @ ca.diag(ca.DM(robot.pose_units()))
    return [model.pose, model.joints], [model.closure / ca.sqrt(ca.sum2(rows * rows))]


def jacobians_of_joints(_: Mechanism, model: Model) -> Build:
    return [model.pose, model.joints], [model.j_q, model.j_x]


def pose_rates(robot: Mechanism, model: Model) -> Build:
    return [model.pose], [ca.densify(robot.pose_rate_map(model.pose))]


def inverse(_: Mechanism, model: Model) -> list[ca.SX]:
    return [model.inverse]


def jacobians(_: Mechanism, model: Model) -> list[ca.SX]:
    return [model.j_q_at_pose, model.j_x_at_pose]


def inverse_jacobian(_: Mechanism, model: Model) -> list[ca.SX]:
    return [model.inverse_jacobian]


def actuator_jacobian(_: Mechanism, model: Model) -> list[ca.SX]:
    return [model.actuator_jacobian]


def isotropic(robot: Mechanism, _: Model, length: float) -> list[ca.SX]:
    return list(indices.isotropic(robot.homogeneous_jacobian(length)))


def homogeneous(robot: Mechanism, _: Model, length: float) -> list[ca.SX]:
    return [robot.homogeneous_jacobian(length)]


def margin(robot: Mechanism, _: Model, name: str, measure: Measure) -> list[ca.SX]:
    return [robot.margins[name].worst(robot, measure)]


def margin_components(robot: Mechanism, model: Model, name: str, measure: Measure) -> Build:
    return [model.pose], [robot.margins[name].components(robot, measure)]


def margin_everywhere(robot: Mechanism, model: Model, name: str) -> Build:
    measure = Measure(robot.fvi_bounds, robot.characteristic_length)
    return [model.pose], [robot.margins[name].worst(robot, measure)]


def skeleton(robot: Mechanism, model: Model) -> list[ca.SX]:
    return [model.at_pose(p) for p in robot.skeleton(model.pose, model.joints, model.g).values()]
