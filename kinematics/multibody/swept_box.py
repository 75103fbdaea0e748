"""The box that a mechanism's moving members sweep."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.evaluation import evaluate
from kinematics.model import Build, Mechanism, Model


def swept_box(robot: Mechanism, poses: Array) -> Array:
    """(k, n) poses -> (2, 3) the least and the largest coordinates of what moves at those within reach [m]."""
    low, high = evaluate(robot.program(_box), poses)
    return np.stack([np.nanmin(low, axis=0), np.nanmax(high, axis=0)])


def _box(robot: Mechanism, model: Model) -> Build:
    """(3,) of all members at a pose."""
    low, high = [], []
    for member in robot.all_members(model.pose, model.joints, model.g):
        for shape in () if "base" in member.joints else member.shapes:
            low.append(shape.corners - shape.around)
            high.append(shape.corners + shape.around)
    least, most = (model.at_pose(ca.horzcat(*corners)) for corners in (low, high))
    return [model.pose], [
        ca.vertcat(*(ca.mmin(least[k, :]) for k in range(3))),
        ca.vertcat(*(ca.mmax(most[k, :]) for k in range(3))),
    ]
