"""What a robot's tool holds, at its place."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked
from kinematics.evaluation import evaluate
from kinematics.machine import Plate, Tube
from kinematics.model import Build, Mechanism, Model
from kinematics.multibody.placed_shapes import PlacedShape

PAYLOAD = "payload"  # its name, as in messages


def payload_shape(robot: Mechanism, model: Model) -> Tube | Plate | None:
    """The hull of what the tool holds, in the model's symbols; None without one."""
    hull = robot.surroundings.payload_hull
    return None if hull is None else hull.shape(*robot.tool_frame(model.pose))


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
    point, axes = robot.tool_frame(model.pose)
    return [model.pose], [ca.horzcat(point + axes[:, 2] * hull.low, point + axes[:, 2] * hull.high)]
