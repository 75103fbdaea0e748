"""The conditions at which expressions branch or jump: a centred form needs all of them decided on its box."""

from __future__ import annotations

import casadi as ca

from kinematics import Op, Program, run_through


def branch_conditions(symbols: list[ca.SX], expressions: ca.SX) -> ca.SX:
    """(k,) all conditions at which the expressions branch or jump: 0 or 1, or a sign."""
    found: list[ca.SX] = []

    def noted(condition: ca.SX) -> ca.SX:
        found.append(condition)
        return condition

    def branch(condition: ca.SX, value: ca.SX) -> ca.SX:
        noted(ca.logic_not(condition))
        return ca.if_else(condition, value, 0)

    program = Program.of(ca.Function("claims", symbols, [ca.densify(expressions)]))
    run_through(
        program,
        [symbol[i] for symbol in symbols for i in range(symbol.numel())],
        {
            Op.LT: lambda a, b: noted(ca.lt(a, b)),
            Op.LE: lambda a, b: noted(ca.le(a, b)),
            Op.NOT: lambda a, _: noted(ca.logic_not(a)),
            Op.SIGN: lambda a, _: noted(ca.sign(a)),
            Op.IF_ELSE_ZERO: branch,
        },
    )
    return ca.vertcat(*found) if found else ca.SX(0, 1)
