"""Arbitrary-precision balls as the numbers of a program: an interval arithmetic that shares nothing with ours."""

from __future__ import annotations

from flint import arb, ctx

from kinematics.evaluation.program import Op

ctx.prec = 128

OPERATIONS = {
    Op.ASSIGN: lambda a, _: arb(a),
    Op.ADD: lambda a, b: arb(a) + arb(b),
    Op.SUB: lambda a, b: arb(a) - arb(b),
    Op.MUL: lambda a, b: arb(a) * arb(b),
    Op.DIV: lambda a, b: arb(a) / arb(b),
    Op.NEG: lambda a, _: -arb(a),
    Op.SQRT: lambda a, _: arb(a).sqrt(),
    Op.SQ: lambda a, _: arb(a) * arb(a),  # a power of a ball around 0 may be NaN
    Op.TWICE: lambda a, _: 2 * arb(a),
    Op.INV: lambda a, _: 1 / arb(a),
    Op.SIN: lambda a, _: arb(a).sin(),
    Op.COS: lambda a, _: arb(a).cos(),
    Op.ATAN2: lambda a, b: arb.atan2(arb(a), arb(b)),
    Op.FABS: lambda a, _: abs(arb(a)),
    Op.FMIN: lambda a, b: arb(a).min(arb(b)),
    Op.FMAX: lambda a, b: arb(a).max(arb(b)),
    Op.SIGN: lambda a, _: arb(a).sgn(),
    Op.LT: lambda a, b: _truth(arb(a) < arb(b), arb(a) >= arb(b)),
    Op.LE: lambda a, b: _truth(arb(a) <= arb(b), arb(a) > arb(b)),
    Op.NOT: lambda a, _: _truth(arb(a) == 0, arb(a) != 0),
    Op.IF_ELSE_ZERO: lambda a, b: _branch(arb(a), b),
}


def _truth(certain: bool, impossible: bool) -> arb:
    """1, 0, or a ball around both; NaN compares with nothing and stays open."""
    return arb(1) if certain else arb(0) if impossible else arb(0).union(arb(1))


def _branch(condition: arb, value: arb | float) -> arb:
    """What is left aside does not count, not even NaN."""
    return arb(0) if condition == 0 else arb(value) if condition != 0 else arb(value).union(arb(0))


def ball(low: float, high: float) -> arb:
    """A ball around [low, high]."""
    return arb(low).union(arb(high))
