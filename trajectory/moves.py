"""Jerk-limited moves in joint space (ruckig): from pose to pose, and from motion to rest; the only ruckig importer.

Berscheid and Kroeger, "Jerk-limited real-time trajectory generation with arbitrary target states", RSS 2021. One move
from state to state: intermediate waypoints are never used, since this edition of ruckig sends them to a cloud.
The pose follows from the forward model, and must exist and come back by the inverse model all along.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from ruckig import (
    ControlInterface,
    DurationDiscretization,
    InputParameter,
    Result,
    Ruckig,
    RuckigError,
    Synchronization,
    Trajectory,
)

from kinematics import InvalidValue, Mechanism
from kinematics.drives import from_actuators, to_actuators
from kinematics.dynamics import inverse_dynamics
from kinematics.motion import actuator_motion
from kinematics.shapes import checked
from trajectory.errors import LimitsExceeded, TimingFailed
from trajectory.limits import Limits
from trajectory.path import Array
from trajectory.setpoints import Setpoints, robot_header

PARTS = 10  # of each period, at which the limits and the forward model are checked
_ROUNDING = 1e-9  # of a limit: ruckig's profiles touch the limits
_SAME_JOINTS = 1e-7  # how far the joints may be from those of their own pose


@dataclass(frozen=True, eq=False)
class Move:
    """A move that was checked.

    Attributes:
        setpoints: one a period; the last one is at rest, and holds.
        duration: a whole number of periods [s].
        peak_over_limit: of the joints' speed, acceleration and jerk, and of the torque where it is limited.
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
    """The fastest jerk-limited move of the joints from rest to rest, sampled each period.

    Args:
        robot: any mechanism with as many joints as freedoms.
        start: (n,) the pose to start from, such as the robot's home.
        target: (n,) the pose to reach, such as a cycle's start.
        limits: speed, acceleration and jerk are kept by the plan; torque is checked where given.
        payload: mass at the tool [kg].
        period: of the drives' bus; the duration is a whole number of periods [s].
        joint_units: rad or m for each joint.

    Raises:
        InvalidValue: a redundant robot, no acceleration or jerk limit, a tool limit, or an impossible period.
        UnreachablePose: start or target.
        TimingFailed: ruckig reports anything but success, or a pose on the way does not exist.
        LimitsExceeded: a limit is broken on the way.
    """
    _require_usable(robot, limits, period)
    ends = np.stack([np.asarray(start, dtype=float), np.asarray(target, dtype=float)])
    robot.require_reachable(ends)
    joints = to_actuators(robot, robot.inverse(ends))
    given = _input(limits, joints.shape[1])
    given.current_position, given.target_position = joints[0].tolist(), joints[1].tolist()
    asked = {"start": ends[0].tolist(), "target": ends[1].tolist()}
    return _move(robot, given, limits, payload, period, joint_units, asked)


def plan_stop(
    robot: Mechanism,
    state: tuple[Array, Array, Array],
    limits: Limits,
    payload: float,
    period: float,
    joint_units: tuple[str, ...],
) -> Move:
    """The fastest jerk-limited stop of the joints, wherever that is; it leaves the path (`emergency_stop` does not).

    Args:
        robot, limits, payload, period, joint_units: as for `plan_move`.
        state: (m,) positions, speeds and accelerations of the actuators when the stop starts.

    Raises:
        As `plan_move`; TimingFailed too where the state itself is beyond a limit, or no rest can be reached.
    """
    _require_usable(robot, limits, period)
    position, speed, acceleration = (checked(v, "state", robot.actuator_names).tolist() for v in state)
    given = _input(limits, len(position))
    given.control_interface = ControlInterface.Velocity
    given.current_position, given.current_velocity, given.current_acceleration = position, speed, acceleration
    asked = {"state": {"joints": position, "speed": speed, "acceleration": acceleration}}
    return _move(robot, given, limits, payload, period, joint_units, asked)


def _input(limits: Limits, count: int) -> InputParameter:
    """At rest, within the limits; where from and where to is left to fill in."""
    given = InputParameter(count)
    given.max_velocity = _needed(limits, "speed", count)
    given.max_acceleration = _needed(limits, "acceleration", count)
    given.max_jerk = _needed(limits, "jerk", count)
    given.duration_discretization = DurationDiscretization.Discrete
    given.synchronization = Synchronization.Phase  # a straight line of the joints: apart, they would spin the tool
    return given


def _move(
    robot: Mechanism,
    given: InputParameter,
    limits: Limits,
    payload: float,
    period: float,
    joint_units: tuple[str, ...],
    asked: dict[str, Any],
) -> Move:
    """Plan, check between the periods and sample; `asked` goes into the header and into errors."""
    wanted = {**limits.as_dict(), "period": period, **asked}
    plan = _plan(given, period, wanted)
    count = max(1, round(plan.duration / period))  # a period at rest where the target is the start
    if plan.duration > 0.0 and abs(count * period - plan.duration) > _ROUNDING * period:
        raise TimingFailed("ruckig", wanted, f"{plan.duration} s is no whole number of periods")
    times = np.round(np.arange(count * PARTS + 1) * (period / PARTS), 12)
    dense = _samples(plan, np.minimum(times, plan.duration))
    pose = _poses(robot, dense[0], times, wanted)
    torque = _torque(robot, payload, pose, dense)
    found = _peaks(dense, torque, limits, period / PARTS)
    over = {name: value for name, value in found.items() if not value <= 1.0 + _ROUNDING}
    if over:
        raise LimitsExceeded(over, 1.0)
    table = np.concatenate([times[:, None], pose, *dense, torque], axis=1)[::PARTS]
    header = robot_header(robot, limits) | {"laws": ["ruckig"], "payload [kg]": payload} | asked
    header |= {"period [s]": float(period), "periods": [count]}
    return Move(
        Setpoints.of_table(table, robot.pose_names, robot.actuator_names, joint_units, header), count * period, found
    )


def _require_usable(robot: Mechanism, limits: Limits, period: float) -> None:
    if len(robot.joint_names) != len(robot.pose_names):
        expected = f"{len(robot.pose_names)}, as many as freedoms: redundant joints cannot move freely of each other"
        raise InvalidValue(
            f"joints of {type(robot).__name__} for a move of the joints", len(robot.joint_names), expected
        )
    for name in ("tool_speed", "tool_acceleration"):
        if getattr(limits, name) is not None:
            raise InvalidValue(
                f"Limits {name} for a move of the joints", getattr(limits, name), "None: it moves the joints"
            )
    if limits.rms_torque is not None:
        what = "None: it is a mean over a cycle, which a single move is none of"
        raise InvalidValue("Limits rms_torque for a move of the joints", limits.rms_torque, what)
    if not (math.isfinite(period) and period > 0.0):
        raise InvalidValue("period", period, "a finite time > 0 s")


def _plan(given: InputParameter, period: float, asked: dict[str, object]) -> Trajectory:
    count = given.degrees_of_freedom
    plan = Trajectory(count)
    try:
        result = Ruckig(count, period).calculate(given, plan)
    except RuckigError as error:
        raise TimingFailed("ruckig", asked, str(error)) from error
    if result not in (Result.Working, Result.Finished):
        raise TimingFailed("ruckig", asked, f"no solution ({Result(result).name})")
    return plan


def _needed(limits: Limits, name: str, count: int) -> list[float]:
    limit = limits.of_joints(name, count)
    if limit is None:
        raise InvalidValue(f"Limits {name} for a move of the joints", None, "a limit: a jerk-limited move needs it")
    return [float(v) for v in limit]


def _samples(plan: Trajectory, times: Array) -> tuple[Array, Array, Array]:
    """Joints, speed and acceleration, (k, m) each; ruckig gives one time at a time."""
    rows = np.array([plan.at_time(float(t)) for t in times])
    return rows[:, 0], rows[:, 1], rows[:, 2]


def _poses(robot: Mechanism, joints: Array, times: Array, asked: dict[str, object]) -> Array:
    """(k, n) by the forward model; the working mode of every joint must come back."""
    pose = robot.forward(from_actuators(robot, joints))
    missing = ~np.isfinite(pose).all(axis=-1)
    if missing.any():
        raise TimingFailed("ruckig", asked, f"no pose at t = {times[int(np.argmax(missing))]:.6g} s")
    away = ~(np.abs(to_actuators(robot, robot.inverse(pose)) - joints).max(axis=-1) <= _SAME_JOINTS)
    if away.any():
        raise TimingFailed("ruckig", asked, f"another working mode at t = {times[int(np.argmax(away))]:.6g} s")
    return pose


def _torque(robot: Mechanism, payload: float, pose: Array, dense: tuple[Array, Array, Array]) -> Array:
    """(k, m): the pose's velocity and acceleration solve q' = J v and q'' = J a + J' v."""
    _, speed, acceleration = dense
    jacobian, none = robot.actuator_jacobian(pose), np.zeros_like(pose)
    velocity = np.linalg.solve(jacobian, speed[..., None])[..., 0]
    bias = actuator_motion(robot, pose, velocity, none, none).second
    pose_acceleration = np.linalg.solve(jacobian, (acceleration - bias)[..., None])[..., 0]
    return inverse_dynamics(robot, payload, pose, velocity, pose_acceleration)


def _peaks(dense: tuple[Array, Array, Array], torque: Array, limits: Limits, step: float) -> dict[str, float]:
    """Each limited quantity's peak over its limit; the jerk is the mean over each step, and so never above its peak."""
    joints, speed, acceleration = dense
    quantities = {"speed": speed, "acceleration": acceleration, "jerk": np.diff(acceleration, axis=0) / step}
    if limits.torque is not None:
        quantities["torque"] = torque
    count = joints.shape[1]
    found = {name: float((np.abs(v) / limits.of_joints(name, count)).max()) for name, v in quantities.items()}
    if (ranges := limits.ranges(count)) is not None:
        middle, half = (ranges[1] + ranges[0]) / 2, (ranges[1] - ranges[0]) / 2
        found["position"] = float((np.abs(joints - middle) / half).max())
    stall, fastest = limits.of_joints("stall_torque", count), limits.of_joints("no_load_speed", count)
    if stall is not None and fastest is not None:
        found["torque at speed"] = float((np.abs(torque) / stall + np.abs(speed) / fastest).max())
    return found
