"""The largest errors of the pose at arrays of poses; with more encoders than freedoms by two methods."""

from __future__ import annotations

from itertools import combinations, product
from typing import Literal

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.errors import InvalidValue
from kinematics.evaluation import evaluate
from kinematics.margins.accuracy import ErrorModel
from kinematics.model import Build, Mechanism, Model

Method = Literal["least_squares", "minimum_norm"]
_ROUNDING = 1e-9  # of an error: by how much a corner may be beyond a face that it is on


def largest_errors(robot: Mechanism, pose: Array, method: Method = "least_squares") -> tuple[Array, Array]:
    """(..., n) -> (...,) the largest position error [m] and (...,) the largest angle error [rad], to first order.

    With as many encoders as freedoms both methods give the same. With more encoders, each error t of the pose has many
    causes e with J^+ e = t.

    Args:
        robot: its drives decide the errors, see `DriveTrain.position_errors`.
        pose: where.
        method: `least_squares`: of the best fit to all encoders, with any errors of them; the margins. `minimum_norm`:
            only causes of least norm, e = J t. These are the errors that agree with each other. They leave no
            residual, so no check of the encoders can see them: they remain if encoders that disagree are put right.

    Raises:
        InvalidValue: the method is unknown, or drives couple the joints, so that errors are not of one actuator each.
    """
    if method not in ("least_squares", "minimum_norm"):
        raise InvalidValue("method", method, "least_squares or minimum_norm")
    if method == "least_squares" or len(robot.joint_names) == len(robot.pose_names):
        position = robot.margin("position_accuracy", pose)
        return position, robot.margin("angle_accuracy", pose) if robot.rotations else np.zeros_like(position)
    if not robot.model().drives.is_eye():
        raise InvalidValue(f"{type(robot).__name__} drives", "coupled joints", "one joint for each actuator")
    jacobian, errors = evaluate(robot.program(_matrices), pose, blank=True)
    corners = _corners(jacobian, errors)
    turns = list(robot.rotations)
    lengths = [k for k in range(jacobian.shape[-1]) if k not in turns]
    position, angle = (np.linalg.norm(corners[..., chosen], axis=-1).max(axis=-1) for chosen in (lengths, turns))
    return position, angle


def _matrices(robot: Mechanism, model: Model) -> Build:
    """The actuators' Jacobian and, of each actuator, the largest error."""
    error_model = ErrorModel.of(robot)
    return [model.pose], [error_model.matrix, ca.sum2(error_model.errors)]


def _corners(jacobian: Array, errors: Array) -> Array:
    """(..., c, n) points t with |J t| <= E, among them all corners of this polytope; 0 in place of those outside.

    At a corner n of the m rows are at their bounds.

    Args:
        jacobian: (..., m, n).
        errors: (..., m) E.
    """
    m, n = jacobian.shape[-2:]
    signs, found = np.array(list(product((1.0, -1.0), repeat=n - 1))), []
    signs = np.column_stack([np.ones(len(signs)), signs])  # the opposite corners are as large
    for rows in combinations(range(m), n):
        chosen = jacobian[..., rows, :]
        regular = np.abs(np.linalg.det(chosen)) > 0.0
        inverse = np.linalg.inv(np.where(regular[..., None, None], chosen, np.eye(n)))
        points = (signs * errors[..., None, rows]) @ np.swapaxes(inverse, -1, -2)
        kept = np.abs(points @ np.swapaxes(jacobian, -1, -2)) <= errors[..., None, :] * (1.0 + _ROUNDING)
        inside = kept.all(axis=-1) & regular[..., None] | np.isnan(points).any(axis=-1)
        found.append(np.where(inside[..., None], points, 0.0))
    return np.concatenate(found, axis=-2)
