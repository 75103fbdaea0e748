"""The force and the moment with which a machine in motion pulls at its frame: the weights and d'Alembert's forces of
all that moves.
"""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked
from kinematics.dynamics.chain_rule import derivatives_along
from kinematics.dynamics.drive_torque import GRAVITY, require_payload
from kinematics.evaluation import evaluate
from kinematics.machine import Bodies
from kinematics.model import Build, Mechanism, Model


class FrameReaction(NamedTuple):
    """What the machine exerts on its frame, in the base's axes.

    Attributes:
        force: (..., 3) [N].
        moment: (..., 3) about the base's origin [N m].
    """

    force: Array
    moment: Array


def frame_reaction(
    robot: Mechanism, payload: float, pose: Array, velocity: Array, acceleration: Array
) -> FrameReaction:
    """Force and moment on the frame along a motion.

    They are those of the moving masses in `bodies`. What stands still on the frame has only its weight, and is left
    out. So are rotors without a known axis, and the motors behind the gears of the `drive_train`.

    Args:
        robot: any mechanism.
        payload: mass at the tool [kg].
        pose, velocity, acceleration: (..., n) the pose and its time derivatives.

    Returns:
        Force and moment; NaN where a limb cannot reach.

    Raises:
        InvalidValue: the payload is no mass.
    """
    motion = {"pose": pose, "velocity": velocity, "acceleration": acceleration}
    given = np.broadcast_arrays(*(checked(v, name, robot.pose_names) for name, v in motion.items()))
    require_payload(payload)
    mass = np.full((*given[0].shape[:-1], 1), payload)
    force, moment = evaluate(robot.program(_frame_reaction), *given, mass)
    lost = np.isnan(force).any(axis=-1) | np.isnan(moment).any(axis=-1)
    force[lost] = moment[lost] = np.nan
    return FrameReaction(force, moment)


def _frame_reaction(robot: Mechanism, model: Model) -> Build:
    n, m = model.pose.shape[0], model.joints.shape[0]
    rates = [ca.SX.sym(name, n) for name in ("velocity", "acceleration")]
    joint_rates = [ca.SX.sym(f"joint_{name}", m) for name in ("velocity", "acceleration")]
    payload = ca.SX.sym("payload")
    both = [ca.vertcat(q, x) for q, x in zip(joint_rates, rates, strict=True)]
    bodies = robot.bodies(model.pose, model.joints, model.g, payload)
    found = _sum(bodies, ca.vertcat(model.joints, model.pose), both)
    joint_motion = derivatives_along(model.inverse, model.pose, rates)[1:]
    found = ca.substitute(model.at_pose(found), ca.vertcat(*joint_rates), ca.vertcat(*joint_motion))
    return [model.pose, *rates, payload], [found[:3], found[3:]]


def _sum(bodies: Bodies, variable: ca.SX, rates: list[ca.SX]) -> ca.SX:
    """(6,) force and moment."""
    force, moment = ca.SX(3, 1), ca.SX(3, 1)
    for particle in bodies.all_particles():
        acceleration = derivatives_along(particle.point, variable, rates)[2]
        own = -particle.mass * (acceleration + ca.vertcat(0, 0, GRAVITY))
        force += own
        moment += ca.cross(particle.point, own)
    for rotor in bodies.rotors:
        if rotor.axis is not None:
            speed = derivatives_along(rotor.angle, variable, rates)[1]
            moving, faster = ca.vertcat(variable, rates[0]), ca.vertcat(*rates)
            moment -= ca.jtimes(rotor.inertia * speed * rotor.axis, moving, faster)
    result: ca.SX = ca.vertcat(force, moment)
    return result
