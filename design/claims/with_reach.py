"""The claims of a statement: those of its margin (`Margin.to_show`), and that every limb can reach."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca

from design.claims.reaching import reach_rows
from design.claims.statement import Statement
from kinematics import Array, ClaimSymbols, ToShow


def to_show(statement: Statement, claim: ClaimSymbols, inside: Array) -> ToShow:
    """Expressions that are all at least 0 on a region only if the statement holds on it.

    Args:
        claim: symbols for the bound and for the numbers that the FVI is measured with.
        inside: (n,) a pose of the region; it decides the signs.
    """
    margin = statement.robot.margins[statement.margin]
    shown = margin.to_show(statement.robot, claim, inside, statement.bound.value > 0.0)
    reach = reach_rows(statement.robot, shown.expressions)
    return replace(shown, expressions=ca.vertcat(shown.expressions, reach))
