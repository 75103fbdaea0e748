"""How much of each limit a motion uses, sample by sample; the verifier, the repair and the jerk law all go by this."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Mechanism
from trajectory.limits import Limits
from trajectory.motion import Motion
from trajectory.path import Array


class Use(NamedTuple):
    """One quantity at each sample, (..., m), or (..., 1) for the tool; SI units.

    `limit` and `ratio` are None where nothing limits the quantity; a ratio over 1 breaks the limit.
    """

    value: Array
    limit: Array | None
    ratio: Array | None


def uses(robot: Mechanism, motion: Motion, limits: Limits) -> dict[str, Use]:
    """Each quantity by its name: those of the joints, the torque and the tool; position and line where limited.

    The ratio of "torque at speed" is |tau| / stall_torque + |q'| / no_load_speed, that of "joint position" the distance
    from the middle of the range over half of the range.

    Args:
        robot: of the motion.
        motion: (..., m) samples.
        limits: of joints and tool.
    """
    joints, torque = motion.joints, np.abs(motion.torque)
    count = torque.shape[-1]
    coordinates = len(robot.pose_names) - len(robot.rotations)

    def of_joints(values: Array, field: str) -> Use:
        return _against(np.abs(values), limits.of_joints(field, count))

    def of_tool(values: Array, limit: float | None) -> Use:
        size = np.linalg.norm(values[..., :coordinates], axis=-1, keepdims=True)
        return _against(size, None if limit is None else np.array([limit]))

    found = {
        "joint speed": of_joints(joints.first, "speed"),
        "joint acceleration": of_joints(joints.second, "acceleration"),
        "torque": of_joints(torque, "torque"),
        "tool speed": of_tool(motion.tool.velocity, limits.tool_speed),
        "tool acceleration": of_tool(motion.tool.acceleration, limits.tool_acceleration),
        "joint jerk": of_joints(joints.third, "jerk"),
    }
    if (ranges := limits.ranges(count)) is not None:
        middle, half = (ranges[1] + ranges[0]) / 2, (ranges[1] - ranges[0]) / 2
        away = joints.position - middle
        found["joint position"] = Use(joints.position, middle + np.copysign(half, away), np.abs(away) / half)
    stall, fastest = limits.of_joints("stall_torque", count), limits.of_joints("no_load_speed", count)
    if stall is not None and fastest is not None:
        speed = np.abs(joints.first) / fastest
        found["torque at speed"] = Use(torque, stall * (1.0 - speed), torque / stall + speed)
    return found


def _against(value: Array, limit: Array | None) -> Use:
    if limit is None:
        return Use(value, None, None)
    return Use(value, np.broadcast_to(limit, value.shape), value / limit)
