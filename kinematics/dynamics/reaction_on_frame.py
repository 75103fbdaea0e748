"""The force and the moment with which a machine in motion pulls at its frame: the weights and d'Alembert's forces of
all that moves.
"""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked
from kinematics.dynamics.drive_torque import require_payload
from kinematics.dynamics.proper_acceleration import ProperAcceleration
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
    rates = [ca.SX.sym(name, model.pose.numel()) for name in ("velocity", "acceleration")]
    felt, payload = ProperAcceleration(robot, *rates), ca.SX.sym("payload")
    found = felt.at_pose(_sum(robot.bodies(model.pose, model.joints, model.g, payload), felt))
    return [model.pose, *rates, payload], [found[:3], found[3:]]


def _sum(bodies: Bodies, felt: ProperAcceleration) -> ca.SX:
    """(6,) force and moment."""
    force, moment = ca.SX(3, 1), ca.SX(3, 1)
    for particle in bodies.all_particles():
        own = -particle.mass * felt(particle.point)
        force += own
        moment += ca.cross(particle.point, own)
    for rotor in bodies.rotors:
        if rotor.axis is not None:
            speed = ca.jtimes(rotor.angle, felt.variable, felt.rates[0])
            moving, faster = ca.vertcat(felt.variable, felt.rates[0]), ca.vertcat(*felt.rates)
            moment -= ca.jtimes(rotor.inertia * speed * rotor.axis, moving, faster)
    result: ca.SX = ca.vertcat(force, moment)
    return result
