"""ROS 2 `trajectory_msgs/msg/JointTrajectory`: YAML for people and `ros2 topic pub`, MCAP for rosbag2.

rad, rad/s, rad/s^2 (m on a rail). With accelerations the joint_trajectory_controller interpolates by quintics. Efforts
are left out: it refuses a trajectory that has them.
"""

from __future__ import annotations

import io
import json
from typing import Any

from mcap.writer import CompressionType
from mcap_ros2.writer import Writer

from kinematics import InvalidValue
from trajectory.drive_files.drive import Drive
from trajectory.drive_files.text import header_lines
from trajectory.setpoints import Setpoints

TOPIC = "/joint_trajectory_controller/joint_trajectory"
TYPE = "trajectory_msgs/msg/JointTrajectory"
_DEFINITION = f"""\
std_msgs/Header header
string[] joint_names
trajectory_msgs/JointTrajectoryPoint[] points
{"=" * 80}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
{"=" * 80}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
{"=" * 80}
MSG: trajectory_msgs/JointTrajectoryPoint
float64[] positions
float64[] velocities
float64[] accelerations
float64[] effort
builtin_interfaces/Duration time_from_start
{"=" * 80}
MSG: builtin_interfaces/Duration
int32 sec
uint32 nanosec
"""
_NS = 10**9


def write(stem: str, setpoints: Setpoints, drive: Drive) -> dict[str, str | bytes]:
    """The files' content by name.

    Raises:
        InvalidValue: the period is no whole number of nanoseconds, or names do not fit.
    """
    message = _message(setpoints, drive)
    lines = [*header_lines(setpoints.header, "#"), f"header: {json.dumps(message['header'])}"]
    lines += [f"joint_names: {json.dumps(message['joint_names'])}", "points:"]
    lines += [f"- {{{', '.join(f'{name}: {_flow(value)}' for name, value in p.items())}}}" for p in message["points"]]
    return {f"{stem}.ros2.yaml": "\n".join(lines) + "\n", f"{stem}.ros2.mcap": _bag(message, setpoints)}


def _message(setpoints: Setpoints, drive: Drive) -> dict[str, Any]:
    period = setpoints.header["period [s]"]
    step = round(period * _NS)
    if abs(step - period * _NS) > 1e-6:
        raise InvalidValue("period of a JointTrajectory", period, "a whole number of nanoseconds")
    rows = zip(setpoints.joints.tolist(), setpoints.speed.tolist(), setpoints.acceleration.tolist(), strict=True)
    points = []
    for k, (positions, velocities, accelerations) in enumerate(rows):
        sec, nanosec = divmod(k * step, _NS)
        point = {"positions": positions, "velocities": velocities, "accelerations": accelerations, "effort": []}
        points.append(point | {"time_from_start": {"sec": sec, "nanosec": nanosec}})
    at_once = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    return {"header": at_once, "joint_names": list(drive.names(setpoints.joint_names)), "points": points}


def _bag(message: dict[str, Any], setpoints: Setpoints) -> bytes:
    stream = io.BytesIO()
    with Writer(stream, compression=CompressionType.NONE) as writer:
        schema = writer.register_msgdef(TYPE, _DEFINITION)
        writer.write_message(TOPIC, schema, message, log_time=0)
        writer.add_metadata("linkwright", {name: json.dumps(value) for name, value in setpoints.header.items()})
    return stream.getvalue()


def _flow(value: object) -> str:
    if isinstance(value, list):
        return f"[{', '.join(_number(v) for v in value)}]"
    return json.dumps(value).replace('"', "")


def _number(value: float) -> str:
    """A number with all digits. Without a point, YAML 1.1 would read 1e-05 as a word."""
    text = repr(value)
    return text if "." in text else text.replace("e", ".0e")
