"""Interval evaluation of a box program over boxes, rounded outward: what a proof may rest on.

Every register holds two bounds. The four operations and the root are correctly rounded by IEEE 754, so one unit in the
last place outward is enough for them. Sine, cosine and arctangent come from the C library (or numba's vector library),
which promise no error bound: here they are ASSUMED to be within four units in the last place of 1; tests hold them
against an arbitrary-precision library.

An operation that is not defined on the whole box (a root of a negative number, a division by zero, an arctangent across
its jump), or that has no rule, gives (-inf, inf). An operation on an operand with an infinite bound gives an infinite
bound, except in the branch that a condition does not take. So if the bounds of an output are finite, everything that it
is made of is defined on the whole box. Nothing is ever proved from infinite bounds. A condition that is true on a part
of a box only is [0, 1].
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numba
import numpy as np

from kinematics.errors import InvalidValue
from kinematics.evaluation.interval_trigonometry import arctangent, cosine
from kinematics.evaluation.program import Op
from kinematics.evaluation.threads import over_spans

if TYPE_CHECKING:
    from kinematics.evaluation.box_program import BoxProgram

BLOCK = 128
_EPS = 2.0**-52  # one unit in the last place, at least: twice what a correctly rounded operation is off by
_TINY = 5e-324
_MAX = 1.7976931348623157e308

(CONST, INPUT, OUTPUT, ASSIGN, ADD, SUB, MUL, DIV, NEG, SQRT, SQ, TWICE, INV, SIN, COS, ATAN2, FABS, FMIN, FMAX) = (
    int(Op(k)) for k in range(19)
)
SIGN, LT, LE, NOT, IF_ELSE_ZERO = (int(Op(k)) for k in range(26, 31))


def enclose(program: BoxProgram, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of each output over each box.

    Args:
        low, high: (k, n) the boxes' bounds, one column an input.

    Returns:
        low, high (k, outputs); never NaN.

    Raises:
        InvalidValue: the boxes do not have the columns that the function needs, or a bound is NaN, or low is above
            high.
    """
    if low.shape != high.shape or low.ndim != 2 or low.shape[-1] != program.inputs:
        raise InvalidValue("shape of the boxes", (low.shape, high.shape), f"(k, {program.inputs}) twice")
    low, high = np.ascontiguousarray(low, dtype=float), np.ascontiguousarray(high, dtype=float)
    if not (low <= high).all():
        raise InvalidValue("bounds of the boxes", "NaN or a lower bound above the upper one", "low <= high")
    out = np.zeros((2, low.shape[0], program.outputs))
    p = program

    def run(span: slice) -> None:
        boxes = low[span], high[span], out[0, span], out[1, span]
        _kernel(p.op, p.left, p.right, p.target, p.low, p.high, p.work_size, boxes)

    over_spans(low.shape[0], run)
    return out[0], out[1]


def operate(op: Op, left: tuple[float, float], right: tuple[float, float], same: bool = False) -> tuple[float, float]:
    """One operation on one pair of intervals; `same` where both operands are one and the same number."""
    a, b, c, d = (np.array([v]) for v in (*left, *right))
    low, high = np.empty(1), np.empty(1)
    _apply(int(op), same, a, b, c, d, low, high)
    return float(low[0]), float(high[0])


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _kernel(op, left, right, target, least, most, work_size, boxes):  # type: ignore[no-untyped-def]
    low, high, out_low, out_high = boxes
    width = min(BLOCK, (low.shape[0] + 7) // 8 * 8)
    lo, hi = np.zeros((work_size, width)), np.zeros((work_size, width))
    for first in range(0, low.shape[0], width):
        size = min(width, low.shape[0] - first)
        for k in range(op.shape[0]):
            code = op[k]
            x, y, z = np.uint64(left[k]), np.uint64(right[k]), np.uint64(target[k])
            if code == OUTPUT:
                for i in range(size):
                    out_low[first + i, z] = lo[x][i]
                    out_high[first + i, z] = hi[x][i]
            elif code == INPUT:
                for i in range(size):
                    lo[z][i] = low[first + i, x]
                    hi[z][i] = high[first + i, x]
                lo[z][size:] = lo[z][0]
                hi[z][size:] = hi[z][0]
            elif code == CONST:
                lo[z][:] = least[k]
                hi[z][:] = most[k]
            else:
                _apply(code, x == y, lo[x], hi[x], lo[y], hi[y], lo[z], hi[z])


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="never")
def _apply(code, same, a, b, c, d, r, s):  # type: ignore[no-untyped-def]
    """[r, s] = op([a, b], [c, d]) over a block, outward; every NaN becomes an unbounded side."""
    if code == ADD:
        for i in range(r.size):
            r[i], s[i] = _out(a[i] + c[i], b[i] + d[i], 0.0)
    elif code == SUB:
        for i in range(r.size):
            r[i], s[i] = _out(a[i] - d[i], b[i] - c[i], 0.0)
    elif code == SQ or (code == MUL and same):
        for i in range(r.size):
            p, q = a[i] * a[i], b[i] * b[i]
            least = 0.0 if a[i] <= 0.0 <= b[i] else min(p, q)
            low, most = _out(least, max(p, q), _TINY)
            r[i], s[i] = max(low, 0.0) if most < np.inf else -np.inf, most  # a square of what is undefined is undefined
    elif code == MUL:
        for i in range(r.size):
            p, q, u, v = a[i] * c[i], a[i] * d[i], b[i] * c[i], b[i] * d[i]
            least, most = min(min(p, q), min(u, v)), max(max(p, q), max(u, v))
            total = p + q + u + v  # NaN where a product is, or where infinities of both signs meet
            r[i], s[i] = _out(least, most, _TINY) if total - total == 0.0 else (-np.inf, np.inf)
    elif code == NEG:
        for i in range(r.size):
            r[i], s[i] = -b[i], -a[i]
    elif code == TWICE:
        for i in range(r.size):
            r[i], s[i] = min(2.0 * a[i], _MAX), max(2.0 * b[i], -_MAX)  # exact, but for overflow
    elif code == ASSIGN:
        for i in range(r.size):
            r[i], s[i] = a[i], b[i]
    else:
        for i in range(r.size):
            r[i], s[i] = _rare(code, a[i], b[i], c[i], d[i])


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def _out(low, high, tiny):  # type: ignore[no-untyped-def]
    """One unit outward at least; `tiny` where underflow may round too, which sums never do. Overflow gives NaN here."""
    low -= abs(low) * _EPS + tiny
    high += abs(high) * _EPS + tiny
    if low != low:
        low = -np.inf
    if high != high:
        high = np.inf
    return low, high


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="never")
def _rare(code, a, b, c, d):  # type: ignore[no-untyped-def]
    """Operations with conditions, one box at a time."""
    if code == IF_ELSE_ZERO:
        return _branch(a, b, c, d)
    total = a + b + c + d
    if total - total != 0.0:  # an infinite bound: something undefined or overflown went in
        return -np.inf, np.inf
    if code == INV:
        return _quotient(1.0, 1.0, a, b)
    if code == DIV:
        return _quotient(a, b, c, d)
    if code == SQRT:
        if a < 0.0:
            return -np.inf, np.inf
        low, high = _out(np.sqrt(a), np.sqrt(b), 0.0)
        return max(low, 0.0), high
    if code == FABS:
        if a >= 0.0:
            return a, b
        if b <= 0.0:
            return -b, -a
        return 0.0, max(-a, b)
    if code == FMIN:
        return min(a, c), min(b, d)
    if code == FMAX:
        return max(a, c), max(b, d)
    if code == SIGN:
        return np.sign(a), np.sign(b)
    if code == LT:
        return 1.0 if b < c else 0.0, 1.0 if a < d else 0.0
    if code == LE:
        return 1.0 if b <= c else 0.0, 1.0 if a <= d else 0.0
    if code == NOT:
        return 1.0 if a == b == 0.0 else 0.0, 1.0 if a <= 0.0 <= b else 0.0
    if code == SIN:
        return (0.0, 0.0) if a == b == 0.0 else cosine(a - 0.5 * np.pi, b - 0.5 * np.pi)
    if code == COS:
        return (1.0, 1.0) if a == b == 0.0 else cosine(a, b)
    if code == ATAN2:
        return arctangent(a, b, c, d)
    return -np.inf, np.inf


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="never")
def _branch(a, b, c, d):  # type: ignore[no-untyped-def]
    """[c, d] where the condition [a, b] is not 0, and 0 where it is; both where it is open."""
    if not (np.isfinite(a) and np.isfinite(b)):
        return -np.inf, np.inf
    if a == b == 0.0:
        return 0.0, 0.0
    if a <= 0.0 <= b:
        return min(c, 0.0), max(d, 0.0)
    return c, d


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="never")
def _quotient(a, b, c, d):  # type: ignore[no-untyped-def]
    if c <= 0.0 <= d:
        return -np.inf, np.inf
    p, q, u, v = a / c, a / d, b / c, b / d
    total = p + q + u + v
    if total - total != 0.0:
        return -np.inf, np.inf
    return _out(min(min(p, q), min(u, v)), max(max(p, q), max(u, v)), _TINY)
