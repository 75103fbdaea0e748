"""Force capability: the largest force in every direction, over all shares of the actuators' efforts."""

from __future__ import annotations

from itertools import combinations

import casadi as ca

from kinematics.arrays import Array
from kinematics.margins.isotropic import F_W
from kinematics.mathematics import Minors
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow


class ForceCapability(Margin):
    """For unit effort of the actuators; f_w with as many joints as freedoms, more where joints are redundant.

    It is the radius of the largest ball in the zonotope of forces J_mw^T tau, |tau_i| <= 1.
    """

    name = "force_capability"
    unit = "N for unit joint effort"
    words = "largest force in every direction for unit joint effort"
    of_jacobians = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:
        """Distances from the origin to the zonotope's facets; infinite where the rows span none."""
        distances = []
        for others, normal in _facets(robot.homogeneous_jacobian(measure.length)):
            size = ca.norm_2(normal)
            distances.append(ca.if_else(size <= 0, ca.inf, ca.sum1(ca.fabs(others)) / size))
        return ca.vertcat(*distances)

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """As for f_w, which it is with as many joints as freedoms. Else, of each facet, sum_i |j_i . u| - c |u| >= 0.

        With J S in place of J, near orthonormal in the middle of a box, the normal is S u.
        """
        if not positive:
            return super().to_show(robot, claim, inside, positive)
        if len(robot.joint_names) == len(robot.pose_names):
            return F_W.to_show(robot, claim, inside, positive)
        matrix = robot.homogeneous_jacobian(claim.measure.length)
        scaling = ca.SX.sym("scaling", matrix.shape[1], matrix.shape[1])
        rows = [
            ca.sum1(ca.fabs(others)) - claim.bound * ca.norm_2(scaling @ normal)
            for others, normal in _facets(matrix @ scaling)
        ]
        return ToShow(ca.vertcat(*rows), scaling, matrix)


def _facets(matrix: ca.SX) -> list[tuple[ca.SX, ca.SX]]:
    """The other rows' products with the normal, and the normal (n,), of each facet of the zonotope of a matrix (m, n).

    A facet is parallel to n - 1 of the rows; its normal is their generalised cross product.
    """
    m, n = matrix.shape
    minors, found = Minors(matrix), []
    for rows in combinations(range(m), n - 1):
        columns = [tuple(c for c in range(n) if c != k) for k in range(n)]
        normal = ca.vertcat(*((-1) ** k * minors.minor(rows, columns[k]) for k in range(n)))
        found.append((matrix[[i for i in range(m) if i not in rows], :] @ normal, normal))
    return found


FORCE_CAPABILITY = ForceCapability()
