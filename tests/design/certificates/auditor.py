"""An independent look at a certificate: its boxes in arbitrary precision, apart from the program that proved them."""

from __future__ import annotations

import casadi as ca
import numpy as np

from design import Certificate
from design.certificates.box_tree import PROVED, leaves, root
from design.certificates.symmetry import one_side
from design.claims import to_show
from kinematics import Array, ClaimSymbols, Mechanism
from kinematics.evaluation.program import Program, run_through
from tests.arb import OPERATIONS, arb, ball


class Auditor:
    """Bounds the claims and the margin itself over boxes, pose by pose, with balls."""

    def __init__(self, certificate: Certificate, robot: Mechanism) -> None:
        c, model, claim = certificate, robot.model(), ClaimSymbols.fresh()
        self.names, self.robot, self.certificate = robot.pose_names, robot, c
        middle = c.region.from_unit(np.full(c.region.dimension, 0.5), self.names)
        claims = to_show(c.statement(robot), claim, middle)
        symbols = [model.pose, ca.vec(claims.scaling), model.geometry, claim.vector]
        gradient = ca.jacobian(claims.expressions, model.pose)
        self._claims = _program(symbols, claims.expressions)
        self._gradient = _program(symbols, gradient)
        components = robot.margin_components(c.margin, c.bounds, c.characteristic_length)
        self._margin = _program([model.pose, model.geometry], components)
        least, most = root(c.region, self.names)
        self._extent = np.where(most > least, most - least, 1.0)[0]
        self._fixed = [arb(v) for v in robot.geometry.vector()]
        self._numbers = c.statement(robot).numbers
        self._count = claims.expressions.numel()
        self._matrix, self._chosen = claims.matrix, claims.chosen
        if claims.matrix is not None:
            self._at = ca.Function("matrix", [model.pose, model.geometry, claim.vector], [claims.matrix])

    def boxes(self, rng: np.random.Generator, count: int) -> list[tuple[Array, Array]]:
        """Some of the proved boxes at random."""
        found = [
            np.stack([low[code == PROVED], high[code == PROVED]], axis=1)
            for code, low, high in leaves(self.certificate.codes, *self._root())
        ]
        table = np.concatenate(found)
        chosen = rng.choice(len(table), size=min(count, len(table)), replace=False)
        return [(box[0], box[1]) for box in table[chosen]]

    def _root(self) -> tuple[Array, Array]:
        c = self.certificate
        return one_side(*root(c.region, self.names), c.mirrors, self.names)

    def holds_at(self, pose: Array) -> bool:
        """Whether every component of the margin, as the mechanism defines it, reaches the bound at a pose."""
        values = run_through(self._margin, [*(arb(float(v)) for v in pose), *self._fixed], OPERATIONS)
        return all(bool(arb(v) >= self.certificate.bound.value) for v in values)

    def proves(self, low: Array, high: Array, depth: int = 24) -> bool:
        """Whether the claims hold on a box by the mean-value form in balls, cut further where balls are too round."""
        middle = 0.5 * (low + high)
        scaling = self._scaling(middle)
        tail = [*scaling, *self._fixed, *map(arb, self._numbers)]
        whole = [ball(a, b) for a, b in zip(low, high, strict=True)]
        values = run_through(self._claims, [*(arb(float(v)) for v in middle), *tail], OPERATIONS)
        natural = run_through(self._claims, [*whole, *tail], OPERATIONS)
        slopes = run_through(self._gradient, [*whole, *tail], OPERATIONS)
        n = len(middle)
        if all(
            bool(arb(natural[c]) >= 0)
            or (
                arb(natural[c]).is_finite()
                and bool(values[c] + sum(slopes[c * n + k] * (whole[k] - arb(float(middle[k]))) for k in range(n)) >= 0)
            )
            for c in range(self._count)
        ):
            return True
        if depth == 0:
            return False
        axis = self._axis(low, high, slopes)
        lower, upper = high.copy(), low.copy()
        lower[axis] = upper[axis] = middle[axis]
        return self.proves(low, lower, depth - 1) and self.proves(upper, high, depth - 1)

    def _axis(self, low: Array, high: Array, slopes: list[arb]) -> int:
        """The coordinate that moves a claim the most, or that of the widest side where this is not known."""
        sizes = np.array([float(abs(arb(v)).upper()) for v in slopes]).reshape(self._count, -1)
        moves = (sizes * (high - low)).max(axis=0)
        return int((moves if np.isfinite(moves).all() else (high - low) / self._extent).argmax())

    def _scaling(self, middle: Array) -> list[arb]:
        if self._matrix is None:
            return []
        matrix = np.array(self._at(middle, self.robot.geometry.vector(), self._numbers))
        return [arb(float(v)) for v in self._chosen(matrix[None])[0].T.ravel()]


def _program(symbols: list[ca.SX], output: ca.SX) -> Program:
    return Program.of(ca.Function("audit", symbols, ca.cse([ca.densify(output)])))
