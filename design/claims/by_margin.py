"""What has to be shown for `margin >= bound`: expressions that must be at least 0, without norms and moduli.

Interval bounds of a quotient of norms are wide and those of the determinants behind it are far tighter, so each margin
is rewritten. The lemmas:

- |u| >= c for a continuous u on a connected region: s u - c >= 0 with one sign s = +-1 implies it for every c, and for
  c > 0 no other way exists. The sign is taken at the region's middle; a wrong one only fails to prove.
- det J for J = diag(1 / k) K, k > 0, and any square regular S: s det(K S) - c prod(k) |det S| >= 0 with det S not 0 and
  s its sign; S is near K^-1 in the middle of the box, which makes K S nearly the identity over it.
- The volume sqrt(det J^T J) >= c > 0: the sum of the squared minors less c^2.
- Speed i of the FVI, q'_max / (v_wl |j_i|) >= c > 0, with j_i = a_i / b_i a row of J_mw:
  q'_max^2 b_i^2 - c^2 v_wl^2 |a_i|^2 >= 0.
- Force i, tau_max / (f_wl |p_i|) >= c > 0, p_i = J_mw^+ e_i: with J = J_mw S, M = J^T J and det M > 0 it is
  p_i = S adj(M) J^T e_i / det M, so tau_max^2 det(M)^2 - c^2 f_wl^2 |S adj(M) J^T e_i|^2 >= 0. S comes from the QR
  factors in the middle of the box, so M is nearly the identity. A square J_mw = diag(1 / b) A needs no M: with
  A S in place of J, p_i = b_i S adj(A S) e_i / det(A S). Then b_i = 0 breaks speed i, as a_i = 0 would break det A.

- A passive joint's angle: `PassiveJoint.within`, sines and cosines in place of the arctangent.
- A clearance between segments is at least c where any vector w, not 0, parts them: w . (p - q) - c |w| >= 0 for the
  ends p of one and q of the other, as then all of their points are so far apart along w. The shortest line between the
  segments in the middle of the box serves as w.

That the scales are positive is claimed with the rest, and that every limb reaches (`reaching`), whatever the margin.
The FVI's own numbers and the length must be positive. S is an input of its own: any numbers are right, good ones only
make the bounds tight. So are the w.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from design.claims.reaching import reach_rows
from design.claims.scaling import near_inverse
from design.claims.statement import Statement
from kinematics import (
    Array,
    FviBounds,
    Mechanism,
    adjugate,
    determinant,
    homogeneous,
    segment_gap_symbolic,
    sides,
    volume,
)

_POSITIVE = 1e-250  # what is at least this is more than 0
_REGULAR = 1e-6  # what det M, about 1 in the middle of a box, must exceed


@dataclass(frozen=True)
class Numbers:
    """Symbols of the claim's own numbers, which the geometry's join; all are fixed before anything is evaluated."""

    bound: ca.SX
    fvi: Any  # the fields of FviBounds
    length: Any

    @classmethod
    def symbols(cls) -> Numbers:
        """Fresh ones."""
        fvi = SimpleNamespace(**{f.name: ca.SX.sym(f.name) for f in fields(FviBounds)})
        return cls(ca.SX.sym("bound"), fvi, ca.SX.sym("length"))

    @property
    def vector(self) -> ca.SX:
        """(6,) in the order of `values`."""
        f = self.fvi
        return ca.vertcat(self.bound, f.joint_speed, f.joint_effort, f.speed, f.force, self.length)

    @staticmethod
    def values(statement: Statement) -> list[float]:
        """What the symbols stand for."""
        fvi = statement.bounds
        return [statement.at_least, fvi.joint_speed, fvi.joint_effort, fvi.speed, fvi.force, statement.length]


@dataclass(frozen=True)
class Claims:
    """Expressions (c,) that must be at least 0 over the region; `scaling` holds symbols of a matrix of any numbers.

    `matrix` is what these come from, in the middle of each box, by `chosen`: (k, r, c) plain values -> (k, rows,
    columns) of `scaling`. None where no scaling stands in the expressions.
    """

    expressions: ca.SX
    scaling: ca.SX
    matrix: ca.SX | None = None
    chosen: Callable[[Array], Array] = near_inverse


def claims_of(statement: Statement, numbers: Numbers, inside: Array) -> Claims:
    """What is to be shown for a statement: its margin, and that every limb reaches.

    Args:
        numbers: symbols for the bound and what the FVI is measured with.
        inside: (n,) a pose of the region, which gives the signs.
    """
    claims = _of_margin(statement, numbers, inside)
    reach = reach_rows(statement.robot, claims.expressions)
    return replace(claims, expressions=ca.vertcat(claims.expressions, reach))


def defining_rows(statement: Statement, numbers: Numbers) -> ca.SX:
    """(k,) expressions, all at least 0 if and only if the margin, where it has a value, reaches the bound."""
    robot = statement.robot
    if statement.margin == "passive_joint":
        return robot.passive_rows(lambda joint, limits: joint.within(limits, numbers.bound))
    return robot.margin_components(statement.margin, numbers.fvi, numbers.length) - numbers.bound


def _of_margin(statement: Statement, numbers: Numbers, inside: Array) -> Claims:
    """Where the bound is not above 0 the plain components serve."""
    robot, margin, positive = statement.robot, statement.margin, statement.at_least > 0.0
    if margin == "passive_joint":
        return Claims(defining_rows(statement, numbers), ca.SX(0, 0))
    if margin == "clearance":
        return _clearance(robot, numbers)
    maker = {"det_J_x": _det_j_x, "J_q": _j_q, "det_J_q": _det_j_q, "fvi": _fvi}.get(margin)
    if maker is not None and positive:
        return maker(robot, numbers, inside)
    components = robot.margin_components(margin, numbers.fvi, numbers.length)
    parts = [part for i in range(components.numel()) for part in sides(components[i])]
    parts = [part for part in parts if not (part.is_constant() and float(part) == np.inf)]  # nothing limits these
    if positive:
        parts = [_signed(robot, p.dep(0), inside) if p.op() == ca.OP_FABS else p for p in parts]
    return Claims(ca.vertcat(*parts) - numbers.bound if parts else ca.SX(0, 1), ca.SX(0, 0))


def _signed(robot: Mechanism, expression: ca.SX, inside: Array) -> ca.SX:
    """Times the signs that it has at a pose."""
    model = robot.model()
    at = ca.Function("sign", [model.pose, model.geometry], [expression])(inside, robot.geometry.vector())
    return ca.SX(np.where(np.array(at) < 0.0, -1.0, 1.0)) * expression


def _clearance(robot: Mechanism, numbers: Numbers) -> Claims:
    pairs = robot.segment_pairs()
    gaps = ca.horzcat(*(segment_gap_symbolic(one, two) for one, two in pairs))
    w = ca.SX.sym("w", 3, len(pairs))
    rows = [ca.sumsqr(w[:, k]) - _REGULAR for k in range(len(pairs))]
    for k, (one, two) in enumerate(pairs):
        kept = numbers.bound * ca.norm_2(w[:, k])
        rows += [ca.dot(w[:, k], two[:, j] - one[:, i]) - kept for i in (0, 1) for j in (0, 1)]
    return Claims(ca.vertcat(*rows), w, gaps, _directions)


def _directions(gaps: Array) -> Array:
    """(k, 3, c) each column over its length; e_x where it has none."""
    size = np.linalg.norm(gaps, axis=1, keepdims=True)
    usable = np.isfinite(size) & (size > 1e-150)  # far above where squares underflow
    return np.where(usable, gaps / np.where(usable, size, 1.0), np.array([1.0, 0.0, 0.0])[:, None])


def _det_j_x(robot: Mechanism, numbers: Numbers, inside: Array) -> Claims:
    model = robot.model()
    scale = robot.scales(model.g)[1]
    if len(robot.joint_names) != len(robot.pose_names):
        square = volume(model.j_x_at_pose) ** 2 - (numbers.bound * scale) ** 2
        return Claims(ca.vertcat(square, scale - _POSITIVE), ca.SX(0, 0))
    matrix, factors = robot.cleared_j_x()
    n = matrix.shape[0]
    scaling = ca.SX.sym("scaling", n, n)
    at = ca.Function("matrix", [model.pose, model.geometry], [matrix])(inside, robot.geometry.vector())
    sign = -1.0 if np.linalg.det(np.nan_to_num(np.array(at))) < 0.0 else 1.0
    size, product = sign * determinant(scaling), ca.SX(1)
    for i in range(n):
        product *= factors[i]
    expression = determinant(matrix @ scaling) - numbers.bound * scale * product * size
    positive = ca.vertcat(size, factors, scale) - _POSITIVE
    return Claims(ca.vertcat(expression, positive), scaling, matrix)


def _j_q(robot: Mechanism, numbers: Numbers, inside: Array) -> Claims:
    model = robot.model()
    scale = robot.scales(model.g)[0]
    moduli = _signed(robot, model.j_q_at_pose, inside)
    return Claims(ca.vertcat(moduli - numbers.bound * scale, scale - _POSITIVE), ca.SX(0, 0))


def _det_j_q(robot: Mechanism, numbers: Numbers, inside: Array) -> Claims:
    model = robot.model()
    scale, product = robot.scales(model.g)[0], ca.SX(1)
    for i in range(model.j_q_at_pose.numel()):
        product *= model.j_q_at_pose[i] / scale[i]
    claim = _signed(robot, product, inside) - numbers.bound
    return Claims(ca.vertcat(claim, scale - _POSITIVE), ca.SX(0, 0))


def _fvi(robot: Mechanism, numbers: Numbers, inside: Array) -> Claims:  # noqa: ARG001
    model, fvi = robot.model(), numbers.fvi
    j_mw = homogeneous(model.actuator_jacobian, robot.rotations, numbers.length)
    m, n = j_mw.shape
    rows, divisors = j_mw, ca.SX.ones(m)
    if model.drives.is_eye():
        rows, divisors = homogeneous(model.j_x_at_pose, robot.rotations, numbers.length), model.j_q_at_pose
    speeds = [
        (fvi.joint_speed * divisors[i]) ** 2 - (numbers.bound * fvi.speed) ** 2 * ca.sumsqr(rows[i, :])
        for i in range(m)
    ]
    matrix, sizes = (rows, divisors) if m == n else (j_mw, ca.SX.ones(m))
    scaling = ca.SX.sym("scaling", n, n)
    scaled = matrix @ scaling
    cofactors, det = adjugate(scaled if m == n else scaled.T @ scaled)
    columns = scaling @ (cofactors if m == n else cofactors @ scaled.T)
    forces = [
        (fvi.joint_effort * det) ** 2 - (numbers.bound * fvi.force * sizes[i]) ** 2 * ca.sumsqr(columns[:, i])
        for i in range(m)
    ]
    return Claims(ca.vertcat(*speeds, *forces, det - _REGULAR), scaling, matrix)
