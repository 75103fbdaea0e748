"""Inverse dynamics by d'Alembert's principle on the mechanism's own points.

The rigid-body model of a mechanism is a list of particles and rotors, each moved either by the joints or by the pose;
a rod's mass is split between its two ends, so that every mass belongs to one side. With Q_q and Q_x the inertia and
weight forces on both sides, virtual work gives J_m^T (tau - Q_q) = Q_x. With more joints than freedoms many tau do:
each drive moves its own side, and what the platform needs is shared with the least norm,
tau = Q_q + J_m (J_m^T J_m)^-1 Q_x. Actuators = C joints then bear C^-T tau.
"""

from __future__ import annotations

import math

import casadi as ca
import numpy as np

from kinematics.bodies import BodySet
from kinematics.errors import InvalidValue
from kinematics.interpreter import evaluate
from kinematics.linear import adjugate
from kinematics.mechanism import Array, Build, Mechanism, checked
from kinematics.model import Model
from kinematics.motion import derivatives_along

GRAVITY = 9.80665  # m/s^2, along -e_z


def inverse_dynamics(robot: Mechanism, payload: float, pose: Array, velocity: Array, acceleration: Array) -> Array:
    """Actuator torques (or forces) that make the platform follow a motion.

    Args:
        robot: its `bodies(...)` states the masses.
        payload: mass at the tool [kg].
        pose, velocity, acceleration: (..., n) the pose and its time derivatives.

    Returns:
        (..., m) torques [N m] or forces [N] at the actuators; NaN out of reach.
    """

    if not (math.isfinite(payload) and payload >= 0.0):
        raise InvalidValue("payload", payload, "a finite mass >= 0 kg")

    def build(model: Model) -> Build:
        rates = [ca.SX.sym(name, model.pose.shape[0]) for name in ("velocity", "acceleration")]
        return [model.pose, *rates], [torques(robot, payload, *rates)]

    named = {"pose": pose, "velocity": velocity, "acceleration": acceleration}
    given = [checked(v, name, robot.pose_names) for name, v in named.items()]
    program = robot.program(("inverse_dynamics", payload, robot.inertia), build)
    return evaluate(program, *np.broadcast_arrays(*given))[0]


def torques(robot: Mechanism, payload: float, velocity: ca.SX, acceleration: ca.SX) -> ca.SX:
    """(m,) what `inverse_dynamics` evaluates, in the model's symbols `pose` and `geometry`."""
    model = robot.model()
    return _at_actuators(model, _torques(robot, model, payload, [velocity, acceleration]))


def _at_actuators(model: Model, torques: ca.SX) -> ca.SX:
    """C^-T tau: actuators and joints do the same work."""
    transposed, det = adjugate(model.drives.T)
    return transposed @ torques / det


def _torques(robot: Mechanism, model: Model, payload: float, rates: list[ca.SX]) -> ca.SX:
    bodies = robot.bodies(model.pose, model.joints, model.g, payload)
    joint_rates = [ca.SX.sym(name, model.joints.shape[0]) for name in ("joint_velocity", "joint_acceleration")]
    on_joints = model.at_pose(_generalised_force(bodies.of_joints, model.joints, joint_rates))
    along = derivatives_along(model.inverse, model.pose, rates)[1:]
    on_joints = ca.substitute(on_joints, ca.vertcat(*joint_rates), ca.vertcat(*along))
    on_pose = robot.pose_rate_map(model.pose).T @ _generalised_force(bodies.of_pose, model.pose, rates)
    if model.joints.shape[0] > model.pose.shape[0]:
        j_m = model.inverse_jacobian
        cofactors, det = adjugate(j_m.T @ j_m)
        return on_joints + j_m @ (cofactors @ on_pose) / det
    # J_q^-T sits outside the solve, so that a limb near its reach does not spoil the others.
    transposed, det = adjugate(model.j_x_at_pose.T)
    return on_joints + model.j_q_at_pose * (transposed @ on_pose) / det


def _generalised_force(bodies: BodySet, variable: ca.SX, rates: list[ca.SX]) -> ca.SX:
    """Sum of J^T m (a - g) over the particles and of the rotors' inertia torques, on the variable."""
    force = ca.SX(variable.shape[0], 1)
    for mass, point in bodies.particles:
        acceleration = derivatives_along(point, variable, rates)[2] + ca.vertcat(0, 0, GRAVITY)
        force += ca.jacobian(point, variable).T @ (mass * acceleration)
    for inertia, angle in bodies.rotors:
        acceleration = derivatives_along(angle, variable, rates)[2]
        force += ca.jacobian(angle, variable).T * (inertia * acceleration)
    return force
