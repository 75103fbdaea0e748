"""A CasADi SX function as a flat list of instructions that other modules run.

`Program` is the one form that the block interpreter (arrays of poses) and `run_through` (any other kind of number:
symbols, intervals, arbitrary precision) work from.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from itertools import accumulate
from typing import Any

import casadi as ca
import numpy as np

from kinematics.arrays import Value
from kinematics.errors import LinkwrightError


class Op(IntEnum):
    """The operations that Linkwright's models use."""

    CONST = 0
    INPUT = 1
    OUTPUT = 2
    ASSIGN = 3
    ADD = 4
    SUB = 5
    MUL = 6
    DIV = 7
    NEG = 8
    SQRT = 9
    SQ = 10
    TWICE = 11
    INV = 12
    SIN = 13
    COS = 14
    ATAN2 = 15
    FABS = 16
    FMIN = 17
    FMAX = 18
    ATAN = 19
    ACOS = 20
    ASIN = 21
    TAN = 22
    EXP = 23
    LOG = 24
    POW = 25
    SIGN = 26
    LT = 27
    LE = 28
    NOT = 29
    IF_ELSE_ZERO = 30


_FROM_CASADI: dict[int, Op] = {getattr(ca, f"OP_{op.name}"): op for op in Op if op is not Op.CONST} | {
    ca.OP_CONST: Op.CONST,
    ca.OP_CONSTPOW: Op.POW,
}


class UnknownOperation(LinkwrightError):
    """The function uses an operation that the interpreter does not know."""

    def __init__(self, function: str, code: int) -> None:
        self.function, self.code = function, code
        super().__init__(f"function {function}: CasADi operation {code} is not known to the interpreter")


@dataclass(frozen=True)
class Columns:
    """What a program reads and writes: columns of all inputs, and of all outputs, laid side by side."""

    inputs: tuple[int, ...]  # number of columns of each input
    outputs: tuple[tuple[int, int], ...]  # (rows, columns) of each output
    work_size: int

    @property
    def output_size(self) -> int:
        """Columns of all outputs laid side by side."""
        return sum(rows * columns for rows, columns in self.outputs)


@dataclass(frozen=True, eq=False)
class Program(Value, Columns):
    """Instructions in order: work[target] = op(work[left], work[right]).

    INPUT reads column `left` of the inputs laid side by side; OUTPUT writes column `target` of the outputs laid side
    by side (dense, row by row); CONST loads `constant`.
    """

    op: np.ndarray  # (k,) int64
    left: np.ndarray  # (k,) int64
    right: np.ndarray  # (k,) int64
    target: np.ndarray  # (k,) int64
    constant: np.ndarray  # (k,)

    @classmethod
    def of(cls, function: ca.Function) -> Program:
        """Flatten an SX function.

        Raises:
            UnknownOperation: the function uses an operation outside `Op`.
        """
        inputs = tuple(function.nnz_in(i) for i in range(function.n_in()))
        outputs = tuple(function.size_out(i) for i in range(function.n_out()))
        input_start = [0, *accumulate(inputs)]
        output_start = [0, *accumulate(r * c for r, c in outputs)]
        places = [_dense_places(function.sparsity_out(i)) for i in range(function.n_out())]
        rows: list[tuple[int, int, int, int, float]] = []
        load, take, give = int(Op.CONST), int(Op.INPUT), int(Op.OUTPUT)
        for k in range(function.n_instructions()):
            code = function.instruction_id(k)
            if code not in _FROM_CASADI:
                raise UnknownOperation(function.name(), code)
            op = int(_FROM_CASADI[code])
            source, sink = function.instruction_input(k), function.instruction_output(k)
            constant = function.instruction_constant(k) if op == load else 0.0
            if op == take:
                rows.append((op, input_start[source[0]] + source[1], 0, sink[0], constant))
            elif op == give:
                rows.append((op, source[0], 0, output_start[sink[0]] + places[sink[0]][sink[1]], constant))
            else:
                left, right = (*source, 0, 0)[:2]
                rows.append((op, left, right if len(source) > 1 else left, sink[0], constant))
        table = [np.array(column) for column in zip(*rows, strict=True)]
        op_, left_, right_, target_ = (column.astype(np.int64) for column in table[:4])
        return cls(inputs, outputs, function.sz_w(), op_, left_, right_, target_, table[4].astype(float))


def _dense_places(sparsity: ca.Sparsity) -> list[int]:
    """Position of each nonzero in the dense matrix, row by row."""
    rows, columns = sparsity.get_triplet()
    return [r * sparsity.size2() + c for r, c in zip(rows, columns, strict=True)]


_SYMBOLIC: dict[Op, Callable[..., Any]] = {
    Op.ASSIGN: lambda a, _: a,
    Op.ADD: operator.add,
    Op.SUB: operator.sub,
    Op.MUL: operator.mul,
    Op.DIV: operator.truediv,
    Op.NEG: lambda a, _: -a,
    Op.SQRT: lambda a, _: ca.sqrt(a),
    Op.SQ: lambda a, _: a * a,
    Op.TWICE: lambda a, _: 2 * a,
    Op.INV: lambda a, _: 1 / a,
    Op.SIN: lambda a, _: ca.sin(a),
    Op.COS: lambda a, _: ca.cos(a),
    Op.ATAN2: ca.atan2,
    Op.FABS: lambda a, _: ca.fabs(a),
    Op.FMIN: ca.fmin,
    Op.FMAX: ca.fmax,
    Op.SIGN: lambda a, _: ca.sign(a),
    Op.LT: ca.lt,
    Op.LE: ca.le,
    Op.NOT: lambda a, _: ca.logic_not(a),
    Op.IF_ELSE_ZERO: lambda a, b: ca.if_else(a, b, 0),
}


def run_through(
    program: Program, inputs: Sequence[Any], operations: Mapping[Op, Callable[[Any, Any], Any]] | None = None
) -> list[Any]:
    """Run the program over any kind of number; `operations` replaces the symbolic ones where given.

    Args:
        inputs: one number for each input column.
        operations: Op -> function of (left, right).

    Returns:
        One number for each output column, row by row; 0.0 where the output is structurally zero.
    """
    table = {**_SYMBOLIC, **(operations or {})}
    work: list[Any] = [0.0] * program.work_size
    out: list[Any] = [0.0] * program.output_size
    load, take, give = int(Op.CONST), int(Op.INPUT), int(Op.OUTPUT)
    columns = (program.op, program.left, program.right, program.target, program.constant)
    for op, left, right, target, constant in zip(*(c.tolist() for c in columns), strict=True):
        if op == load:
            work[target] = constant
        elif op == take:
            work[target] = inputs[left]
        elif op == give:
            out[target] = work[left]
        else:
            work[target] = table[Op(op)](work[left], work[right])
    return out
