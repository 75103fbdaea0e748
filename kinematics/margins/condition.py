"""The inverse condition number of J_mw: its smallest over its largest singular value."""

from __future__ import annotations

from functools import reduce

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics import root_inverse, row_sums, singular_values
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow

_SURE = 1e-9  # by what a row sum, about 1 in the middle of a box, must be above 0


class InverseConditionNumber(Margin):
    """In [0, 1]: 0 on a singularity, 1 where the robot is isotropic. By the 2-norm, at the actuators."""

    name = "inverse_condition_number"
    words = "inverse condition number of the homogeneous Jacobian"
    of_jacobians = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:
        """Each singular value over the largest."""
        values = singular_values(robot.homogeneous_jacobian(measure.length))
        return values / reduce(ca.fmax, ca.vertsplit(values))

    def to_refute(self, robot: Mechanism, claim: ClaimSymbols) -> ToShow:
        """With M = J_mw^T J_mw and any v and w: |J_mw v|^2 |w|^2 - c^2 |J_mw w|^2 |v|^2 >= 0, and c <= 1.

        The eigenvectors of M's smallest and largest eigenvalue at the pose serve as v and w.
        """
        j_mw = robot.homogeneous_jacobian(claim.measure.length)
        both = ca.SX.sym("scaling", j_mw.shape[1], 2)
        v, w = both[:, 0], both[:, 1]
        least, most = ca.sumsqr(j_mw @ v) * ca.sumsqr(w), ca.sumsqr(j_mw @ w) * ca.sumsqr(v)
        # A bound of 0 or below holds; its square would not say so.
        row = least - ca.fmax(claim.bound, 0) ** 2 * most
        return ToShow(ca.vertcat(row, 1 - claim.bound), both, j_mw.T @ j_mw, _extremes)

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """With M = J_mw^T J_mw and any mu: M - c^2 mu and mu - M are positive definite.

        Then all eigenvalues of M lie between c^2 mu and mu. A matrix is positive definite if S^T (.) S is, with any S;
        and that is, by Gershgorin, where the sum of each row, the moduli beside the diagonal negative, is above 0. S
        makes both nearly the identity in the middle of a box, and mu there is the mean of the bounds that M leaves it.
        """
        if not positive:
            return super().to_show(robot, claim, inside, positive)
        j_mw = robot.homogeneous_jacobian(claim.measure.length)
        n = j_mw.shape[1]
        scaling = ca.SX.sym("scaling", n, 2 * n + 1)
        below, above, mu = scaling[:, :n], scaling[:, n : 2 * n], scaling[0, 2 * n]
        first, second = j_mw @ below, j_mw @ above
        rows = [
            row_sums(first.T @ first - claim.bound**2 * mu * below.T @ below) - _SURE,
            row_sums(mu * above.T @ above - second.T @ second) - _SURE,
        ]
        with_bound = ca.horzcat(j_mw.T @ j_mw, ca.repmat(claim.bound, n, 1))
        return ToShow(ca.vertcat(*rows), scaling, with_bound, _chosen)


def _chosen(values: Array) -> Array:
    """(k, n, n + 1) M and, in a last column, the bound -> (k, n, 2 n + 1) both S and, in a last column, mu."""
    gram, bound = values[:, :, :-1], values[:, 0, -1]
    usable = np.isfinite(gram).all(axis=(1, 2))
    eigenvalues = np.linalg.eigvalsh(np.where(usable[:, None, None], gram, np.eye(gram.shape[1])))
    smallest, largest = eigenvalues[:, 0], eigenvalues[:, -1]
    mu = np.sqrt(np.maximum(smallest, 0.0) / bound**2 * largest)[:, None, None]
    eye = np.eye(gram.shape[1])
    both = [root_inverse(gram - (bound**2)[:, None, None] * mu * eye), root_inverse(mu * eye - gram)]
    column = np.zeros((*gram.shape[:2], 1))
    column[:, :1] = mu
    return np.concatenate([*both, column], axis=2)


def _extremes(gram: Array) -> Array:
    """(k, n, n) -> (k, n, 2) unit eigenvectors of the smallest and the largest eigenvalue."""
    usable = np.isfinite(gram).all(axis=(1, 2))
    _, vectors = np.linalg.eigh(np.where(usable[:, None, None], gram, np.eye(gram.shape[1])))
    return vectors[:, :, [0, -1]]


INVERSE_CONDITION_NUMBER = InverseConditionNumber()
