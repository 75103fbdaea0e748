"""Jerk-limited moves from pose to pose, and from motion to rest: to set up, to approach, to stop off the path.

A move goes on a straight line of the joints where these can move freely of each other and the line keeps to the joints'
ranges without a singularity; otherwise on a straight line of the pose. The pose is followed from where the move starts,
never found anew, so that it stays in its assembly mode.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from kinematics import (
    Array,
    InvalidValue,
    Mechanism,
    actuator_motion,
    checked,
    continued,
    from_actuators,
    inverse_dynamics,
    to_actuators,
)
from trajectory.errors import JointPeak, LimitsExceeded, MoveRefused
from trajectory.limits import Limits
from trajectory.moves.ruckig_plan import AxisLimits, Profile, fastest_move, fastest_stop
from trajectory.setpoints import Setpoints, robot_header

PARTS = 10  # of each period, at which limits, ranges and the pose are checked
_ROUNDING = 1e-9  # of a limit: ruckig's profiles touch the limits
_SAME_JOINTS = 1e-7  # rad, or of the robot's size: how far joints may be from those of their own pose
_GRID = 201  # poses of a line, from which its first limits come
_ROUNDS = 30  # of slowing a line of the pose down
_POWERS = {"speed": 1, "acceleration": 2, "jerk": 3, "torque": 2, "torque at speed": 2}  # of the pace, each rises with
_SWING = 1.5  # rad
_SLOWER = 1.01  # at least, in each round


@dataclass(frozen=True)
class Move:
    """A move that was checked.

    Attributes:
        setpoints: one a period; the last one is at rest, and holds.
        duration: a whole number of periods [s].
        peak_over_limit: of the joints' speed, acceleration and jerk, and of what else is limited.
    """

    setpoints: Setpoints
    duration: float
    peak_over_limit: dict[str, float]


class _Way(NamedTuple):
    """A move at every part of a period: times (k,), poses (k, n), actuators' motion and torque (k, m)."""

    times: Array
    pose: Array
    position: Array
    speed: Array
    acceleration: Array
    torque: Array


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
        UnreachablePose: start or target.
        MoveRefused: a pose on the way leaves a range, is singular or out of reach.
        TimingFailed: the planner reports anything but success.
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
            profile = fastest_move(joints[0], joints[1], _axis_limits(limits, joints.shape[1]), period, PARTS, wanted)
            way = _of_joints(robot, profile, ends[0], payload)
            _require_in_ranges(robot, way, limits)
            _require_at(robot, way, ends[1])
        except MoveRefused:
            pass
        else:
            return _move(robot, way, limits, payload, period, joint_units, asked)
    way = _of_pose(robot, ends, limits, payload, period, wanted)
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
    """The fastest jerk-limited stop of the joints, wherever that is; it leaves the path (`emergency_stop` does not).

    Args:
        robot, limits, payload, period, joint_units: as for `plan_move`; as many joints as freedoms.
        state: (m,) positions, speeds and accelerations of the actuators when the stop starts.
        near: (n,) a pose about where the stop starts; home by default.

    Raises:
        As `plan_move`; InvalidValue for a redundant robot too, and TimingFailed where the state itself is beyond a
        limit, or no rest can be reached.
    """
    _require_usable(limits, period)
    if len(robot.joint_names) != len(robot.pose_names):
        expected = f"{len(robot.pose_names)}, as many as freedoms: redundant joints cannot move freely of each other"
        raise InvalidValue(
            f"joints of {type(robot).__name__} for a stop of the joints", len(robot.joint_names), expected
        )
    given = [checked(v, "state", robot.actuator_names) for v in state]
    asked = {"state": dict(zip(("joints", "speed", "acceleration"), (v.tolist() for v in given), strict=True))}
    wanted = {**limits.as_dict(), "period": period, **asked}
    limited = _axis_limits(limits, given[0].size)
    profile = fastest_stop((given[0], given[1], given[2]), limited, period, PARTS, wanted)
    way = _of_joints(robot, profile, robot.home if near is None else checked(near, "near", robot.pose_names), payload)
    _require_in_ranges(robot, way, limits)
    return _move(robot, way, limits, payload, period, joint_units, asked)


def _move(
    robot: Mechanism,
    way: _Way,
    limits: Limits,
    payload: float,
    period: float,
    joint_units: tuple[str, ...],
    asked: dict[str, Any],
) -> Move:
    """Check the limits and sample; `asked` goes into the header."""
    found = _peaks(robot, way, limits)
    over = {name: peak for name, peak in found.items() if not peak.ratio <= 1.0 + _ROUNDING}
    if over:
        raise LimitsExceeded.of_peaks(over)
    table = np.concatenate([way.times[:, None], *way[1:]], axis=1)[::PARTS]
    count = len(table) - 1
    header = robot_header(robot, limits) | {"laws": ["ruckig"], "payload [kg]": payload} | asked
    header |= {"period [s]": float(period), "periods": [count]}
    points = Setpoints.of_table(table, robot.pose_names, robot.actuator_names, joint_units, header)
    return Move(points, count * period, {name: peak.ratio for name, peak in found.items()})


def _of_joints(robot: Mechanism, profile: Profile, near: Array, payload: float) -> _Way:
    """The poses of joints that move by a profile, followed from a pose near its start.

    Raises:
        MoveRefused: a pose on the way does not exist, or belongs to another working mode.
    """
    joints = from_actuators(robot, profile.position)
    pose = _followed(robot, joints, near)
    missing = ~np.isfinite(pose).all(axis=-1)
    if missing.any():
        k = int(np.argmax(missing))
        raise MoveRefused(
            "no pose without passing a singularity", float(profile.times[k]), pose[max(k - 1, 0)].tolist()
        )
    unit = np.array([1.0 if name == "rad" else robot.geometry.size for name in robot.joint_units])
    away = ~((np.abs(robot.inverse(pose) - joints) / unit).max(axis=-1) <= _SAME_JOINTS)
    if away.any():
        k = int(np.argmax(away))
        raise MoveRefused("another working mode", float(profile.times[k]), pose[k].tolist())
    # The pose's velocity and acceleration solve q' = J v and q'' = J a + J' v.
    jacobian, none = robot.actuator_jacobian(pose), np.zeros_like(pose)
    rates = robot.pose_rates(pose)
    velocity = np.einsum("kij,kj->ki", rates, np.linalg.solve(jacobian, profile.speed[..., None])[..., 0])
    bias = actuator_motion(robot, pose, velocity, none, none).second
    left = np.linalg.solve(jacobian, (profile.acceleration - bias)[..., None])[..., 0]
    torque = inverse_dynamics(robot, payload, pose, velocity, np.einsum("kij,kj->ki", rates, left))
    return _Way(profile.times, pose, profile.position, profile.speed, profile.acceleration, torque)


def _followed(robot: Mechanism, joints: Array, near: Array) -> Array:
    """(k, n) poses of joints (k, m), from one near the first on: each found from one less than half a turn away."""
    turns = [unit == "rad" for unit in robot.joint_units]
    first = continued(robot, joints[0], near)
    parts = (np.abs(joints - joints[0])[:, turns].max(axis=1, initial=0.0) // _SWING).astype(int)
    pose, last = np.empty((len(joints), len(robot.pose_names))), first
    for part in range(parts.max() + 1):
        rows = np.flatnonzero(parts == part)
        if rows.size:
            pose[rows] = continued(robot, joints[rows], last)
            last = pose[rows[-1]]
    return pose


def _of_pose(
    robot: Mechanism, ends: Array, limits: Limits, payload: float, period: float, wanted: dict[str, Any]
) -> _Way:
    """The fastest move on the straight line between two poses (2, n): planned along it, and slowed until it fits.

    Raises:
        MoveRefused: the line leaves a range or the reach, or passes a singularity.
        LimitsExceeded: it does not fit however slow.
    """
    along, count = ends[1] - ends[0], len(robot.joint_names)
    grid = ends[0] + np.linspace(0.0, 1.0, _GRID)[:, None] * along
    rest = np.zeros_like(grid)
    rate = np.abs(actuator_motion(robot, grid, np.broadcast_to(along, grid.shape), rest, rest).first)
    lost = ~np.isfinite(rate).all(axis=-1)
    if lost.any():
        raise MoveRefused("a limb out of reach", math.nan, grid[int(np.argmax(lost))].tolist())
    _require_regular(robot, grid)
    full = [np.array(limit) for limit in _axis_limits(limits, count)]
    with np.errstate(divide="ignore"):
        of_line = [float(np.min(limit / rate.max(axis=0), initial=1e12)) for limit in full]
    slower = 1.0
    for _ in range(_ROUNDS):
        scaled = AxisLimits(*([limit / slower**power] for power, limit in enumerate(of_line, start=1)))
        profile = fastest_move(np.zeros(1), np.ones(1), scaled, period, PARTS, wanted)
        s, first, second = profile.position, profile.speed, profile.acceleration
        pose, velocity, acceleration = ends[0] + s * along, first * along, second * along
        joints = actuator_motion(robot, pose, velocity, acceleration, np.zeros_like(pose))
        torque = inverse_dynamics(robot, payload, pose, velocity, acceleration)
        way = _Way(profile.times, pose, joints.position, joints.first, joints.second, torque)
        _require_in_ranges(robot, way, limits)
        found = _peaks(robot, way, limits)
        if max(peak.ratio for peak in found.values()) <= 1.0 + _ROUNDING:
            return way
        slower *= max(_SLOWER, *(peak.ratio ** (1 / _POWERS[name]) for name, peak in found.items()))
    raise LimitsExceeded.of_peaks({name: peak for name, peak in found.items() if peak.ratio > 1.0})


def _require_regular(robot: Mechanism, line: Array) -> None:
    """Check that a line of poses (k, n) keeps to one side of the parallel singularities.

    With more joints than freedoms no line separates two sides, and none is looked for.

    Raises:
        MoveRefused: naming the pose.
    """
    j_x = robot.jacobians(line)[1]
    if j_x.shape[-2] != j_x.shape[-1]:
        return
    sides = np.sign(np.linalg.det(j_x))
    across = (sides != sides[0]) | (sides == 0.0)
    if across.any():
        raise MoveRefused("a singularity", math.nan, line[int(np.argmax(across))].tolist())


def _require_at(robot: Mechanism, way: _Way, target: Array) -> None:
    """Check that a way ends at its target: in another assembly mode the same joints belong to another pose.

    Raises:
        MoveRefused: it ends elsewhere.
    """
    gap = float(robot.apart(way.pose[-1], target))
    if not gap <= _SAME_JOINTS:
        raise MoveRefused("another assembly mode than the target's", float(way.times[-1]), way.pose[-1].tolist())


def _require_in_ranges(robot: Mechanism, way: _Way, limits: Limits) -> None:
    """Check that every pose of a move is within reach and within the joints' ranges, at rest and passive ones too.

    Raises:
        MoveRefused: naming the margin, the time and the pose.
    """
    for name in ("reach", "joint_travel", "passive_joint"):
        if name in robot.margins:
            values = robot.margin(name, way.pose)
            worst = int(np.nanargmin(np.where(np.isnan(values), -np.inf, values)))
            if not values[worst] >= -_ROUNDING * robot.geometry.size:
                found = f"{name} of {values[worst]:.4g}, less than 0"
                raise MoveRefused(found, float(way.times[worst]), way.pose[worst].tolist())
    ranges = limits.ranges(len(robot.joint_names))
    if ranges is None:
        return
    beyond = np.maximum(ranges[0] - way.position, way.position - ranges[1]) / (ranges[1] - ranges[0])
    row, joint = np.unravel_index(int(beyond.argmax()), beyond.shape)
    if beyond[row, joint] > _ROUNDING:
        allowed = f"{ranges[0][joint]:g} to {ranges[1][joint]:g}"
        found = f"{robot.actuator_names[joint]} at {way.position[row, joint]:.6g}, not within {allowed}"
        raise MoveRefused(found, float(way.times[row]), way.pose[row].tolist())


def _require_usable(limits: Limits, period: float) -> None:
    for name in ("tool_speed", "tool_acceleration"):
        if getattr(limits, name) is not None:
            raise InvalidValue(
                f"Limits {name} for a move", getattr(limits, name), "None: a move keeps the joints' limits"
            )
    if limits.rms_torque is not None:
        what = "None: it is a mean over a cycle, which a single move is none of"
        raise InvalidValue("Limits rms_torque for a move", limits.rms_torque, what)
    if not (math.isfinite(period) and period > 0.0):
        raise InvalidValue("period", period, "a finite time > 0 s")


def _axis_limits(limits: Limits, count: int) -> AxisLimits:
    def needed(name: str) -> list[float]:
        limit = limits.of_joints(name, count)
        if limit is None:
            raise InvalidValue(f"Limits {name} for a move", None, "a limit: a jerk-limited move needs it")
        return [float(v) for v in limit]

    return AxisLimits(needed("speed"), needed("acceleration"), needed("jerk"))


def _peaks(robot: Mechanism, way: _Way, limits: Limits) -> dict[str, JointPeak]:
    """Each limited quantity where it is largest over its limit.

    The jerk is the mean over each step, and so never above its peak.
    """
    step = way.times[1] - way.times[0]
    quantities = {
        "speed": way.speed,
        "acceleration": way.acceleration,
        "jerk": np.diff(way.acceleration, axis=0) / step,
    }
    if limits.torque is not None:
        quantities["torque"] = way.torque
    count = way.position.shape[1]
    most = {name: np.asarray(limits.of_joints(name, count)) for name in quantities}
    stall, fastest = limits.of_joints("stall_torque", count), limits.of_joints("no_load_speed", count)
    if stall is not None and fastest is not None:
        quantities["torque at speed"] = np.abs(way.torque) / stall + np.abs(way.speed) / fastest
        most["torque at speed"] = np.ones(count)
    found = {}
    for name, values in quantities.items():
        row, joint = np.unravel_index(int((np.abs(values) / most[name]).argmax()), values.shape)
        value, limit = float(values[row, joint]), float(most[name][joint])
        found[name] = JointPeak(robot.actuator_names[joint], float(way.times[row]), value, limit)
    return found
