"""A path's time law gives the motion of the pose, and that the motion of the joints and the drives."""

from __future__ import annotations

from typing import NamedTuple

from kinematics import Mechanism
from kinematics.dynamics import inverse_dynamics
from kinematics.motion import JointMotion, actuator_motion
from trajectory.path import Array, Path
from trajectory.timing import PathMotion


class PoseMotion(NamedTuple):
    """The pose and its time derivatives, each (..., n)."""

    pose: Array
    velocity: Array
    acceleration: Array
    jerk: Array


class Motion(NamedTuple):
    """All that moves: pose; joints as their actuators count them, with time derivatives; torque there (..., m)."""

    tool: PoseMotion
    joints: JointMotion
    torque: Array


def pose_motion(path: Path, along: PathMotion) -> PoseMotion:
    """The pose in time, by the chain rule on p(s(t)).

    Args:
        path: of the pose.
        along: (...,) arc length and its time derivatives.
    """
    pose, first, second, third = path.evaluate(along.position, 3)
    v, a, j = (x[..., None] for x in (along.speed, along.acceleration, along.jerk))
    return PoseMotion(pose, first * v, second * v**2 + first * a, third * v**3 + 3 * second * v * a + first * j)


def motion_of(robot: Mechanism, tool: PoseMotion, payload: float) -> Motion:
    """Joints and torque that belong to a motion of the pose; NaN where a limb cannot reach.

    Args:
        robot: any mechanism with this kind of pose.
        tool: (..., n) the pose and its time derivatives.
        payload: mass at the tool [kg].
    """
    torque = inverse_dynamics(robot, payload, tool.pose, tool.velocity, tool.acceleration)
    return Motion(tool, actuator_motion(robot, *tool), torque)
