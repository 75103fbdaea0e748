"""The numbers of the jerk-limited problem: what a path, a robot and its limits are at the stations, exactly."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Mechanism
from kinematics.motion import actuator_motion
from trajectory.limits import Limits
from trajectory.path import Array, Path
from trajectory.torque_terms import torque_along

_TORQUES = ("torque", "stall_torque", "rms_torque")


class Scale(NamedTuple):
    """What 1 stands for in the problem: the start's duration [s], and of the path [m/s, m/s^2, m/s^3]."""

    time: float
    speed: float
    acceleration: float
    jerk: float

    @classmethod
    def of(cls, length: float, time: float) -> Scale:
        """The path's length in that time."""
        return cls(time, length / time, length / time**2, length / time**3)


class Numbers(NamedTuple):
    """As the problem takes them.

    Attributes:
        parameters: by the problem's names; of joints (2 n + 1, m) at the stations, for jerk (n + 1, m) at the knots.
        top_speeds: (2 n + 1,) of v, by the quantity that bounds it.
        bounds: (m,), or (1,) for the tool: highest of a quantity's rows; the lowest is its negative, where it has one.
    """

    parameters: dict[str, Array]
    top_speeds: dict[str, Array]
    bounds: dict[str, Array]


def numbers_of(robot: Mechanism, path: Path, limits: Limits, payload: float, position: Array, scale: Scale) -> Numbers:
    """At the stations `position` (2 n + 1,) [m]; an error where a limit is for another number of joints."""
    derivatives = path.evaluate(position, 3)
    joints = actuator_motion(robot, *derivatives)
    count = len(robot.actuator_names)
    given = {f: limit for f in ("speed", "acceleration", "jerk") if (limit := limits.of_joints(f, count)) is not None}
    found = Numbers({"ds": np.diff(position[::2]) / path.length}, {}, {})
    with np.errstate(divide="ignore"):  # joints at rest bound nothing
        fastest = given["speed"] / np.abs(joints.first)
    found.top_speeds["joint speed"] = fastest.min(axis=-1) / scale.speed
    if "acceleration" in given:
        found.parameters["acceleration_a"] = joints.first * scale.acceleration / given["acceleration"]
        found.parameters["acceleration_v"] = joints.second * scale.speed**2 / given["acceleration"]
        found.bounds["joint acceleration"] = np.ones(count)
    if "jerk" in given:
        found.parameters["jerk_j"] = joints.first[::2] * scale.jerk / given["jerk"]
        found.parameters["jerk_va"] = 3 * joints.second[::2] * scale.speed * scale.acceleration / given["jerk"]
        found.parameters["jerk_vvv"] = joints.third[::2] * scale.speed**3 / given["jerk"]
        found.bounds["joint jerk"] = np.ones(count)
    _add_torque(found, robot, limits, payload, derivatives, scale)
    if "torque at speed" in found.bounds:
        found.parameters["line_speed"] = np.abs(joints.first) * scale.speed / limits.of_joints("no_load_speed", count)
    coordinates = len(robot.pose_names) - len(robot.rotations)
    _add_tool(found, limits, derivatives[1][:, :coordinates], derivatives[2][:, :coordinates], scale)
    return found


def _add_torque(
    found: Numbers, robot: Mechanism, limits: Limits, payload: float, derivatives: tuple[Array, ...], scale: Scale
) -> None:
    """Torque over whichever of its limits comes first, and the others over that one."""
    given = [limits.of_joints(field, len(robot.actuator_names)) for field in _TORQUES]
    unit = next((limit for limit in given if limit is not None), None)
    if unit is None:
        return
    peak, stall, rms = given
    torque = torque_along(robot, payload, derivatives, scale.speed, scale.acceleration)
    found.parameters["torque_a"] = torque.inertia * scale.acceleration / unit
    found.parameters["torque_vv"] = torque.centrifugal * scale.speed**2 / unit
    found.parameters["torque_v"] = torque.viscous * scale.speed / unit
    found.parameters["torque_rest"] = torque.constant / unit
    if peak is not None:
        found.bounds["torque"] = peak / unit
    if stall is not None:
        found.parameters["line"] = unit / stall + np.zeros_like(torque.inertia)
        found.bounds["torque at speed"] = np.ones(unit.size)
    if rms is not None:
        found.parameters["rms"] = (unit / rms)[None] ** 2
        found.bounds["rms torque"] = np.zeros(unit.size)


def _add_tool(found: Numbers, limits: Limits, first: Array, second: Array, scale: Scale) -> None:
    if limits.tool_speed is not None:
        found.top_speeds["tool speed"] = limits.tool_speed / np.linalg.norm(first, axis=-1) / scale.speed
    if limits.tool_acceleration is not None:
        along, across = scale.acceleration / limits.tool_acceleration, scale.speed**2 / limits.tool_acceleration
        found.parameters["tool_aa"] = (first**2).sum(axis=-1) * along**2
        found.parameters["tool_av"] = 2 * (first * second).sum(axis=-1) * along * across
        found.parameters["tool_vv"] = (second**2).sum(axis=-1) * across**2
        found.bounds["tool acceleration"] = np.ones(1)
