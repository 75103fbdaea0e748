"""The block interpreter: runs any CasADi SX function over arrays of poses, with nothing compiled per model.

A block of poses goes through one instruction at a time, so the cost of decoding it is shared by the block and the
work rows stay in the cache. The kernel is compiled once per machine and then cached by numba.
"""

from __future__ import annotations

import casadi as ca
import numba
import numpy as np

from kinematics.errors import InvalidValue
from kinematics.program import Op, Program
from kinematics.threads import over_spans

BLOCK = 256

(CONST, INPUT, OUTPUT, ASSIGN, ADD, SUB, MUL, DIV, NEG, SQRT, SQ, TWICE, INV, SIN, COS, ATAN2, FABS, FMIN, FMAX) = (
    int(Op(k)) for k in range(19)
)
(ATAN, ACOS, ASIN, TAN, EXP, LOG, POW, SIGN, LT, LE, NOT, IF_ELSE_ZERO) = (int(Op(k)) for k in range(19, 31))


def evaluate(program: Program, *inputs: np.ndarray) -> list[np.ndarray]:
    """Evaluate over poses.

    Args:
        inputs: one array (..., k_i) for each input of the function, all with the same leading shape.

    Returns:
        One array (..., rows, columns) for each output; a single column is dropped.

    Raises:
        InvalidValue: an input has not the columns that the function wants.
    """
    lead = inputs[0].shape[:-1]
    count = int(np.prod(lead, dtype=np.int64))
    columns = [np.asarray(a, dtype=float).reshape(count, a.shape[-1]) for a in inputs]
    found = tuple(a.shape[1] for a in columns)
    if found != program.inputs:
        raise InvalidValue("columns of the inputs", found, str(program.inputs))
    table = columns[0] if len(columns) == 1 else np.concatenate(columns, axis=1)
    table = np.ascontiguousarray(table)
    out = np.zeros((count, program.output_size))
    over_spans(count, lambda span: _run(program, table[span], out[span]))
    results, start = [], 0
    for rows, cols in program.outputs:
        part = out[:, start : start + rows * cols]
        results.append(part.reshape(lead + ((rows, cols) if cols != 1 else (rows,))))
        start += rows * cols
    return results


def bulk(function: ca.Function) -> Program:
    """The program of a function, ready for `evaluate`; common subexpressions are merged first."""
    symbols = [ca.SX.sym(function.name_in(i), function.sparsity_in(i)) for i in range(function.n_in())]
    outputs = ca.cse(list(function.call(symbols)))
    return Program.of(ca.Function(function.name(), symbols, outputs))


def _run(program: Program, table: np.ndarray, out: np.ndarray) -> None:
    _kernel(program.op, program.left, program.right, program.target, program.constant, program.work_size, table, out)


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _kernel(op, left, right, target, constant, work_size, table, out):  # type: ignore[no-untyped-def]
    width = min(BLOCK, (table.shape[0] + 7) // 8 * 8)  # a single pose does not pay for a whole block
    work = np.zeros((work_size, width))
    for first in range(0, table.shape[0], width):
        size = min(width, table.shape[0] - first)
        for k in range(op.shape[0]):
            code = op[k]
            # Unsigned, so that no index needs a test for counting from the end.
            x, y, z = np.uint64(left[k]), np.uint64(right[k]), np.uint64(target[k])
            if code == OUTPUT:
                a = work[x]
                for i in range(size):
                    out[first + i, z] = a[i]
                continue
            r = work[z]
            if code == INPUT:
                for i in range(size):
                    r[i] = table[first + i, x]
                r[size:] = r[0]
            elif code == CONST:
                r[:] = constant[k]
            else:
                _apply(code, work[x], work[y], r)


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="never")
def _apply(code, a, b, r):  # type: ignore[no-untyped-def]
    """One instruction over one block; numba turns each loop into vector code."""
    if code == ADD:
        for i in range(r.size):
            r[i] = a[i] + b[i]
    elif code == MUL:
        for i in range(r.size):
            r[i] = a[i] * b[i]
    elif code == SUB:
        for i in range(r.size):
            r[i] = a[i] - b[i]
    elif code == SQ:
        for i in range(r.size):
            r[i] = a[i] * a[i]
    elif code == DIV:
        for i in range(r.size):
            r[i] = a[i] / b[i]
    elif code == SQRT:
        for i in range(r.size):
            r[i] = np.sqrt(a[i])
    elif code == NEG:
        for i in range(r.size):
            r[i] = -a[i]
    elif code == TWICE:
        for i in range(r.size):
            r[i] = a[i] + a[i]
    elif code == INV:
        for i in range(r.size):
            r[i] = 1.0 / a[i]
    elif code == FABS:
        for i in range(r.size):
            r[i] = abs(a[i])
    elif code == FMIN:
        for i in range(r.size):
            r[i] = np.minimum(a[i], b[i])
    elif code == FMAX:
        for i in range(r.size):
            r[i] = np.maximum(a[i], b[i])
    elif code == ASSIGN:
        for i in range(r.size):
            r[i] = a[i]
    else:
        _apply_rare(code, a, b, r)


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="never")
def _apply_rare(code, a, b, r):  # type: ignore[no-untyped-def]
    """The operations that cost a library call or are seldom seen, item by item."""
    for i in range(r.size):
        x, y = a[i], b[i]
        if code == SIN:
            v = np.sin(x)
        elif code == COS:
            v = np.cos(x)
        elif code == ATAN2:
            v = np.arctan2(x, y)
        elif code == ATAN:
            v = np.arctan(x)
        elif code == ACOS:
            v = np.arccos(x)
        elif code == ASIN:
            v = np.arcsin(x)
        elif code == TAN:
            v = np.tan(x)
        elif code == EXP:
            v = np.exp(x)
        elif code == LOG:
            v = np.log(x)
        elif code == POW:
            v = x**y
        elif code == SIGN:
            v = np.sign(x)
        elif code == LT:
            v = 1.0 if x < y else 0.0
        elif code == LE:
            v = 1.0 if x <= y else 0.0
        elif code == NOT:
            v = 1.0 if x == 0.0 else 0.0
        elif code == IF_ELSE_ZERO:
            v = y if x != 0.0 else 0.0
        else:
            v = np.nan
        r[i] = v
