"""The shapes of a mechanism's members, and of its base, at one pose."""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked
from kinematics.evaluation import evaluate
from kinematics.machine import Member, Plate, Tube
from kinematics.model import Build, Mechanism, Model


class PlacedShape(NamedTuple):
    """All points within `around` [m] of the hull of some corners.

    Attributes:
        member: its name.
        kind: the kind of material, as a field of `Structure`; empty for a part of the base.
        corners: (k, 3) two ends of a tube, or the corners of a plate in order [m].
    """

    member: str
    kind: str
    corners: Array
    around: float

    def sides(self) -> tuple[Array, Array]:
        """Of a plate, the corners of both faces, (k, 3) each."""
        normal = np.linalg.svd(self.corners - self.corners.mean(axis=0))[2][2] * self.around
        return self.corners - normal, self.corners + normal


def placed_shapes(robot: Mechanism, pose: Array) -> list[PlacedShape]:
    """The shapes of all members and of the base at a pose (n,); NaN where a limb cannot reach."""
    pose = checked(pose, "pose", robot.pose_names)
    corners, sizes = evaluate(robot.program(_shapes), pose)
    found, first = [], 0
    for (member, shape), around in zip(_all(robot, robot.model()), sizes, strict=True):
        last = first + shape.corners.shape[1]
        found.append(PlacedShape(member.name, member.material, np.array(corners[:, first:last]).T, float(around)))
        first = last
    return found


def _all(robot: Mechanism, model: Model) -> list[tuple[Member, Tube | Plate]]:
    members = robot.all_members(model.pose, model.joints, model.g)
    return [(member, shape) for member in members for shape in member.shapes]


def _shapes(robot: Mechanism, model: Model) -> Build:
    shapes = [shape for _, shape in _all(robot, model)]
    corners = model.at_pose(ca.horzcat(*(shape.corners for shape in shapes)))
    return [model.pose], [corners, ca.vertcat(*(shape.around for shape in shapes))]
