"""Jerk-limited moves from pose to pose, and stops that leave the path.

A move is a straight line in the joints if the joints can move independently, and if this line stays in the joints'
ranges and passes no singularity. Otherwise it is a straight line of the pose. The pose is followed from the start of
the move, so that it stays in its assembly mode.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from kinematics import Array, InvalidField, InvalidValue, Mechanism, checked, to_actuators
from trajectory.errors import LimitsExceeded, MoveRefused
from trajectory.limits import Limits
from trajectory.moves.joint_line import of_joints, require_at
from trajectory.moves.pose_line import of_pose
from trajectory.moves.ruckig_plan import fastest_move, fastest_stop
from trajectory.moves.way import PARTS, ROUNDING, Way, axis_limits, peaks, require_in_ranges
from trajectory.setpoints import Setpoints, robot_header


@dataclass(frozen=True)
class Move:
    """A move that was checked.

    Attributes:
        setpoints: one for each period; the last one is at rest.
        duration: a whole number of periods [s].
        peak_over_limit: for the joints' speed, acceleration and jerk, and for the other limits.
    """

    setpoints: Setpoints
    duration: float
    peak_over_limit: dict[str, float]


def plan_move(
    robot: Mechanism,
    start: Array,
    target: Array,
    limits: Limits,
    payload: float,
    period: float,
    joint_units: tuple[str, ...],
) -> Move:
    """A jerk-limited move from rest to rest, sampled each period; the fastest on its line.

    Args:
        robot: any mechanism.
        start: (n,) the pose to start from, such as the robot's home.
        target: (n,) the pose to reach, such as a cycle's start.
        limits: speed, acceleration and jerk are kept by the plan; torque, torque at speed and position are checked.
        payload: mass at the tool [kg].
        period: of the drives' bus; the duration is a whole number of periods [s].
        joint_units: rad or m for each joint.

    Raises:
        InvalidValue: no acceleration or jerk limit, a tool limit, or an impossible period.
        UnreachablePose: the start or the target is out of reach.
        MoveRefused: a pose on the way is outside a range, singular or out of reach.
        TimingFailed: the planner does not report success.
        LimitsExceeded: a limit is broken on the way.
    """
    _require_usable(limits, period)
    ends = np.stack([checked(v, name, robot.pose_names) for v, name in ((start, "start"), (target, "target"))])
    robot.require_reachable(ends)
    joints = to_actuators(robot, robot.inverse(ends))
    asked = {"start": ends[0].tolist(), "target": ends[1].tolist()}
    wanted = {**limits.as_dict(), "period": period, **asked}
    if len(robot.joint_names) == len(robot.pose_names):
        try:
            profile = fastest_move(joints[0], joints[1], axis_limits(limits, joints.shape[1]), period, PARTS, wanted)
            way = of_joints(robot, profile, ends[0], payload)
            require_in_ranges(robot, way, limits)
            require_at(robot, way, ends[1])
        except MoveRefused:
            pass
        else:
            return _move(robot, way, limits, payload, period, joint_units, asked)
    way = of_pose(robot, ends, limits, payload, period, wanted)
    return _move(robot, way, limits, payload, period, joint_units, asked)


def plan_stop(
    robot: Mechanism,
    state: tuple[Array, Array, Array],
    limits: Limits,
    payload: float,
    period: float,
    joint_units: tuple[str, ...],
    near: Array | None = None,
) -> Move:
    """The fastest jerk-limited stop of the joints, at any place. It leaves the path; `emergency_stop` does not.

    Args:
        robot, limits, payload, period, joint_units: as for `plan_move`; as many joints as freedoms.
        state: (m,) positions, speeds and accelerations of the actuators when the stop starts.
        near: (n,) a pose about where the stop starts; home by default.

    Raises:
        As `plan_move`. Also InvalidValue for a redundant robot, and TimingFailed if the state itself is beyond a limit
        or the joints cannot come to rest.
    """
    _require_usable(limits, period)
    if len(robot.joint_names) != len(robot.pose_names):
        expected = f"{len(robot.pose_names)}, as many as freedoms, as redundant joints cannot move independently"
        raise InvalidValue(
            f"joints of {type(robot).__name__} for a stop of the joints", len(robot.joint_names), expected
        )
    given = [checked(v, "state", robot.actuator_names) for v in state]
    asked = {"state": dict(zip(("joints", "speed", "acceleration"), (v.tolist() for v in given), strict=True))}
    wanted = {**limits.as_dict(), "period": period, **asked}
    limited = axis_limits(limits, given[0].size)
    profile = fastest_stop((given[0], given[1], given[2]), limited, period, PARTS, wanted)
    way = of_joints(robot, profile, robot.home if near is None else checked(near, "near", robot.pose_names), payload)
    require_in_ranges(robot, way, limits)
    return _move(robot, way, limits, payload, period, joint_units, asked)


def _move(
    robot: Mechanism,
    way: Way,
    limits: Limits,
    payload: float,
    period: float,
    joint_units: tuple[str, ...],
    asked: dict[str, Any],
) -> Move:
    """Check the limits and sample; `asked` goes into the header."""
    found = peaks(robot, way, limits)
    over = {limit.name: peak for limit, peak in found.items() if not peak.ratio <= 1.0 + ROUNDING}
    if over:
        raise LimitsExceeded.of_peaks(over)
    tool, joints, torque = way.motion
    table = np.concatenate([way.times[:, None], tool.pose, *joints[:3], torque], axis=1)[::PARTS]
    count = len(table) - 1
    header = robot_header(robot, limits) | {"laws": ["ruckig"], "payload [kg]": payload} | asked
    header |= {"period [s]": float(period), "periods": [count]}
    points = Setpoints.of_table(table, robot.pose_names, robot.actuator_names, joint_units, header)
    return Move(points, count * period, {limit.name: peak.ratio for limit, peak in found.items()})


def _require_usable(limits: Limits, period: float) -> None:
    for limit in limits:
        if limit.not_for_moves:
            name = limit.fields[0].name
            raise InvalidField("Limits", name, getattr(limits, name), f"None: {limit.not_for_moves}", "for a move")
    if not (math.isfinite(period) and period > 0.0):
        raise InvalidValue("period", period, "a finite time > 0 s")
