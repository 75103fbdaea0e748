"""v_w, f_w and the FVI: worst isotropic speed and force, and both over the wanted ones; Shayya et al. (39), (40)."""

from __future__ import annotations

import operator
from functools import reduce
from typing import Any, ClassVar, NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics import adjugate
from kinematics.model import (
    ClaimSymbols,
    Margin,
    Measure,
    Mechanism,
    ToShow,
    fvi,
    fvi_components,
    homogeneous,
    isotropic,
    isotropic_components,
)

_NOT_ZERO = 1e-250  # a number of at least this is surely above 0
_REGULAR = 1e-6  # what det M, about 1 in the middle of a box, must exceed
_NEARLY = 1e-14  # keeps a singular matrix from stopping the search for good numbers


class _Isotropic(Margin):
    """One of the two radii, the smallest of what each actuator alone would allow."""

    of_jacobians = True
    place: ClassVar[int]  # in `isotropic` and `isotropic_components`

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:
        """One component for each actuator."""
        return isotropic_components(robot.homogeneous_jacobian(measure.length))[self.place]

    def worst(self, robot: Mechanism, measure: Measure) -> ca.SX:
        """With one root for all."""
        return isotropic(robot.homogeneous_jacobian(measure.length))[self.place]


class Speed(_Isotropic):
    """v_w, for unit speed of the actuators."""

    name = "v_w"
    unit = "m/s for unit joint speed"
    words = "worst isotropic speed for unit joint speed"
    place = 0

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """`_Rows.speeds` for a unit speed, and that no b_i is 0: there a_i = 0 would leave the speed undefined."""
        if not positive:
            return super().to_show(robot, claim, inside, positive)
        rows = _Rows.of(robot, claim.measure.length)
        return ToShow(ca.vertcat(*rows.speeds(1, claim.bound), rows.divisors**2 - _NOT_ZERO), ca.SX(0, 0))

    def to_refute(self, robot: Mechanism, claim: ClaimSymbols) -> ToShow:
        """`_Rows.speeds` for a unit speed."""
        least = ca.fmax(claim.bound, 0)  # what is at least 0 keeps every bound below
        return ToShow(ca.vertcat(*_Rows.of(robot, claim.measure.length).speeds(1, least)), ca.SX(0, 0))


class Force(_Isotropic):
    """f_w, for unit effort of the actuators."""

    name = "f_w"
    unit = "N for unit joint effort"
    words = "worst isotropic force for unit joint effort"
    place = 1

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """`_Rows.forces` for a unit effort. Where b_i = 0 actuator i holds any force: the others make f_w."""
        if not positive:
            return super().to_show(robot, claim, inside, positive)
        rows = _Rows.of(robot, claim.measure.length)
        return ToShow(ca.vertcat(*rows.forces(1, claim.bound)), rows.scaling, rows.matrix)

    def to_refute(self, robot: Mechanism, claim: ClaimSymbols) -> ToShow:
        """`_Rows.forces_with_witness` for a unit effort."""
        rows = _Rows.of(robot, claim.measure.length)
        found, witness = rows.forces_with_witness(1, ca.fmax(claim.bound, 0))
        return ToShow(ca.vertcat(*found), witness, rows.matrix, _witnesses)


class Fvi(Margin):
    """min(v_w / v_wl, f_w / f_wl)."""

    name = "fvi"
    words = "the smaller of worst isotropic speed and force, each over the wanted one"
    of_jacobians = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:
        """Speeds over v_wl, then forces over f_wl, one an actuator each."""
        return fvi_components(robot.homogeneous_jacobian(measure.length), measure.fvi)

    def worst(self, robot: Mechanism, measure: Measure) -> ca.SX:
        """With one root for all speeds and one for all forces."""
        return fvi(robot.homogeneous_jacobian(measure.length), measure.fvi)

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """`_Rows.speeds` and `_Rows.forces`: b_i = 0 breaks speed i, as a_i = 0 would break det A."""
        if not positive:
            return super().to_show(robot, claim, inside, positive)
        given, rows = claim.measure.fvi, _Rows.of(robot, claim.measure.length)
        speeds = rows.speeds(given.joint_speed, claim.bound * given.speed)
        forces = rows.forces(given.joint_effort, claim.bound * given.force)
        return ToShow(ca.vertcat(*speeds, *forces), rows.scaling, rows.matrix)

    def to_refute(self, robot: Mechanism, claim: ClaimSymbols) -> ToShow:
        """`_Rows.speeds` and `_Rows.forces_with_witness`."""
        given, rows, least = claim.measure.fvi, _Rows.of(robot, claim.measure.length), ca.fmax(claim.bound, 0)
        speeds = rows.speeds(given.joint_speed, least * given.speed)
        forces, witness = rows.forces_with_witness(given.joint_effort, least * given.force)
        return ToShow(ca.vertcat(*speeds, *forces), witness, rows.matrix, _witnesses)


class _Rows(NamedTuple):
    """What shows isotropic speeds and forces, without quotients.

    With J_mw = diag(1 / b) A. Of a joint, b is J_q times what `cleared_j_x` divides by; of an actuator that couples
    joints, the product of theirs.

    Attributes:
        rows, divisors: A and b.
        matrix, sizes: what the forces come from: A and b of a square J_mw, else J_mw and 1.
        scaling: symbols of S.
    """

    rows: ca.SX
    divisors: ca.SX
    matrix: ca.SX
    sizes: ca.SX
    scaling: ca.SX

    @classmethod
    def of(cls, robot: Mechanism, length: Any) -> _Rows:
        model = robot.model()
        j_mw = robot.homogeneous_jacobian(length)
        m, n = j_mw.shape
        cleared, factors = robot.cleared_j_x()
        rows, divisors = _coupled(
            model.drives, homogeneous(cleared, robot.rotations, length), factors * model.j_q_at_pose
        )
        matrix, sizes = (rows, divisors) if m == n else (j_mw, ca.SX.ones(m))
        return cls(rows, divisors, matrix, sizes, ca.SX.sym("scaling", n, n))

    def speeds(self, most: Any, least: ca.SX) -> list[ca.SX]:
        """Speed i, q'_max / |j_i| >= c > 0 with j_i = a_i / b_i: q'_max^2 b_i^2 - c^2 |a_i|^2 >= 0."""
        count = self.rows.shape[0]
        return [(most * self.divisors[i]) ** 2 - least**2 * ca.sumsqr(self.rows[i, :]) for i in range(count)]

    def forces(self, most: Any, least: ca.SX) -> list[ca.SX]:
        """Force i, tau_max / |p_i| >= c > 0 with p_i = J_mw^+ e_i.

        With J = J_mw S, M = J^T J and det M > 0 it is p_i = S adj(M) J^T e_i / det M, so
        tau_max^2 det(M)^2 - c^2 |S adj(M) J^T e_i|^2 >= 0. S comes from the QR factors in the middle of the box, so M
        is nearly the identity. A square J_mw needs no M: with A S in place of J, p_i = b_i S adj(A S) e_i / det(A S).
        """
        scaled = self.matrix @ self.scaling
        count, square = scaled.shape[0], scaled.shape[0] == scaled.shape[1]
        cofactors, det = adjugate(scaled if square else scaled.T @ scaled)
        columns = self.scaling @ (cofactors if square else cofactors @ scaled.T)
        forces = [(most * det) ** 2 - (least * self.sizes[i]) ** 2 * ca.sumsqr(columns[:, i]) for i in range(count)]
        return [*forces, det - _REGULAR]

    def forces_with_witness(self, most: Any, least: ca.SX) -> tuple[list[ca.SX], ca.SX]:
        """Where force i, tau_max / |p_i|, is at least c: rows at least 0 for any numbers of the second result.

        A square J_mw = diag(1 / b) A has A p_i = b_i e_i, so mu_i b_i = (A^T mu) . p_i <= |A^T mu| |p_i| for each mu,
        and tau_max^2 |A^T mu|^2 - c^2 (mu_i b_i)^2 >= 0. With more joints than freedoms M p_i = J^T e_i, M = J^T J, so
        (J mu)_i = (M mu) . p_i in the same way. Equality holds where A^T mu, or M mu, is along p_i: `_witnesses`.
        """
        a, count, square = self.matrix, self.matrix.shape[0], self.matrix.shape[0] == self.matrix.shape[1]
        witness = ca.SX.sym("witness", a.shape[1], count)
        across, along = (a.T @ witness, witness) if square else (a.T @ (a @ witness), a @ witness)
        rows = [most**2 * ca.sumsqr(across[:, i]) - (least * self.sizes[i] * along[i, i]) ** 2 for i in range(count)]
        return rows, witness


def _coupled(drives: ca.SX, rows: ca.SX, divisors: ca.SX) -> tuple[ca.SX, ca.SX]:
    """A and b of C diag(1 / b) A, without a quotient: each row times the divisors of the joints that it couples."""
    found, products = [], []
    for i in range(drives.shape[0]):
        joints = [k for k in range(drives.shape[1]) if not drives[i, k].is_zero()]
        others = [_product([divisors[j] for j in joints if j != k]) for k in joints]
        parts = [drives[i, k] * other * rows[k, :] for k, other in zip(joints, others, strict=True)]
        found.append(reduce(operator.add, parts))
        products.append(_product([divisors[k] for k in joints]))
    return ca.vertcat(*found), ca.vertcat(*products)


def _product(factors: list[ca.SX]) -> ca.SX:
    return reduce(operator.mul, factors, ca.SX(1))


def _witnesses(values: Array) -> Array:
    """(k, m, n) A, or J of more rows than columns -> (k, n, m) the best mu for each force, the largest entry 1."""
    m, n = values.shape[1:]
    usable = np.isfinite(values).all(axis=(1, 2), keepdims=True)
    a = np.where(usable, values, np.eye(m, n))
    a = a / np.maximum(np.abs(a).max(axis=(1, 2), keepdims=True), _NEARLY)
    turned = np.swapaxes(a, 1, 2)
    inverse = np.linalg.inv((a @ turned if m == n else turned @ a) + _NEARLY * np.eye(n))
    found = inverse if m == n else inverse @ inverse @ turned
    result: Array = found / np.maximum(np.abs(found).max(axis=1, keepdims=True), _NEARLY)
    return result


V_W, F_W, FVI = Speed(), Force(), Fvi()
