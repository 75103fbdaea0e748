"""The block interpreter: runs any CasADi SX function over arrays of poses, with nothing compiled per model.

A block of poses goes through one instruction at a time, so the cost of decoding it is shared by the block and the
work rows stay in the cache. The kernel is compiled once per machine and then cached by numba.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

import casadi as ca
import numba
import numpy as np

from kinematics.program import Op, Program

BLOCK = 128
_THREADS = max(1, os.cpu_count() or 1)
_LEAST_PER_THREAD = 4096

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
    """
    lead = inputs[0].shape[:-1]
    count = int(np.prod(lead, dtype=np.int64))
    columns = [np.asarray(a, dtype=float).reshape(count, -1) for a in inputs]
    table = columns[0] if len(columns) == 1 else np.concatenate(columns, axis=1)
    table = np.ascontiguousarray(table)
    out = np.zeros((count, program.output_size))
    threads = min(_THREADS, max(1, count // _LEAST_PER_THREAD))
    if threads == 1:
        _run(program, table, out)
    else:
        edges = np.linspace(0, count, threads + 1).astype(int)
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(lambda span: _run(program, table[slice(*span)], out[slice(*span)]), pairwise(edges)))
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
    work = np.zeros((work_size, BLOCK))
    for first in range(0, table.shape[0], BLOCK):
        size = min(BLOCK, table.shape[0] - first)
        for k in range(op.shape[0]):
            code = op[k]
            if code == OUTPUT:
                a = work[left[k]]
                j = target[k]
                for i in range(size):
                    out[first + i, j] = a[i]
                continue
            r = work[target[k]]
            if code == INPUT:
                j = left[k]
                for i in range(size):
                    r[i] = table[first + i, j]
                for i in range(size, BLOCK):
                    r[i] = r[0]
            elif code == CONST:
                r[:] = constant[k]
            else:
                _apply(code, work[left[k]], work[right[k]], r)


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="never")
def _apply(code, a, b, r):  # type: ignore[no-untyped-def]
    """One instruction over one block; numba turns each loop into vector code."""
    if code == ADD:
        for i in range(BLOCK):
            r[i] = a[i] + b[i]
    elif code == MUL:
        for i in range(BLOCK):
            r[i] = a[i] * b[i]
    elif code == SUB:
        for i in range(BLOCK):
            r[i] = a[i] - b[i]
    elif code == SQ:
        for i in range(BLOCK):
            r[i] = a[i] * a[i]
    elif code == DIV:
        for i in range(BLOCK):
            r[i] = a[i] / b[i]
    elif code == SQRT:
        for i in range(BLOCK):
            r[i] = np.sqrt(a[i])
    elif code == NEG:
        for i in range(BLOCK):
            r[i] = -a[i]
    elif code == TWICE:
        for i in range(BLOCK):
            r[i] = a[i] + a[i]
    elif code == INV:
        for i in range(BLOCK):
            r[i] = 1.0 / a[i]
    elif code == FABS:
        for i in range(BLOCK):
            r[i] = abs(a[i])
    elif code == FMIN:
        for i in range(BLOCK):
            r[i] = np.minimum(a[i], b[i])
    elif code == FMAX:
        for i in range(BLOCK):
            r[i] = np.maximum(a[i], b[i])
    elif code == ASSIGN:
        for i in range(BLOCK):
            r[i] = a[i]
    else:
        _apply_rare(code, a, b, r)


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="never")
def _apply_rare(code, a, b, r):  # type: ignore[no-untyped-def]
    """The operations that cost a library call or are seldom seen, item by item."""
    for i in range(BLOCK):
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
