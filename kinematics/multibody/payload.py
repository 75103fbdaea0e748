"""What a robot's tool holds, at its place."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked
from kinematics.evaluation import evaluate
from kinematics.machine import Plate, Tube
from kinematics.mathematics import rotation_symbolic
from kinematics.model import Build, Mechanism, Model
from kinematics.multibody.placed_shapes import PlacedShape

PAYLOAD = "payload"  # its name, as in messages


def payload_shape(robot: Mechanism, model: Model) -> Tube | Plate | None:
    """The hull of what the tool holds, in the model's symbols; None without one."""
    hull = robot.surroundings.payload_hull
    return None if hull is None else hull.shape(*_tool_frame(robot, model))


def placed_payload(robot: Mechanism, pose: Array) -> PlacedShape | None:
    """The round body that the tool holds at a pose (n,), as its axis and its radius; None without one."""
    hull = robot.surroundings.payload_hull
    if hull is None:
        return None
    (ends,) = evaluate(robot.program(_axis), checked(pose, "pose", robot.pose_names))
    return PlacedShape(PAYLOAD, "", np.array(ends).T, hull.radius)


def _axis(robot: Mechanism, model: Model) -> Build:
    hull = robot.surroundings.payload_hull
    assert hull is not None
    point, axes = _tool_frame(robot, model)
    return [model.pose], [ca.horzcat(point + axes[:, 2] * hull.low, point + axes[:, 2] * hull.high)]


def _tool_frame(robot: Mechanism, model: Model) -> tuple[ca.SX, ca.SX]:
    """The tool point (3,), and the axes of the tool (3, 3); a turn about its z axis is left out: the hull is round."""
    names = robot.pose_names
    point = ca.vertcat(*(model.pose[names.index(name)] if name in names else 0 for name in ("x", "y", "z")))
    if "roll" not in names:
        return point, ca.SX.eye(3)
    return point, rotation_symbolic(model.pose[[names.index(name) for name in ("roll", "pitch", "yaw")]])
