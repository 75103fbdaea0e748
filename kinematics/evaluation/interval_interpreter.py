"""Interval evaluation of a box program over boxes, rounded outward: what a proof may rest on.

Every register holds two bounds. The four operations and the root are correctly rounded by IEEE 754, so one unit in the
last place outward is enough for them. Sine, cosine and arctangent are polynomials that are ASSUMED to be within four
units in the last place of 1; tests hold them against an arbitrary-precision library.

An operation that is not defined on the whole box (a root of a negative number, a division by zero, an arctangent across
its jump), or that has no rule, gives (-inf, inf). An operation on an operand with an infinite bound gives an infinite
bound, except in the branch that a condition does not take. So if the bounds of an output are finite, everything that it
is made of is defined on the whole box. Nothing is ever proved from infinite bounds. A condition that is true on a part
of a box only is [0, 1].
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numba
import numpy as np

from kinematics.errors import InvalidValue
from kinematics.evaluation.interval_trigonometry import LIMIT, QUARTER, arctangent, far_cosine, shifted_cosine
from kinematics.evaluation.program import Op
from kinematics.evaluation.threads import over_spans

if TYPE_CHECKING:
    from kinematics.evaluation.box_program import BoxProgram

BLOCK = 256  # boxes; half of them in a program of more work rows than
_ROWS = 1000  # so many, which no cache holds
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
    low, high = checked_boxes(program, low, high)
    out = np.zeros((2, low.shape[0], program.outputs))
    p = program

    def run(span: slice) -> None:
        boxes = low[span], high[span], out[0, span], out[1, span]
        _kernel(p.op, p.left, p.right, p.target, p.low, p.high, p.work_size, boxes)

    over_spans(low.shape[0], run)
    return out[0], out[1]


def checked_boxes(program: BoxProgram, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The boxes (k, n) as arrays that a kernel may read.

    Raises:
        InvalidValue: as for `enclose`.
    """
    if low.shape != high.shape or low.ndim != 2 or low.shape[-1] != program.inputs:
        raise InvalidValue("shape of the boxes", (low.shape, high.shape), f"(k, {program.inputs}) twice")
    low, high = np.ascontiguousarray(low, dtype=float), np.ascontiguousarray(high, dtype=float)
    if not (low <= high).all():
        raise InvalidValue("bounds of the boxes", "NaN or a lower bound above the upper one", "low <= high")
    return low, high


def operate(op: Op, left: tuple[float, float], right: tuple[float, float], same: bool = False) -> tuple[float, float]:
    """One operation on one pair of intervals; `same` where both operands are one and the same number."""
    low, high = (np.array([[v], [w], [0.0]]) for v, w in zip(left, right, strict=True))
    apply(int(op), low, high, 0, 0 if same else 1, 2)
    return float(low[2, 0]), float(high[2, 0])


_OPTIONS: dict[str, Any] = {"nogil": True, "cache": True, "error_model": "numpy"}


@numba.njit(**_OPTIONS)
def _kernel(op, left, right, target, least, most, work_size, boxes):  # type: ignore[no-untyped-def]
    low, high, out_low, out_high = boxes
    most_boxes = BLOCK if work_size <= _ROWS else BLOCK // 2
    width = min(most_boxes, (low.shape[0] + 7) // 8 * 8)
    lo, hi = np.zeros((work_size, width)), np.zeros((work_size, width))
    for first in range(0, low.shape[0], width):
        size = min(width, low.shape[0] - first)
        for k in range(op.shape[0]):
            code = op[k]
            x, z = np.uint64(left[k]), np.uint64(target[k])
            if code == OUTPUT:
                for i in range(size):
                    out_low[first + i, z] = lo[x, i]
                    out_high[first + i, z] = hi[x, i]
            elif code == INPUT:
                for i in range(size):
                    lo[z, i] = low[first + i, x]
                    hi[z, i] = high[first + i, x]
                for i in range(size, width):
                    lo[z, i] = lo[z, 0]
                    hi[z, i] = hi[z, 0]
            elif code == CONST:
                for i in range(width):
                    lo[z, i] = least[k]
                    hi[z, i] = most[k]
            else:
                apply(code, lo, hi, x, np.uint64(right[k]), z)


@numba.njit(**_OPTIONS)
def apply(code, lo, hi, x, y, z):  # type: ignore[no-untyped-def]
    """Row z = op(row x, row y) over a block, outward; every NaN becomes an unbounded side.

    Rows are named by number: views of rows would cost more than their arithmetic. No loop branches, so that each
    becomes vector code.
    """
    width = lo.shape[1]
    if code == ADD:
        for i in range(width):
            lo[z, i], hi[z, i] = _out(lo[x, i] + lo[y, i], hi[x, i] + hi[y, i], 0.0)
    elif code == SUB:
        for i in range(width):
            lo[z, i], hi[z, i] = _out(lo[x, i] - hi[y, i], hi[x, i] - lo[y, i], 0.0)
    elif code == SQ or (code == MUL and x == y):
        for i in range(width):
            lo[z, i], hi[z, i] = _square(lo[x, i], hi[x, i])
    elif code == MUL:
        for i in range(width):
            lo[z, i], hi[z, i] = _product(lo[x, i], hi[x, i], lo[y, i], hi[y, i])
    elif code == DIV:
        for i in range(width):
            lo[z, i], hi[z, i] = _quotient(lo[x, i], hi[x, i], lo[y, i], hi[y, i])
    elif code == INV:
        for i in range(width):
            lo[z, i], hi[z, i] = _inverse(lo[x, i], hi[x, i])
    elif code == SQRT:
        for i in range(width):
            lo[z, i], hi[z, i] = _root(lo[x, i], hi[x, i])
    elif code == NEG:
        for i in range(width):
            lo[z, i], hi[z, i] = -hi[x, i], -lo[x, i]
    elif code == TWICE:
        for i in range(width):
            lo[z, i], hi[z, i] = min(2.0 * lo[x, i], _MAX), max(2.0 * hi[x, i], -_MAX)  # exact, but for overflow
    elif code in (COS, SIN):
        shift = 0.0 if code == COS else QUARTER
        for i in range(width):
            lo[z, i], hi[z, i] = shifted_cosine(lo[x, i], hi[x, i], shift)
        for i in range(width):
            if max(-lo[x, i], hi[x, i]) > LIMIT:
                lo[z, i], hi[z, i] = far_cosine(lo[x, i], hi[x, i], shift)
    elif code == ATAN2:
        for i in range(width):
            lo[z, i], hi[z, i] = arctangent(lo[x, i], hi[x, i], lo[y, i], hi[y, i])
    elif code == FMIN:
        for i in range(width):
            lo[z, i], hi[z, i] = _finite(
                min(lo[x, i], lo[y, i]), min(hi[x, i], hi[y, i]), lo[x, i], hi[x, i], lo[y, i], hi[y, i]
            )
    elif code == FMAX:
        for i in range(width):
            lo[z, i], hi[z, i] = _finite(
                max(lo[x, i], lo[y, i]), max(hi[x, i], hi[y, i]), lo[x, i], hi[x, i], lo[y, i], hi[y, i]
            )
    elif code == ASSIGN:
        for i in range(width):
            lo[z, i], hi[z, i] = lo[x, i], hi[x, i]
    else:
        for i in range(width):
            lo[z, i], hi[z, i] = _rare(code, lo[x, i], hi[x, i], lo[y, i], hi[y, i])


@numba.njit(**_OPTIONS, inline="always")
def _out(low, high, tiny):  # type: ignore[no-untyped-def]
    """One unit outward at least; `tiny` where underflow may round too, which sums never do. Overflow gives NaN here."""
    low -= abs(low) * _EPS + tiny
    high += abs(high) * _EPS + tiny
    return (low if low == low else -np.inf), (high if high == high else np.inf)


@numba.njit(**_OPTIONS, inline="always")
def _square(a, b):  # type: ignore[no-untyped-def]
    """A square of what is undefined is undefined."""
    p, q = a * a, b * b
    least = 0.0 if (a <= 0.0) & (b >= 0.0) else min(p, q)
    low, most = _out(least, max(p, q), _TINY)
    return (max(low, 0.0) if most < np.inf else -np.inf), most


@numba.njit(**_OPTIONS, inline="always")
def _product(a, b, c, d):  # type: ignore[no-untyped-def]
    p, q, u, v = a * c, a * d, b * c, b * d
    low, high = _out(min(min(p, q), min(u, v)), max(max(p, q), max(u, v)), _TINY)
    total = p + q + u + v  # NaN where a product is, or where infinities of both signs meet
    defined = total - total == 0.0
    return (low if defined else -np.inf), (high if defined else np.inf)


@numba.njit(**_OPTIONS, inline="always")
def _quotient(a, b, c, d):  # type: ignore[no-untyped-def]
    p, q, u, v = a / c, a / d, b / c, b / d
    low, high = _out(min(min(p, q), min(u, v)), max(max(p, q), max(u, v)), _TINY)
    total = p + q + u + v + (a + b + c + d)
    defined = (total - total == 0.0) & ((c > 0.0) | (d < 0.0))
    return (low if defined else -np.inf), (high if defined else np.inf)


@numba.njit(**_OPTIONS, inline="always")
def _inverse(a, b):  # type: ignore[no-untyped-def]
    low, high = _out(1.0 / b, 1.0 / a, _TINY)
    total = a + b + (1.0 / a + 1.0 / b)
    defined = (total - total == 0.0) & ((a > 0.0) | (b < 0.0))
    return (low if defined else -np.inf), (high if defined else np.inf)


@numba.njit(**_OPTIONS, inline="always")
def _root(a, b):  # type: ignore[no-untyped-def]
    low, high = _out(np.sqrt(abs(a)), np.sqrt(abs(b)), 0.0)
    total = a + b
    defined = (total - total == 0.0) & (a >= 0.0)
    return (max(low, 0.0) if defined else -np.inf), (high if defined else np.inf)


@numba.njit(**_OPTIONS, inline="always")
def _finite(low, high, a, b, c, d):  # type: ignore[no-untyped-def]
    """Nothing where an infinite bound went in."""
    total = a + b + c + d
    defined = total - total == 0.0
    return (low if defined else -np.inf), (high if defined else np.inf)


@numba.njit(**_OPTIONS, inline="never")
def _rare(code, a, b, c, d):  # type: ignore[no-untyped-def]
    """Operations with conditions, one box at a time."""
    if code == IF_ELSE_ZERO:
        return _branch(a, b, c, d)
    total = a + b + c + d
    if total - total != 0.0:  # an infinite bound: something undefined or overflown went in
        return -np.inf, np.inf
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
    return -np.inf, np.inf


@numba.njit(**_OPTIONS, inline="never")
def _branch(a, b, c, d):  # type: ignore[no-untyped-def]
    """[c, d] where the condition [a, b] is not 0, and 0 where it is; both where it is open."""
    if not (np.isfinite(a) and np.isfinite(b)):
        return -np.inf, np.inf
    if a == b == 0.0:
        return 0.0, 0.0
    if a <= 0.0 <= b:
        return min(c, 0.0), max(d, 0.0)
    return c, d
