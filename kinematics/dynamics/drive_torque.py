"""Inverse dynamics by d'Alembert's principle on the mechanism's own points.

The rigid-body model of a mechanism is a list of particles, rotors and rods (`bodies`). With Q_q and Q_x the inertia and
weight forces on joints and pose, virtual work gives J_m^T (tau - Q_q) = Q_x. Actuators = C joints then bear C^-T tau,
and their own friction.

With more joints than freedoms many tau are possible. `least_norm`: each drive moves its own side, and the platform's
load is shared with the least norm, tau = Q_q + J_m (J_m^T J_m)^-1 Q_x. `least_peak`: see `torque_sharing`.
"""

from __future__ import annotations

import math
from typing import Literal, get_args

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked
from kinematics.dynamics.chain_rule import derivatives_along
from kinematics.dynamics.torque_sharing import least_peak
from kinematics.errors import InvalidValue
from kinematics.evaluation import evaluate
from kinematics.machine import REST, Bodies, Rotor
from kinematics.mathematics import adjugate
from kinematics.model import Build, Mechanism, Model

GRAVITY = 9.80665  # m/s^2, along -e_z
Sharing = Literal["least_norm", "least_peak"]


def inverse_dynamics(
    robot: Mechanism,
    payload: float,
    pose: Array,
    velocity: Array,
    acceleration: Array,
    sharing: Sharing = "least_norm",
    torque_limits: Array | None = None,
) -> Array:
    """Actuator torques (or forces) that make the platform follow a motion, including friction.

    Args:
        robot: the robot; `bodies(...)` gives the masses, and the `drive_train` of its inertia gives gear and friction.
        payload: mass at the tool [kg].
        pose, velocity, acceleration: (..., n) the pose and its time derivatives.
        sharing: how the actuators share the work if there are more of them than freedoms.
        torque_limits: (m,) limits that `least_peak` compares the torques with; by default all are equal.

    Returns:
        (..., m) torques [N m] or forces [N] at the actuators, at the output of the gears; NaN out of reach.

    Raises:
        InvalidValue: the payload, the sharing or the limits are impossible.
    """
    given = [checked(v, name, robot.pose_names) for name, v in _named(pose, velocity, acceleration)]
    if sharing not in get_args(Sharing):
        raise InvalidValue("sharing", sharing, f"one of {', '.join(get_args(Sharing))}")
    require_payload(payload)
    given = list(np.broadcast_arrays(*given))
    mass = np.full((*given[0].shape[:-1], 1), payload)
    torque = evaluate(robot.program(_inverse_dynamics), *given, mass)[0]
    if sharing == "least_norm" or len(robot.joint_names) == len(robot.pose_names):
        return torque
    limits = np.ones(torque.shape[-1]) if torque_limits is None else np.asarray(torque_limits, dtype=float)
    return least_peak(robot.actuator_jacobian(given[0]), torque, limits)


def _named(pose: Array, velocity: Array, acceleration: Array) -> list[tuple[str, Array]]:
    return [("pose", pose), ("velocity", velocity), ("acceleration", acceleration)]


def _inverse_dynamics(robot: Mechanism, model: Model) -> Build:
    velocity, acceleration = (ca.SX.sym(name, model.pose.shape[0]) for name in ("velocity", "acceleration"))
    payload = ca.SX.sym("payload")
    _, speed = derivatives_along(model.drives @ model.inverse, model.pose, [velocity])
    torque = torques(robot, payload, velocity, acceleration) + friction(robot, speed)
    return [model.pose, velocity, acceleration, payload], [torque]


def torques(robot: Mechanism, payload: float | ca.SX, velocity: ca.SX, acceleration: ca.SX) -> ca.SX:
    """(m,) of `inverse_dynamics` with the least norm and without friction, in the model's `pose` and `geometry`."""
    model, rates = robot.model(), [velocity, acceleration]
    transposed, det = adjugate(model.drives.T)  # actuators and joints do the same work
    joint_motion = derivatives_along(model.inverse, model.pose, rates)[1:]
    return transposed @ _torques(robot, model, payload, rates, joint_motion) / det


def friction(robot: Mechanism, speed: ca.SX) -> ca.SX:
    """(m,) of the actuators at their speeds (m,), as `DriveTrain.friction`."""
    coulomb, viscous = (
        ca.DM(robot.inertia.drive_train.of_actuators(name, speed.shape[0])) for name in ("coulomb", "viscous")
    )
    return coulomb * ca.sign(speed) * (ca.fabs(speed) > REST) + viscous * speed


def require_payload(payload: float) -> None:
    """Raise InvalidValue if a payload is not a mass."""
    if not (math.isfinite(payload) and payload >= 0.0):
        raise InvalidValue("payload", payload, "a finite mass >= 0 kg")


def moving_bodies(robot: Mechanism, model: Model, payload: float | ca.SX) -> Bodies:
    """The mechanism's bodies with the motors behind their gears; the payload is a mass [kg] or its symbol."""
    bodies = robot.bodies(model.pose, model.joints, model.g, payload)
    count = len(robot.joint_names)
    ratio, motor = (robot.inertia.drive_train.of_actuators(f, count) for f in ("gear_ratio", "motor_inertia"))
    actuators = model.drives @ model.joints
    bodies.rotors.extend(Rotor(ratio[k] ** 2 * motor[k], actuators[k]) for k in range(count) if motor[k])
    return bodies


def _torques(
    robot: Mechanism, model: Model, payload: float | ca.SX, rates: list[ca.SX], joint_motion: list[ca.SX]
) -> ca.SX:
    """(m,) of the joints, without friction."""
    m = model.joints.shape[0]
    joint_rates = [ca.SX.sym(name, m) for name in ("joint_velocity", "joint_acceleration")]
    both = [ca.vertcat(q, x) for q, x in zip(joint_rates, rates, strict=True)]
    force = _generalised_force(moving_bodies(robot, model, payload), ca.vertcat(model.joints, model.pose), both)
    force = ca.substitute(model.at_pose(force), ca.vertcat(*joint_rates), ca.vertcat(*joint_motion))
    on_joints, on_pose = force[:m], robot.pose_rate_map(model.pose).T @ force[m:]
    if m > model.pose.shape[0]:
        j_m = model.inverse_jacobian
        cofactors, det = adjugate(j_m.T @ j_m)
        return on_joints + j_m @ (cofactors @ on_pose) / det
    # J_q^-T is outside the solve, so that a limb near its reach does not spoil the other limbs.
    transposed, det = adjugate(model.j_x_at_pose.T)
    return on_joints + model.j_q_at_pose * (transposed @ on_pose) / det


def _generalised_force(bodies: Bodies, variable: ca.SX, rates: list[ca.SX]) -> ca.SX:
    """Sum of J^T m (a - g) over the particles and of the rotors' inertia torques, on the variable."""
    force = ca.SX(variable.shape[0], 1)
    for particle in bodies.all_particles():
        acceleration = derivatives_along(particle.point, variable, rates)[2] + ca.vertcat(0, 0, GRAVITY)
        force += ca.jacobian(particle.point, variable).T @ (particle.mass * acceleration)
    for rotor in bodies.rotors:
        acceleration = derivatives_along(rotor.angle, variable, rates)[2]
        force += ca.jacobian(rotor.angle, variable).T * (rotor.inertia * acceleration)
    return force
