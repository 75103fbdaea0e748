"""Stiffness of the platform in its weakest direction: force over displacement, or moment over turn.

Each of these margins holds some freedoms of the platform and leaves the others free: those carry no load, and follow.
"""

from __future__ import annotations

from abc import abstractmethod
from functools import partial
from typing import ClassVar, NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.dynamics import stiffness_symbolic, transmission_at_pose
from kinematics.mathematics import root_inverse, row_sums, smallest_eigenvalue
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow

_SURE = 1e-9  # by what a row sum, about 1 in the middle of a box, must be above 0
_ITERATIONS = 8  # of the power method


class Pencil(NamedTuple):
    """Whose smallest x with K - x diag(0, E) singular is wanted, for K = W C^-1 W^T.

    Attributes:
        wrenches: W (f, k) on the freedoms that are not held.
        compliance: C (k, k), positive definite.
        weight: E (e, e), positive definite, of the last e freedoms. The others are free.
    """

    wrenches: ca.SX
    compliance: ca.SX
    weight: ca.SX

    def smallest(self) -> ca.SX:
        """x."""
        return smallest_eigenvalue(self.stiffness, self.weight)

    @property
    def stiffness(self) -> ca.SX:
        """K."""
        return stiffness_symbolic(self.wrenches, self.compliance)

    def whole_weight(self) -> ca.SX:
        """diag(0, E) (f, f)."""
        rest = self.wrenches.shape[0] - self.weight.shape[0]
        return ca.diagcat(ca.SX(rest, rest), self.weight)

    def balance(self, x: ca.SX) -> ca.SX:
        """(k + f, k + f) [[-C, W^T], [W, -x diag(0, E)]]: forces and motions in balance. It needs no inverse of C."""
        above = ca.horzcat(-self.compliance, self.wrenches.T)
        return ca.vertcat(above, ca.horzcat(self.wrenches, -x * self.whole_weight()))


class WeakestDirection(Margin):
    """The smallest eigenvalue of a stiffness; infinite where nothing gives way."""

    records: ClassVar[tuple[str, ...]] = ("inertia", "structure")

    @abstractmethod
    def pencil(self, robot: Mechanism) -> Pencil | None:
        """The eigenvalue problem at a pose; None if nothing gives way."""

    def eigenvalue(self, bound: ca.SX) -> ca.SX:
        """The eigenvalue for which the margin is `bound`."""
        return bound

    def of_eigenvalue(self, value: ca.SX) -> ca.SX:
        """The margin for an eigenvalue."""
        return value

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One."""
        pencil = self.pencil(robot)
        return ca.SX(np.inf) if pencil is None else self.of_eigenvalue(pencil.smallest())

    def to_refute(self, robot: Mechanism, claim: ClaimSymbols) -> ToShow:
        """v^T (K - x diag(0, E)) v >= 0 for any v, such as the weakest direction in the middle of the box."""
        pencil = self.pencil(robot)
        if pencil is None:
            return super().to_refute(robot, claim)
        x = self.eigenvalue(ca.fmax(claim.bound, 0))  # a bound below 0 holds; its square would not say so
        matrix = pencil.stiffness - x * pencil.whole_weight()
        v = ca.SX.sym("scaling", matrix.shape[0], 1)
        return ToShow(v.T @ matrix @ v, v, matrix, _weakest)

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """The matrix Q of `Pencil.balance` has as many eigenvalues below 0 as C has rows, k, and all others above.

        By Sylvester K - x diag(0, E), the Schur complement of its part -C, is then positive definite, and so is what
        the free freedoms leave of it: all eigenvalues are above x. Any regular T = [[A, G], [0, B]] makes a matrix
        P = T diag(-1, 1) T^T with k eigenvalues below 0; so has its inverse. If in D^-1 P Q D, for any diagonal D, each
        diagonal entry exceeds the sum of the moduli beside it, so it does in all means of this matrix and the identity,
        D^-1 P P^-1 D. Then none of the means of Q and P^-1 is singular, and Q has as many eigenvalues below 0 as P^-1.
        In the middle of a box P is the inverse of Q; D makes the rows alike.
        """
        pencil = self.pencil(robot) if positive else None
        if pencil is None:
            return super().to_show(robot, claim, inside, positive)
        matrix, k = pencil.balance(self.eigenvalue(claim.bound)), pencil.compliance.shape[0]
        n = matrix.shape[0]
        scaling = ca.SX.sym("scaling", n, n + 1)
        a, g, b, weight = scaling[:k, :k], scaling[:k, k:n], scaling[k:, k:n], scaling[:, n]
        inverse = ca.vertcat(ca.horzcat(g @ g.T - a @ a.T, g @ b.T), ca.horzcat(b @ g.T, b @ b.T))
        rows = row_sums(ca.diag(1 / weight) @ (inverse @ (matrix @ ca.diag(weight)))) - _SURE
        return ToShow(rows, scaling, matrix, partial(_preconditioner, k))


class _Directional(WeakestDirection):
    """Of some freedoms, each of which counts alike."""

    @abstractmethod
    def directions(self, robot: Mechanism, freedoms: int) -> tuple[list[int], list[int]]:
        """The freedoms that are free, and those whose stiffness is asked for; all others are held."""

    def pencil(self, robot: Mechanism) -> Pencil | None:
        """With the unit matrix as weight; None also if the robot has no such freedom."""
        found = transmission_at_pose(robot)
        if found is None:
            return None
        wrenches, compliance = found
        free, asked = self.directions(robot, wrenches.shape[0])
        if not asked:
            return None
        return Pencil(wrenches[free + asked, :], compliance, ca.SX.eye(len(asked)))


def _internal(robot: Mechanism, freedoms: int) -> list[int]:
    """What the pose does not have, such as tilts."""
    return list(range(len(robot.pose_names), freedoms))


class Stiffness(_Directional):
    """Of a force at the tool point, the pose's rotations held. What the pose does not have, such as tilts, is free."""

    name = "stiffness"
    unit = "N/m"
    words = "stiffness against a force at the tool point in the weakest direction, with the tool's rotation held"

    def directions(self, robot: Mechanism, freedoms: int) -> tuple[list[int], list[int]]:
        """The translations."""
        asked = [k for k in range(len(robot.pose_names)) if k not in robot.rotations]
        return _internal(robot, freedoms), asked


class RotationalStiffness(_Directional):
    """Of a moment on the tool, the tool point held. What the pose does not have, such as tilts, is free."""

    name = "rotational_stiffness"
    unit = "N m/rad"
    words = "stiffness against a moment on the tool about the weakest axis, with the tool point held"

    def directions(self, robot: Mechanism, freedoms: int) -> tuple[list[int], list[int]]:
        """The rotations of the pose."""
        return _internal(robot, freedoms), list(robot.rotations)


class InternalStiffness(_Directional):
    """Of moments that tilt the bodies that single rods hold, with the tool's pose held."""

    name = "internal_stiffness"
    unit = "N m/rad"
    words = "stiffness against tilts of the bodies that the rods hold, with the tool's pose held"

    def directions(self, robot: Mechanism, freedoms: int) -> tuple[list[int], list[int]]:
        """What the pose does not have."""
        return [], _internal(robot, freedoms)


def _preconditioner(k: int, matrices: Array) -> Array:
    """(p, n, n) Q -> (p, n, n + 1) T of `to_show` and, in a last column, D: Perron's vector of |Q^-1| |Q|.

    With this D the rows of D^-1 Q^-1 dQ D are alike for a change dQ of the same share of each entry of Q.
    """
    usable = np.isfinite(matrices).all(axis=(1, 2))
    usual = np.diag(np.where(np.arange(matrices.shape[1]) < k, -1.0, 1.0))
    matrices = np.where(usable[:, None, None], matrices, usual)
    wrenches, a = matrices[:, k:, :k], root_inverse(-matrices[:, :k, :k])
    forces = a @ (np.swapaxes(a, 1, 2) @ np.swapaxes(wrenches, 1, 2))  # C^-1 W^T
    b = root_inverse(wrenches @ forces + matrices[:, k:, k:])
    result = np.zeros((len(matrices), matrices.shape[1], matrices.shape[1] + 1))
    result[:, :k, :k], result[:, :k, k:-1], result[:, k:, k:-1] = a, forces @ b, b
    factor = result[:, :, :-1]
    inverse = np.abs(factor @ usual @ np.swapaxes(factor, 1, 2))
    weight = np.sqrt(np.einsum("pii->pi", inverse))
    for _ in range(_ITERATIONS):
        weight = (inverse @ (np.abs(matrices) @ weight[:, :, None]))[:, :, 0]
        weight /= weight.max(axis=1, keepdims=True)
    result[:, :, -1] = weight
    return result


def _weakest(matrices: Array) -> Array:
    """(k, n, n) -> (k, n, 1) unit eigenvectors of the smallest eigenvalue."""
    matrices = np.atleast_3d(matrices)  # one entry may come as (k, 1)
    usable = np.isfinite(matrices).all(axis=(1, 2))
    _, vectors = np.linalg.eigh(np.where(usable[:, None, None], matrices, np.eye(matrices.shape[1])))
    return vectors[:, :, :1]


STIFFNESS, ROTATIONAL_STIFFNESS, INTERNAL_STIFFNESS = Stiffness(), RotationalStiffness(), InternalStiffness()
