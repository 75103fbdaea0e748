"""The Peppermill's singularities of the first, second and third kind, after Gosselin and Angeles.

B of (47) is singular where a limb is straight or folded, A where a distal link is level (48). Equal pitches, which
would make A singular everywhere, are refused with the geometry.
"""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.errors import InvalidValue
from kinematics.evaluation import evaluate
from kinematics.model import Build, Model
from kinematics.robots.peppermill import limbs
from kinematics.robots.peppermill.peppermill import Peppermill

_CLOSED = 1e-9  # of a link's length: joints further than this from the closure do not belong to the pose


class Links(NamedTuple):
    """Directions and singular factors of both limbs at a pose; the axis of length 2 is that of the limbs.

    Attributes:
        proximal: u_i (..., 2, 3) in the base frame; (5).
        distal: v_i (..., 2, 3) in the base frame; (7), (27).
        first: (..., 2) v_i . u_theta_i = sin lambda_i, the last entries of B (47): zero where a limb is straight or
            folded, positive in the working mode.
        second: (..., 2) v_iz, the factors of det A (48): zero where a distal link is level, (+, -) in the working mode.
    """

    proximal: Array
    distal: Array
    first: Array
    second: Array


class SingularityKinds(NamedTuple):
    """(...,) booleans: B is singular (4.2), A is singular (4.3), both are (4.4)."""

    first: Array
    second: Array
    third: Array


def links(robot: Peppermill, pose: Array, joints: Array | None = None) -> Links:
    """Directions and singular factors at poses (..., 4), in the working mode unless `joints` (..., 4) say.

    NaN rows where a limb cannot reach.

    Raises:
        InvalidValue: the joints do not close the loop at the pose.
    """
    joints = robot.inverse(pose) if joints is None else np.asarray(joints, dtype=float)
    pose = np.asarray(pose, dtype=float)
    residual = np.abs(robot.closure_residual(pose, joints))
    gap = residual.max(initial=0.0, where=~np.isnan(residual))
    if gap > _CLOSED * max(robot.geometry.distal_lengths):
        raise InvalidValue("joints", f"a loop open by {gap:.3g} m", "joints that close the loop at the pose")
    lead = np.broadcast_shapes(pose.shape[:-1], joints.shape[:-1])
    both = [np.broadcast_to(a, (*lead, 4)) for a in (pose, joints)]
    return Links(*evaluate(robot.program(_links), *both))


def singularity_kinds(
    robot: Peppermill, pose: Array, joints: Array | None = None, *, tolerance: float = 1e-6
) -> SingularityKinds:
    """Which kinds hold at poses (..., 4) to within a tolerance on the factors of `Links`.

    Straight limbs are met only to the square root of a rounding, so the tolerance should not be below 1e-7.

    Raises:
        UnreachablePose: without joints, where a limb cannot reach.
        InvalidValue: the joints do not close the loop at the pose, or hold a NaN.
    """
    if joints is None:
        robot.require_reachable(pose)
    found = links(robot, pose, joints)
    if np.isnan(found.first).any():
        raise InvalidValue("joints or pose", "NaN", "finite numbers")
    first, second = ((np.abs(factor) <= tolerance).any(axis=-1) for factor in (found.first, found.second))
    return SingularityKinds(first, second, first & second)


def _links(_: Peppermill, model: Model) -> Build:
    theta, link = model.joints[2:], limbs.distal(model.pose, model.joints, model.g)
    u = limbs.Plane(ca.cos(theta), ca.sin(theta))
    v = limbs.Plane(link.along_x / model.g.distal_lengths, link.along_y / model.g.distal_lengths)
    first = u.along_x * v.along_y - u.along_y * v.along_x
    proximal, distal = limbs.in_space(u), limbs.in_space(v)
    return [model.pose, model.joints], [proximal.T, distal.T, first, distal[2, :].T]
