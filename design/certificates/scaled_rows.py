"""Programs of a statement's expressions with all numbers filled in, and the scaling at each pose."""

from __future__ import annotations

import casadi as ca
import numpy as np

from design.claims import Statement
from kinematics import Array, BoxProgram, ClaimSymbols, Program, ToShow, bulk, evaluate


class ScaledRows:
    """Makes programs of pose and scaling from expressions in the symbols of a model and a claim.

    Attributes:
        symbols: pose, scaling, geometry, the claim's numbers. The last two have fixed values.
    """

    def __init__(self, statement: Statement, claim: ClaimSymbols, shown: ToShow) -> None:
        model = statement.robot.model()
        self.symbols = [model.pose, ca.vec(shown.scaling), model.geometry, claim.vector]
        self._fixed = [*statement.robot.geometry.vector(), *statement.numbers]
        self._chosen, self._size, self._matrix = shown.chosen, shown.scaling.numel(), None
        if shown.matrix is not None:
            given = ca.vertcat(model.geometry, claim.vector)
            matrix = ca.substitute(shown.matrix, given, ca.SX(self._fixed))
            self._matrix = bulk(ca.Function("matrix", [model.pose], [ca.densify(matrix)]))

    def program(self, *outputs: ca.SX) -> BoxProgram:
        """A program over boxes of poses; it also takes the numbers of `scaling`."""
        function = ca.Function("rows", self.symbols, ca.cse([ca.densify(o) for o in outputs]))
        return BoxProgram.of(Program.of(function), self._fixed)

    def scaling(self, poses: Array) -> Array:
        """(k, size) the numbers of the scaling at poses (k, n), column by column."""
        if self._matrix is None:
            return np.empty((len(poses), 0))
        (values,) = evaluate(self._matrix, poses)
        return np.swapaxes(self._chosen(values), -1, -2).reshape(len(poses), self._size)
