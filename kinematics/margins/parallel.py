"""The margin of J_x: how far the platform is from its parallel singularities."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics import determinant, volume
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow

_POSITIVE = 1e-250  # a number of at least this is surely above 0


class DeterminantOfJx(Margin):
    """|det J_x| over its scale, in [0, 1]; the volume sqrt(det J_x^T J_x) with more joints than freedoms."""

    name = "det_J_x"
    words = "how far the platform is from a parallel singularity: 0 on it, 1 at most"
    holds_on_paths = True
    of_jacobians = True
    singularity = "parallel"

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One."""
        model = robot.model()
        j_x, scale = model.j_x_at_pose, robot.scales(model.g)[1]
        if j_x.shape[0] == j_x.shape[1]:
            return ca.fabs(determinant(j_x) / scale)
        return volume(j_x) / scale

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """With J_x = diag(1 / k) K, k > 0, and any square S: s det(K S) - c prod(k) |det S| >= 0.

        det S is not 0 and s its sign; S is near K^-1 in the middle of the box, which makes K S nearly the identity.
        The volume is at least c > 0: the sum of the squared minors less c^2.
        """
        if not positive:
            return super().to_show(robot, claim, inside, positive)
        model = robot.model()
        scale = robot.scales(model.g)[1]
        if len(robot.joint_names) != len(robot.pose_names):
            square = volume(model.j_x_at_pose) ** 2 - (claim.bound * scale) ** 2
            return ToShow(ca.vertcat(square, scale - _POSITIVE), ca.SX(0, 0))
        matrix, factors = robot.cleared_j_x()
        n = matrix.shape[0]
        scaling = ca.SX.sym("scaling", n, n)
        at = ca.Function("matrix", [model.pose, model.geometry], [matrix])(inside, robot.geometry.vector())
        sign = -1.0 if np.linalg.det(np.nan_to_num(np.array(at))) < 0.0 else 1.0
        size, product = sign * determinant(scaling), ca.SX(1)
        for i in range(n):
            product *= factors[i]
        row = determinant(matrix @ scaling) - claim.bound * scale * product * size
        return ToShow(ca.vertcat(row, ca.vertcat(size, factors, scale) - _POSITIVE), scaling, matrix)


DET_J_X = DeterminantOfJx()
