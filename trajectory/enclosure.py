"""How far the joints' motion and the torque can be, between samples, from what they are at the samples.

Over a short time a quantity f is within r max |f'| of its value in the middle, r half of that time: an interval kernel,
rounded outward, bounds f' from bounds of the pose's motion, and these follow from a bound of its fourth derivative, one
order after the other. So nothing is left between the samples.
"""

from __future__ import annotations

from functools import lru_cache

import casadi as ca
import numpy as np

from kinematics import Mechanism
from kinematics.box_program import BoxProgram
from kinematics.dynamics import torques
from kinematics.interval import enclose
from kinematics.mechanism import Array
from kinematics.motion import JointMotion, actuator_motion, derivatives_along
from kinematics.program import Program
from trajectory.motion import Motion, PoseMotion
from trajectory.timed import TimedMotion

_SLACK = 1e-12  # relative and absolute: far more than what evaluation in double arithmetic is off by


def slack(robot: Mechanism, timed: TimedMotion, payload: float, low: Array, high: Array) -> Motion:
    """Bounds of |f(t) - f(middle)| over each part, (k, ...), in the layout of the motion itself.

    Args:
        robot: any mechanism with this kind of pose.
        timed: the motion.
        payload: mass at the tool [kg].
        low, high: (k,) times between which a part lies, each inside one interval of the motion [s].
    """
    half = ((high - low) * (0.5 + _SLACK))[:, None]
    tool, snap, away = timed.at(0.5 * low + 0.5 * high), timed.steepest_jerk(low, high), list[Array]()
    steepest = snap
    for value in tool[::-1]:
        away.insert(0, half * steepest + _SLACK * (1.0 + np.abs(value)))
        steepest = np.abs(value) + away[0]
    bounds = [np.stack([value - d, value + d]) for value, d in zip(tool, away, strict=True)]
    boxes = np.concatenate([*bounds, np.stack([-snap, snap])], axis=-1)
    slopes = np.abs(enclose(_slopes(robot, payload), *boxes)).max(axis=0)
    found = half * np.nan_to_num(slopes, nan=np.inf)
    count = len(robot.joint_names)
    *joints, torque = (found[:, k * count : (k + 1) * count] for k in range(5))
    return Motion(PoseMotion(*away), JointMotion(*joints), torque + _friction_slack(robot, tool, joints[1]))


def _friction_slack(robot: Mechanism, tool: PoseMotion, away: Array) -> Array:
    """How far the friction may be from that in the middle, where a joint's speed is `away` from it."""
    drives, count = robot.inertia.drive_train, away.shape[1]
    coulomb, viscous = (drives.of_actuators(name, count) for name in ("coulomb", "viscous"))
    if not (coulomb.any() or viscous.any()):
        return np.zeros_like(away)
    speed = actuator_motion(robot, *tool).first
    return viscous * away + np.where(np.abs(speed) <= away, 2.0 * coulomb, 0.0)


@lru_cache(maxsize=16)
def _slopes(robot: Mechanism, payload: float) -> BoxProgram:
    """Pose, velocity, acceleration, jerk and its rate -> the actuators' first to fourth derivatives, torque's first."""
    model = robot.model()
    rates = velocity, acceleration, jerk, _ = [
        ca.SX.sym(name, model.pose.shape[0]) for name in ("velocity", "acceleration", "jerk", "rate")
    ]
    joints = derivatives_along(model.drives @ model.inverse, model.pose, rates)[1:]
    tau = torques(robot, payload, velocity, acceleration)
    state, following = ca.vertcat(model.pose, velocity, acceleration), ca.vertcat(velocity, acceleration, jerk)
    slopes = ca.vertcat(*joints, ca.jtimes(tau, state, following))
    function = ca.Function("slopes", [model.pose, *rates, model.geometry], [ca.cse(ca.densify(slopes))])
    return BoxProgram.of(Program.of(function), robot.geometry.vector().tolist())
