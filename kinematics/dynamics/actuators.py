"""From joints to actuators and back: a constant linear map of each mechanism. Limits are those of the actuators."""

from __future__ import annotations

import casadi as ca

from kinematics.arrays import Array, checked
from kinematics.evaluation import evaluate
from kinematics.mathematics import adjugate
from kinematics.model import Build, Mechanism, Model


def to_actuators(robot: Mechanism, joints: Array) -> Array:
    """(..., m) joints -> (..., m) actuators C joints, in the order of `robot.actuator_names`."""
    return evaluate(robot.program(_actuators), checked(joints, "joints", robot.joint_names))[0]


def from_actuators(robot: Mechanism, actuators: Array) -> Array:
    """(..., m) actuators -> (..., m) joints C^-1 actuators."""
    return evaluate(robot.program(_joints), checked(actuators, "actuators", robot.actuator_names))[0]


def _actuators(_: Mechanism, model: Model) -> Build:
    return [model.joints], [model.drives @ model.joints]


def _joints(_: Mechanism, model: Model) -> Build:
    given = ca.SX.sym("actuators", model.drives.shape[0])
    inverse, det = adjugate(model.drives)
    return [given], [inverse @ given / det]
