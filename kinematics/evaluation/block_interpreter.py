"""The block interpreter: it runs any CasADi SX function over arrays of poses and compiles nothing for each model.

Each instruction is applied to a whole block of poses, so decoding an instruction costs little, and the work rows stay
in the first-level cache. The interpreter itself is compiled once on each machine and then cached by numba.
"""

from __future__ import annotations

import math
from typing import Any

import casadi as ca
import numba
import numpy as np

from kinematics.errors import InvalidValue
from kinematics.evaluation.block_graph import Block
from kinematics.evaluation.block_program import BlockProgram
from kinematics.evaluation.program import Op, Program
from kinematics.evaluation.threads import over_spans
from kinematics.evaluation.vector_sine import LIMIT, sine

LINE = 8  # doubles in a cache line
BLOCK = 64  # poses: 64 work rows fill the usual 32 KB of first cache

(CONST, INPUT, OUTPUT, ASSIGN, ADD, SUB, MUL, DIV, NEG, SQRT, SQ, TWICE, INV, SIN, COS, ATAN2, FABS, FMIN, FMAX) = (
    int(Op(k)) for k in range(19)
)
(ATAN, ACOS, ASIN, TAN, EXP, LOG, POW, SIGN, LT, LE, NOT, IF_ELSE_ZERO) = (int(Op(k)) for k in range(19, 31))
SCALE, AFFINE, SUM, PRODUCT, PRODUCT_AFFINE, PRODUCT_SUM, TWO_PRODUCTS = (int(b) for b in Block)


def evaluate(program: BlockProgram, *inputs: np.ndarray, blank: bool = False) -> list[np.ndarray]:
    """Evaluate over poses, in chunks. Only the memory of the results grows with the number of poses.

    Args:
        inputs: one array (..., k_i) for each input of the function, all with the same leading shape.
        blank: make every output NaN at a pose where an input is not finite or any output is NaN.

    Returns:
        One array (..., rows, columns) for each output; a single column is dropped.

    Raises:
        InvalidValue: an input does not have the columns that the function needs.
    """
    lead = inputs[0].shape[:-1]
    count = math.prod(lead)
    columns = [np.asarray(a, dtype=float).reshape(count, a.shape[-1]) for a in inputs]
    found = tuple(a.shape[1] for a in columns)
    if found != program.inputs:
        raise InvalidValue("columns of the inputs", found, str(program.inputs))
    out = np.zeros((count, program.output_size))

    def run(span: slice) -> None:
        table = columns[0][span] if len(columns) == 1 else np.concatenate([c[span] for c in columns], axis=1)
        table = np.ascontiguousarray(table)
        _kernel(program.code, program.constant, program.work_size, blank, table, out[span])

    over_spans(count, run)
    results, start = [], 0
    for rows, cols in program.outputs:
        part = out[:, start : start + rows * cols]
        results.append(part.reshape(lead + ((rows, cols) if cols != 1 else (rows,))))
        start += rows * cols
    return results


def bulk(function: ca.Function) -> BlockProgram:
    """The program of a function, ready for `evaluate`."""
    symbols = [ca.SX.sym(function.name_in(i), function.sparsity_in(i)) for i in range(function.n_in())]
    outputs = ca.cse(list(function.call(symbols)))
    return BlockProgram.of(Program.of(ca.Function(function.name(), symbols, outputs)))


_OPTIONS: dict[str, Any] = {"nogil": True, "cache": True, "error_model": "numpy", "fastmath": {"contract"}}


@numba.njit(**_OPTIONS)
def _kernel(code, constant, work_size, blank, table, out):  # type: ignore[no-untyped-def]
    memory = np.zeros(work_size * BLOCK + LINE)
    skip = (-memory.ctypes.data // 8) % LINE  # no row begins between two cache lines
    work = memory[skip : skip + work_size * BLOCK].reshape(work_size, BLOCK)
    for first in range(0, table.shape[0], BLOCK):
        size = min(BLOCK, table.shape[0] - first)
        for column in range(table.shape[1]):
            for i in range(size):
                work[column, i] = table[first + i, column]
            work[column, size:] = work[column, 0]
        _block(code, constant, work, out[first : first + size])
        if blank:
            _blank(table[first : first + size], out[first : first + size])


@numba.njit(**_OPTIONS)
def _blank(table, out):  # type: ignore[no-untyped-def]
    for i in range(table.shape[0]):
        lost = False
        for column in range(table.shape[1]):
            lost |= not abs(table[i, column]) < np.inf
        for column in range(out.shape[1]):
            lost |= out[i, column] != out[i, column]
        if lost:
            out[i, :] = np.nan


@numba.njit(**_OPTIONS)
def _block(code, constant, work, out):  # type: ignore[no-untyped-def]
    """All instructions over one block.

    Rows are named by number: a view of a row would be counted in and out, at a higher cost than the row's arithmetic.
    """
    for n in range(code.shape[0]):
        op = code[n, 0]
        # Unsigned, so that no index needs a test for counting from the end.
        x, y, u, v = np.uint64(code[n, 1]), np.uint64(code[n, 2]), np.uint64(code[n, 3]), np.uint64(code[n, 4])
        r = np.uint64(code[n, 5])
        if op >= SCALE:
            _fused(op, constant[n, 0], constant[n, 1], work, x, y, u, v, r)
        elif op == OUTPUT:
            for i in range(out.shape[0]):
                out[i, r] = work[x, i]
        elif op == CONST:
            for i in range(BLOCK):
                work[r, i] = constant[n, 0]
        elif op in (SIN, COS):
            _sine(op, work, x, r)
        else:
            _plain(op, work, x, y, r)


@numba.njit(**_OPTIONS, inline="always")
def _fused(op, k, c, work, x, y, u, v, r):  # type: ignore[no-untyped-def]
    """Numba turns each loop into vector code; factors of +-1 are frequent enough to be spared."""
    if op == PRODUCT_SUM:
        if k == 1.0 and c == 1.0:
            for i in range(BLOCK):
                work[r, i] = work[x, i] * work[y, i] + work[u, i]
        elif k == -1.0 and c == 1.0:
            for i in range(BLOCK):
                work[r, i] = work[u, i] - work[x, i] * work[y, i]
        else:
            for i in range(BLOCK):
                work[r, i] = k * (work[x, i] * work[y, i]) + c * work[u, i]
    elif op == TWO_PRODUCTS:
        if k == 1.0 and c == 1.0:
            for i in range(BLOCK):
                work[r, i] = work[x, i] * work[y, i] + work[u, i] * work[v, i]
        elif k == 1.0 and c == -1.0:
            for i in range(BLOCK):
                work[r, i] = work[x, i] * work[y, i] - work[u, i] * work[v, i]
        else:
            for i in range(BLOCK):
                work[r, i] = k * (work[x, i] * work[y, i]) + c * (work[u, i] * work[v, i])
    elif op == PRODUCT:
        if k == 1.0:
            for i in range(BLOCK):
                work[r, i] = work[x, i] * work[y, i]
        else:
            for i in range(BLOCK):
                work[r, i] = k * (work[x, i] * work[y, i])
    elif op == SUM:
        for i in range(BLOCK):
            work[r, i] = k * work[x, i] + c * work[y, i]
    elif op == AFFINE:
        for i in range(BLOCK):
            work[r, i] = k * work[x, i] + c
    elif op == PRODUCT_AFFINE:
        for i in range(BLOCK):
            work[r, i] = k * (work[x, i] * work[y, i]) + c
    elif op == SCALE:
        for i in range(BLOCK):
            work[r, i] = k * work[x, i]
    else:
        for i in range(BLOCK):
            work[r, i] = np.nan


@numba.njit(**_OPTIONS, inline="always")
def _plain(op, work, x, y, r):  # type: ignore[no-untyped-def]
    """What the graph leaves of CasADi's own operations, the frequent ones as vector code."""
    if op == INV:
        for i in range(BLOCK):
            work[r, i] = 1.0 / work[x, i]
    elif op == SQRT:
        for i in range(BLOCK):
            work[r, i] = np.sqrt(work[x, i])
    elif op == DIV:
        for i in range(BLOCK):
            work[r, i] = work[x, i] / work[y, i]
    elif op == FMIN:  # NaN comes through from either side
        for i in range(BLOCK):
            a, b = work[x, i], work[y, i]
            work[r, i] = a if a < b or a != a else b
    elif op == FMAX:
        for i in range(BLOCK):
            a, b = work[x, i], work[y, i]
            work[r, i] = a if a > b or a != a else b
    elif op == FABS:
        for i in range(BLOCK):
            work[r, i] = abs(work[x, i])
    else:
        for i in range(BLOCK):
            work[r, i] = _rare(op, work[x, i], work[y, i])


@numba.njit(**_OPTIONS)
def _sine(op, work, x, r):  # type: ignore[no-untyped-def]
    quarters = 1.0 if op == COS else 0.0
    for i in range(BLOCK):
        work[r, i] = sine(work[x, i], quarters)
    for i in range(BLOCK):
        if abs(work[x, i]) > LIMIT:
            work[r, i] = np.cos(work[x, i]) if op == COS else np.sin(work[x, i])


@numba.njit(**_OPTIONS)
def _rare(op, a, b):  # type: ignore[no-untyped-def]
    """The operations that cost a library call or are seldom seen, item by item."""
    if op == ADD:
        return a + b
    if op == SUB:
        return a - b
    if op == MUL:
        return a * b
    if op == SQ:
        return a * a
    if op == NEG:
        return -a
    if op == TWICE:
        return a + a
    if op == ASSIGN:
        return a
    if op == ATAN2:
        return np.arctan2(a, b)
    if op == ATAN:
        return np.arctan(a)
    if op == ACOS:
        return np.arccos(a)
    if op == ASIN:
        return np.arcsin(a)
    if op == TAN:
        return np.tan(a)
    if op == EXP:
        return np.exp(a)
    if op == LOG:
        return np.log(a)
    if op == POW:
        return a**b
    if op == SIGN:
        return np.sign(a)
    if op == LT:
        return 1.0 if a < b else 0.0
    if op == LE:
        return 1.0 if a <= b else 0.0
    if op == NOT:
        return 1.0 if a == 0.0 else 0.0
    if op == IF_ELSE_ZERO:
        return b if a != 0.0 else 0.0
    return np.nan
