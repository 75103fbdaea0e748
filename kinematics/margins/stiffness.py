"""Stiffness of the platform in its weakest direction: force over displacement, or moment over turn.

Each of these margins holds some freedoms of the platform and leaves the others free: those carry no load, and follow.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.dynamics import stiffness_parts, sum_of
from kinematics.mathematics import root_inverse, row_sums, smallest_eigenvalue
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow

_SURE = 1e-9  # by what a row sum, about 1 in the middle of a box, must be above 0


class Pencil(NamedTuple):
    """Whose smallest x with K - x diag(0, E) singular is wanted, for K the sum of W X W^T.

    Attributes:
        parts: W (f, k) and X (k, k), positive definite.
        weight: E (e, e), positive definite, of the last e freedoms. The others are free.
    """

    parts: list[tuple[ca.SX, ca.SX]]
    weight: ca.SX

    def smallest(self) -> ca.SX:
        """x."""
        return smallest_eigenvalue(sum_of(self.parts), self.weight)

    def shifted(self, x: ca.SX, scaling: ca.SX) -> ca.SX:
        """S^T (K - x diag(0, E)) S (c, c) with any S (f, c)."""
        kept = scaling[-self.weight.shape[0] :, :]
        scaled = [(scaling.T @ wrenches, inner) for wrenches, inner in self.parts]
        result: ca.SX = sum_of(scaled) - x * (kept.T @ self.weight @ kept)
        return result


class WeakestDirection(Margin):
    """The smallest eigenvalue of a stiffness; infinite where nothing gives way."""

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
        count = pencil.parts[0][0].shape[0]
        v = ca.SX.sym("scaling", count, 1)
        return ToShow(pencil.shifted(x, v), v, pencil.shifted(x, ca.SX.eye(count)), _weakest)

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """K - x diag(0, E) is positive definite, as S^T (.) S is, by Gershgorin.

        Then so is its Schur complement, what the free freedoms leave of K less x E: all eigenvalues are above x. S
        makes the matrix nearly the identity in the middle of a box.
        """
        pencil = self.pencil(robot) if positive else None
        if pencil is None:
            return super().to_show(robot, claim, inside, positive)
        x, count = self.eigenvalue(claim.bound), pencil.parts[0][0].shape[0]
        scaling = ca.SX.sym("scaling", count, count)
        rows = row_sums(pencil.shifted(x, scaling)) - _SURE
        return ToShow(rows, scaling, pencil.shifted(x, ca.SX.eye(count)), root_inverse)


class _Directional(WeakestDirection):
    """Of some freedoms, each of which counts alike."""

    @abstractmethod
    def directions(self, robot: Mechanism, freedoms: int) -> tuple[list[int], list[int]]:
        """The freedoms that are free, and those whose stiffness is asked for; all others are held."""

    def pencil(self, robot: Mechanism) -> Pencil | None:
        """With the unit matrix as weight."""
        parts = stiffness_parts(robot)
        if not parts:
            return None
        free, asked = self.directions(robot, parts[0][0].shape[0])
        return Pencil([(wrenches[free + asked, :], inner) for wrenches, inner in parts], ca.SX.eye(len(asked)))


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


def _weakest(matrices: Array) -> Array:
    """(k, n, n) -> (k, n, 1) unit eigenvectors of the smallest eigenvalue."""
    usable = np.isfinite(matrices).all(axis=(1, 2))
    _, vectors = np.linalg.eigh(np.where(usable[:, None, None], matrices, np.eye(matrices.shape[1])))
    return vectors[:, :, :1]


STIFFNESS, ROTATIONAL_STIFFNESS, INTERNAL_STIFFNESS = Stiffness(), RotationalStiffness(), InternalStiffness()
