"""The claim that every limb can reach, which belongs to every margin: some margins depend on few limbs, or on none.

If the inverse model of a limb has no value, the limb cannot reach. Some claims need everything that a limb's inverse
model needs to have a value (the same root of the same number), so they can hold only where this limb reaches. This
module finds the other limbs from the expressions, so no mechanism and no margin can forget one. The reach of these
limbs is claimed too.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics import Mechanism, Op, Program, run_through, sides

_LOADS = {Op.CONST, Op.INPUT, Op.OUTPUT}
# These operations are defined wherever their operands are.
_ALWAYS = {Op.ADD, Op.SUB, Op.MUL, Op.SQ, Op.NEG, Op.TWICE, Op.SIN, Op.COS, Op.ASSIGN, Op.LT, Op.LE, Op.NOT}
_ALWAYS |= {Op.ATAN2, Op.ATAN, Op.FABS, Op.FMIN, Op.FMAX, Op.SIGN}


class _Value(NamedTuple):
    """A number of a program.

    Attributes:
        name: equal for the same operation on the same operands.
        needs: names of the values that must be defined so that this one is defined.
    """

    name: int
    needs: frozenset[int]


def reach_rows(robot: Mechanism, expressions: ca.SX) -> ca.SX:
    """(k,) expressions in the model's symbols: at least 0 where those limbs reach that `expressions` do not need."""
    model = robot.model()
    reach = robot.reach(model.pose, model.g)
    left = _limbs_not_needed(expressions, model.inverse)
    if left and reach.numel() != model.inverse.numel():  # each limb has two drives
        left = list(range(reach.numel()))
    return ca.vertcat(*(side for limb in left for side in sides(reach[limb])))


def _limbs_not_needed(expressions: ca.SX, inverse: ca.SX) -> list[int]:
    """The rows of the inverse model that may lack a value where all expressions have one."""
    both = ca.densify(ca.vertcat(expressions, inverse))
    names: dict[Hashable, int] = {}

    def named(key: Hashable) -> int:
        return names.setdefault(key, len(names))

    def valued(number: _Value | float) -> _Value:
        if isinstance(number, _Value):
            return number
        name = named(("constant", number))
        return _Value(name, frozenset() if np.isfinite(number) else frozenset([name]))

    def operation(op: Op) -> Callable[[_Value | float, _Value | float], _Value]:
        def of(left: _Value | float, right: _Value | float) -> _Value:
            a, b = valued(left), valued(right)
            name = named((op, a.name, b.name))
            if op is Op.IF_ELSE_ZERO:  # the branch that is not taken may be undefined
                return _Value(name, a.needs | {name})
            return _Value(name, a.needs | b.needs | (frozenset() if op in _ALWAYS else {name}))

        return of

    symbols = ca.symvar(both)
    program = Program.of(ca.Function("reaching", [ca.vertcat(*symbols)], [both]))
    inputs = [_Value(named(("input", k)), frozenset()) for k in range(len(symbols))]
    rows = [valued(v) for v in run_through(program, inputs, {op: operation(op) for op in Op if op not in _LOADS})]
    shown = frozenset[int]().union(*(row.needs for row in rows[: expressions.numel()]))
    return [limb for limb, row in enumerate(rows[expressions.numel() :]) if not row.needs <= shown]
