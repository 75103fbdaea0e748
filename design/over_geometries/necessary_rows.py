"""What a geometry must keep at one pose if it keeps the requirements there and its objective reaches a target.

These rows are expressions that are at least 0 for every such geometry (`Margin.to_refute`). A geometry that breaks one
of them does not reach the target over any region with this pose.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from design.synthesis import Problem
from kinematics import ClaimSymbols, Op, Program, ToShow, run_through


@dataclass(frozen=True)
class NecessaryRows:
    """Rows in the symbols of the model, with the numbers that they take.

    Attributes:
        rows: (c,) expressions in pose and geometry.
        sums: (d,) expressions in the geometry alone: what the limits of sums leave.
        shown: of the objective and of each requirement, with the symbols of their scaling.
        claims: their claims' symbols, (6,) each.
        numbers: the values of all of these.
    """

    rows: ca.SX
    sums: ca.SX
    shown: tuple[ToShow, ...]
    claims: tuple[ca.SX, ...]
    numbers: tuple[float, ...]

    @property
    def scaling(self) -> ca.SX:
        """(s,) all symbols of scaling, column by column."""
        return ca.vertcat(*(ca.vec(shown.scaling) for shown in self.shown))


def necessary_rows(problem: Problem, target: float, requirements: tuple[str, ...]) -> NecessaryRows:
    """The rows at a pose: the objective's, those of some requirements, and every limb's reach; and the sums.

    Args:
        target: what the objective would have to reach.
        requirements: the margins whose requirements count.
    """
    robot, wanted = problem.robot, [(problem.objective, target)]
    wanted += [(r.margin, r.bound.value) for r in problem.requirements if r.margin in requirements]
    shown, claims, numbers = [], [], []
    for margin, bound in wanted:
        claim = ClaimSymbols.fresh()
        shown.append(robot.margins[margin].to_refute(robot, claim))
        claims.append(claim.vector)
        numbers += ClaimSymbols.values(bound, problem.fvi_bounds, problem.characteristic_length)
    model = robot.model()
    rows = ca.vertcat(*(s.expressions for s in shown), robot.reach(model.pose, model.g))
    scaling = [ca.vec(s.scaling) for s in shown]
    rows = _roots_without_gaps(rows, [model.geometry, model.pose, *scaling, *claims])
    sums = [
        limit.at_most - sum((model.geometry[place] for place in places), ca.SX(0))
        for limit in problem.sums
        for places in problem.summed(limit)
    ]
    return NecessaryRows(rows, ca.vertcat(*sums, ca.SX(0, 1)), tuple(shown), tuple(claims), tuple(numbers))


def _roots_without_gaps(rows: ca.SX, symbols: list[ca.SX]) -> ca.SX:
    """The rows with 0 in place of a negative number under a root: the same wherever they have a value.

    A box of geometries of which some do not reach then has bounds too, and they hold for those that do.
    """
    program = Program.of(ca.Function("rows", symbols, [ca.densify(rows)]))
    numbers = [symbol[k] for symbol in symbols for k in range(symbol.numel())]
    found = run_through(program, numbers, {Op.SQRT: lambda a, _: ca.sqrt(ca.fmax(a, 0))})
    return ca.vertcat(*(ca.SX(row) for row in found))
