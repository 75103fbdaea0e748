"""From joints to the actuators that carry the limits, and back: a constant linear map of each mechanism."""

from __future__ import annotations

import casadi as ca

from kinematics.interpreter import evaluate
from kinematics.linear import adjugate
from kinematics.mechanism import Array, Build, Mechanism
from kinematics.model import Model
from kinematics.shapes import checked


def to_actuators(robot: Mechanism, joints: Array) -> Array:
    """(..., m) joints -> (..., m) actuators C joints, in the order of `robot.actuator_names`."""
    program = robot.program("to_actuators", lambda model: ([model.joints], [model.drives @ model.joints]))
    return evaluate(program, checked(joints, "joints", robot.joint_names))[0]


def from_actuators(robot: Mechanism, actuators: Array) -> Array:
    """(..., m) actuators -> (..., m) joints C^-1 actuators."""

    def build(model: Model) -> Build:
        given = ca.SX.sym("actuators", model.drives.shape[0])
        inverse, det = adjugate(model.drives)
        return [given], [inverse @ given / det]

    return evaluate(robot.program("from_actuators", build), checked(actuators, "actuators", robot.actuator_names))[0]
