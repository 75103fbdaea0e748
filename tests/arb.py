"""Arbitrary-precision balls as the numbers of a program: an interval arithmetic that shares nothing with ours."""

from __future__ import annotations

from flint import arb, ctx

from kinematics.program import Op

ctx.prec = 128

OPERATIONS = {
    Op.ASSIGN: lambda a, _: arb(a),
    Op.ADD: lambda a, b: arb(a) + arb(b),
    Op.SUB: lambda a, b: arb(a) - arb(b),
    Op.MUL: lambda a, b: arb(a) * arb(b),
    Op.DIV: lambda a, b: arb(a) / arb(b),
    Op.NEG: lambda a, _: -arb(a),
    Op.SQRT: lambda a, _: arb(a).sqrt(),
    Op.SQ: lambda a, _: arb(a) ** 2,
    Op.TWICE: lambda a, _: 2 * arb(a),
    Op.INV: lambda a, _: 1 / arb(a),
    Op.SIN: lambda a, _: arb(a).sin(),
    Op.COS: lambda a, _: arb(a).cos(),
    Op.ATAN2: lambda a, b: arb.atan2(arb(a), arb(b)),
    Op.FABS: lambda a, _: abs(arb(a)),
    Op.FMIN: lambda a, b: arb(a).min(arb(b)),
    Op.FMAX: lambda a, b: arb(a).max(arb(b)),
    Op.SIGN: lambda a, _: arb(a).sgn(),
}


def ball(low: float, high: float) -> arb:
    """A ball around [low, high]."""
    return arb(low).union(arb(high))
