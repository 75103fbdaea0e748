"""A move, sampled several times in each period, and the checks of every move."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Array, InvalidField, JointMotion, Mechanism
from trajectory.errors import JointPeak, MoveRefused
from trajectory.limits import InstantLimit, Limits, uses
from trajectory.motions import Motion, PoseMotion
from trajectory.moves.ruckig_plan import AxisLimits

PARTS = 10  # of each period, at which limits, ranges and the pose are checked
ROUNDING = 1e-9  # of a limit: ruckig's profiles touch the limits


_Rates = tuple[Array, Array, Array]


class Way(NamedTuple):
    """A move at every part of a period: times (k,), and its motion there (k, ...).

    The jerk is the mean over the step that follows, and so never above its peak.
    """

    times: Array
    motion: Motion

    @classmethod
    def of(cls, times: Array, tool: _Rates, joints: _Rates, torque: Array) -> Way:
        """From the pose (k, n), the actuators' positions (k, m) and two derivatives by time of each."""

        def jerk(acceleration: Array) -> Array:
            steps = np.diff(acceleration, axis=0) / (times[1] - times[0])
            return np.concatenate([steps, steps[-1:]])

        motion = Motion(PoseMotion(*tool, jerk(tool[2])), JointMotion(*joints, jerk(joints[2])), torque)
        return cls(times, motion)


def peaks(robot: Mechanism, way: Way, limits: Limits) -> dict[InstantLimit, JointPeak]:
    """Each limited quantity of the joints that depends on the pace, where it is largest over its limit."""
    found = {}
    for limit, use in uses(robot, way.motion, limits).items():
        if use.limit is not None and use.ratio is not None and limit.pace_power:
            row, joint = np.unravel_index(int(use.ratio.argmax()), use.ratio.shape)
            at = float(use.value[row, joint]), float(use.limit[row, joint]), float(use.ratio[row, joint])
            found[limit] = JointPeak(robot.actuator_names[joint], float(way.times[row]), *at)
    return found


def require_in_ranges(robot: Mechanism, way: Way, limits: Limits) -> None:
    """Check that every pose of a move is within reach and within the joints' ranges, at rest and passive ones too.

    Raises:
        MoveRefused: naming the margin, the time and the pose.
    """
    for name in ("reach", "joint_travel", "passive_joint"):
        if name in robot.margins:
            values = robot.margin(name, way.motion.tool.pose)
            worst = int(np.nanargmin(np.where(np.isnan(values), -np.inf, values)))
            if not values[worst] >= -ROUNDING * robot.geometry.size:
                found = f"a margin {name} of {values[worst]:.4g}, below 0"
                raise MoveRefused(found, float(way.times[worst]), way.motion.tool.pose[worst].tolist())
    position, ranges = way.motion.joints.position, limits.ranges(len(robot.joint_names))
    if ranges is None:
        return
    beyond = np.maximum(ranges[0] - position, position - ranges[1]) / (ranges[1] - ranges[0])
    row, joint = np.unravel_index(int(beyond.argmax()), beyond.shape)
    if beyond[row, joint] > ROUNDING:
        allowed = f"{ranges[0][joint]:g} to {ranges[1][joint]:g}"
        found = f"{robot.actuator_names[joint]} at {position[row, joint]:.6g}, not within {allowed}"
        raise MoveRefused(found, float(way.times[row]), way.motion.tool.pose[row].tolist())


def axis_limits(limits: Limits, count: int) -> AxisLimits:
    """Speed, acceleration and jerk of the actuators.

    Raises:
        InvalidValue: one of them is not limited.
    """

    def needed(name: str) -> list[float]:
        limit = limits.of_joints(name, count)
        if limit is None:
            raise InvalidField("Limits", name, None, "a limit, as a jerk-limited move needs it", "for a move")
        return [float(v) for v in limit]

    return AxisLimits(needed("speed"), needed("acceleration"), needed("jerk"))
