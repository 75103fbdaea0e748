"""How expressions depend on variables: in which directions these may move together without any change.

A robot's rows often depend only on a difference, such as that of two radii. Then one variable fewer is to be cut. The
directions are found in the program itself with exact fractions. What follows from fixed inputs alone counts as a
symbol of its own, so that no rounding can make two different numbers cancel.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Sequence
from fractions import Fraction
from typing import NamedTuple

from kinematics import Op, Program, run_through

_LOADS = {Op.CONST, Op.INPUT, Op.OUTPUT}
Direction = tuple[Fraction, ...]


class _Constant(NamedTuple):
    """What no variable changes: equal names for the same operation on the same operands."""

    name: int


class _Affine(NamedTuple):
    """A sum of variables times factors, and of what is nonlinear in variables that were recorded.

    The factor of (variable, constants) is multiplied by the product of these constants.
    """

    terms: dict[tuple[int, tuple[int, ...]], Fraction]

    def times(self, factor: Fraction, constant: tuple[int, ...] = ()) -> _Affine:
        """The product with a fraction and a constant."""
        return _Affine({(v, tuple(sorted(c + constant))): factor * f for (v, c), f in self.terms.items()})

    def plus(self, other: _Affine) -> _Affine:
        """The sum; what cancels is left out."""
        found = dict(self.terms)
        for key, factor in other.terms.items():
            found[key] = found.get(key, Fraction(0)) + factor
        return _Affine({key: factor for key, factor in found.items() if factor})


_Value = float | _Constant | _Affine


class _Walk:
    """One run through a program, with the affine forms that its nonlinear operations and outputs take."""

    def __init__(self) -> None:
        self.rows: list[_Affine] = []
        self._names: dict[Hashable, int] = {}

    def constant(self, key: Hashable) -> _Constant:
        return _Constant(self._names.setdefault(key, len(self._names)))

    def operation(self, op: Op) -> Callable[[_Value, _Value], _Value]:
        def of(a: _Value, b: _Value) -> _Value:
            if not isinstance(a, _Affine) and not isinstance(b, _Affine):
                return self.constant((op, a, b))
            linear = self._linear(op, a, b)
            if linear is not None:
                return linear
            for operand in (a, b):
                self.record(operand)
            return _Affine({})

        return of

    def record(self, value: _Value) -> None:
        if isinstance(value, _Affine) and value.terms:
            self.rows.append(value)

    def _linear(self, op: Op, a: _Value, b: _Value) -> _Affine | None:
        """The operation's result where it is affine; else None."""
        if op in (Op.ADD, Op.SUB):
            left, right = (value if isinstance(value, _Affine) else _Affine({}) for value in (a, b))
            return left.plus(right if op is Op.ADD else right.times(Fraction(-1)))
        if op in (Op.ASSIGN, Op.NEG, Op.TWICE) and isinstance(a, _Affine):
            return a.times(Fraction({Op.ASSIGN: 1, Op.NEG: -1, Op.TWICE: 2}[op]))
        if op is Op.MUL and isinstance(b, _Affine):
            a, b = b, a
        if op in (Op.MUL, Op.DIV) and isinstance(a, _Affine) and not isinstance(b, _Affine):
            if isinstance(b, float) and math.isfinite(b) and b:
                return a.times(Fraction(b) if op is Op.MUL else 1 / Fraction(b))
            return a.times(Fraction(1), (self.constant(b if op is Op.MUL else (op, b)).name,))
        return None


def free_directions(program: Program, variables: int) -> list[Direction]:
    """A basis of the directions (variables,) in which no output changes; empty if there is none that is sure.

    In each of them the entry of one variable, in no other of them, is 1.

    Args:
        program: its first inputs are the variables; the others are fixed numbers.
        variables: how many.
    """
    walk = _Walk()
    inputs: list[_Value] = [_Affine({(k, ()): Fraction(1)}) for k in range(variables)]
    inputs += [walk.constant(("input", k)) for k in range(variables, sum(program.inputs))]
    for output in run_through(program, inputs, {op: walk.operation(op) for op in Op if op not in _LOADS}):
        walk.record(output)
    equations = [
        [row.terms.get((k, constants), Fraction(0)) for k in range(variables)]
        for row in walk.rows
        for constants in {constants for _, constants in row.terms}
    ]
    return _null_space(equations, variables)


def _null_space(equations: Sequence[Sequence[Fraction]], count: int) -> list[Direction]:
    """Gauss and Jordan, with fractions."""
    pivots: dict[int, list[Fraction]] = {}
    for equation in equations:
        row = list(equation)
        for column, pivot in pivots.items():
            row = [r - row[column] * p for r, p in zip(row, pivot, strict=True)]
        lead = next((k for k, r in enumerate(row) if r), None)
        if lead is None:
            continue
        row = [r / row[lead] for r in row]
        for column, pivot in pivots.items():
            pivots[column] = [p - pivot[lead] * r for p, r in zip(pivot, row, strict=True)]
        pivots[lead] = row
    free = [k for k in range(count) if k not in pivots]
    return [tuple(Fraction(int(j == k)) if j in free else -pivots[j][k] for j in range(count)) for k in free]
