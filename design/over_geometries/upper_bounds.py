"""Rigorous upper bounds of the necessary rows over boxes of geometries, at given poses, by affine arithmetic."""

from __future__ import annotations

import casadi as ca
import numpy as np

from design.over_geometries.design_box import DesignBox
from design.over_geometries.necessary_rows import NecessaryRows
from design.synthesis import Problem
from kinematics import AffineForms, Array, BoxProgram, Program, affine_forms, bulk, evaluate


class UpperBounds:
    """The rows at one pose, or the sums, as a program over boxes of geometries.

    Attributes:
        count: the number of rows.
        leads: whether the rows say which variable to cut. Sums do not: a box at their limit would be cut for ever.
    """

    def __init__(self, problem: Problem, necessary: NecessaryRows, box: DesignBox, pose: Array | None) -> None:
        """Build the program; that of the sums if there is no pose."""
        model = problem.robot.model()
        self.leads, self._moving = pose is not None, np.arange(len(box.names))
        fixed = [*box.numbers, *(model.pose.numel() * [0.0] if pose is None else pose.tolist()), *necessary.numbers]
        given = [box.fixed, model.pose, *necessary.claims]
        rows = ca.substitute(necessary.sums if pose is None else necessary.rows, model.geometry, box.geometry)
        self.count = rows.numel()
        function = ca.Function("rows", [box.symbols, necessary.scaling, *given], [ca.cse(ca.densify(rows))])
        self._program = BoxProgram.of(Program.of(function), fixed)
        self._scaled = []
        for shown in necessary.shown:
            if shown.matrix is not None:
                matrix = ca.substitute(shown.matrix, model.geometry, box.geometry)
                matrix = ca.substitute(matrix, ca.vertcat(*given), ca.SX(fixed))
                self._scaled.append((bulk(ca.Function("matrix", [box.symbols], [ca.densify(matrix)])), shown))

    def over(self, low: Array, high: Array) -> AffineForms:
        """Bounds over boxes (n, k)."""
        scaling = self._scaling(np.clip(0.5 * low + 0.5 * high, low, high))
        return affine_forms(self._program, np.hstack([low, scaling]), np.hstack([high, scaling]), self._moving)

    def _scaling(self, middle: Array) -> Array:
        """(n, s) the numbers of the scaling in the middle of boxes (n, k)."""
        parts = [np.empty((len(middle), 0))]
        for matrix, shown in self._scaled:
            (values,) = evaluate(matrix, middle)
            parts.append(np.swapaxes(shown.chosen(values), -1, -2).reshape(len(middle), shown.scaling.numel()))
        return np.hstack(parts)
