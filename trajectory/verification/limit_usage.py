"""How much of each limit a motion uses, sample by sample; the verifier, the repair and the jerk law all go by this."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Array, JointMotion, Mechanism
from trajectory.limits import Limits
from trajectory.motions import Motion, PoseMotion
from trajectory.paths import places


class Use(NamedTuple):
    """One quantity at each sample, (..., m), or (..., 1) for the tool; SI units.

    `limit` and `ratio` are None where nothing limits the quantity; a ratio over 1 breaks the limit.
    """

    value: Array
    limit: Array | None
    ratio: Array | None


def uses(robot: Mechanism, motion: Motion, limits: Limits, slack: Motion | None = None) -> dict[str, Use]:
    """Each quantity by its name: those of the joints, the torque and the tool; position and line where limited.

    The ratio of "torque at speed" is |tau| / stall_torque + |q'| / no_load_speed, that of "joint position" the distance
    from the middle of the range over half of the range.

    Args:
        robot: of the motion.
        motion: (..., m) samples.
        limits: of joints and tool.
        slack: how far each sample may be from what it is; the most that it may use is then found.
    """
    joints, tool, count = motion.joints, motion.tool, motion.torque.shape[-1]
    more = slack or Motion(PoseMotion(*np.zeros(4)), JointMotion(*np.zeros(4)), np.zeros(1))
    speed, torque = np.abs(joints.first) + more.joints.first, np.abs(motion.torque) + more.torque

    def of_joints(values: Array, field: str) -> Use:
        return _against(values, limits.of_joints(field, count))

    def of_tool(values: Array, away: Array, limit: float | None) -> Use:
        size = sum(np.linalg.norm(np.atleast_1d(v)[..., : places(robot.pose_names)], axis=-1) for v in (values, away))
        return _against(np.asarray(size)[..., None], None if limit is None else np.array([limit]))

    found = {
        "joint speed": of_joints(speed, "speed"),
        "joint acceleration": of_joints(np.abs(joints.second) + more.joints.second, "acceleration"),
        "torque": of_joints(torque, "torque"),
        "tool speed": of_tool(tool.velocity, more.tool.velocity, limits.tool_speed),
        "tool acceleration": of_tool(tool.acceleration, more.tool.acceleration, limits.tool_acceleration),
        "joint jerk": of_joints(np.abs(joints.third) + more.joints.third, "jerk"),
    }
    if (ranges := limits.ranges(count)) is not None:
        middle, half = (ranges[1] + ranges[0]) / 2, (ranges[1] - ranges[0]) / 2
        away = joints.position - middle
        ratio = (np.abs(away) + more.joints.position) / half
        found["joint position"] = Use(joints.position, middle + np.copysign(half, away), ratio)
    stall, fastest = limits.of_joints("stall_torque", count), limits.of_joints("no_load_speed", count)
    if stall is not None and fastest is not None:
        share = speed / fastest
        found["torque at speed"] = Use(torque, stall * (1.0 - share), torque / stall + share)
    return found


@np.errstate(over="ignore")  # as of the bounds that are too wide
def _against(value: Array, limit: Array | None) -> Use:
    if limit is None:
        return Use(value, None, None)
    return Use(value, np.broadcast_to(limit, value.shape), value / limit)
