"""Check that a straight line from one pose to another passes no parallel singularity."""

from __future__ import annotations

from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.evaluation import evaluate
from kinematics.mathematics import determinant
from kinematics.model import expressions

if TYPE_CHECKING:
    from kinematics.model.mechanism import Mechanism
    from kinematics.model.symbolic_model import Model

_ON_LINE = 24  # poses on the line, its end left out, at which the side of the singularities is looked at


def joined(robot: Mechanism, starts: Array, poses: Array) -> Array:
    """(k,) whether the line from a pose (n,) or (k, n) to another (k, n) is within reach and passes no singularity.

    The last pose itself may be on one. With more joints than freedoms det J_x^T J_x is looked at, which is 0 or above.
    """
    way = poses - starts
    if not robot.counts_turns:
        turns = list(robot.rotations)
        way[:, turns] -= 2 * np.pi * np.round(way[:, turns] / (2 * np.pi))
    line = starts + np.linspace(0.0, 1.0, _ON_LINE, endpoint=False)[:, None, None] * way
    (side,) = evaluate(robot.program(expressions.within_reach, _determinant), line, blank=True)[:1]
    found: Array = (side[..., 0] * side[0, ..., 0] > 0.0).all(axis=0)
    return found


def _determinant(_: Mechanism, model: Model) -> list[ca.SX]:
    j_x = model.j_x_at_pose
    square = j_x.shape[0] == j_x.shape[1]
    return [determinant(j_x if square else j_x.T @ j_x)]
