"""The rules of affine forms: each operation as z = a x + b y + shift + rest with |rest| <= extra.

x and y are anywhere in their intervals. Any numbers a, b and shift will do if `extra` covers what they leave out. Here
they are those of the best chord of a root and of an inverse, and of the tangent of nearly everything else. Where the
interval of z is unbounded nothing is claimed, so there a rule may give anything, NaN too.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from kinematics.evaluation.interval_interpreter import (
    ADD,
    ASSIGN,
    ATAN2,
    COS,
    DIV,
    FABS,
    FMAX,
    FMIN,
    IF_ELSE_ZERO,
    INV,
    MUL,
    NEG,
    SIN,
    SQ,
    SQRT,
    SUB,
    TWICE,
)
from kinematics.evaluation.interval_trigonometry import LIMIT, QUARTER, shifted_cosine
from kinematics.evaluation.vector_arctangent import angle

CENTRE, RADIUS, REMAINDER, SLOPES = 0, 1, 2, 3  # the parts of a form; RADIUS is the sum of the slopes' moduli
A, B, SHIFT, EXTRA = 0, 1, 2, 3  # the numbers of a rule
NOISE = 2.0**-48  # 32 times what one operation is off by: covers some sums and products over fewer than ten slopes
TINY = 1e-300  # covers underflow
_OPTIONS: dict[str, Any] = {"nogil": True, "cache": True, "error_model": "numpy"}
_INLINE: dict[str, Any] = {**_OPTIONS, "inline": "always"}


@numba.njit(**_OPTIONS)
def rule(code, lo, hi, form, x, y, z, shared, by):  # type: ignore[no-untyped-def]
    """Write the rule of row z = op(row x, row y), whose interval is known, into `by` (4, width).

    `shared` has a bit for each coordinate that moves both operands.
    """
    width = lo.shape[1]
    if code in (ADD, SUB):
        _same(by, 1.0, 1.0 if code == ADD else -1.0)
    elif code in (NEG, TWICE, ASSIGN):
        _same(by, -1.0 if code == NEG else 2.0 if code == TWICE else 1.0, 0.0)
    elif code == SQ or (code == MUL and x == y):
        for i in range(width):
            c, half = form[x, CENTRE, i], 0.5 * _away(lo, hi, form, x, i) ** 2
            by[A, i], by[B, i], by[SHIFT, i], by[EXTRA, i] = 2.0 * c, 0.0, half - c * c, half
    elif code == MUL:
        _product(lo, hi, form, x, y, shared, by)
    elif code == DIV:
        for i in range(width):
            by[A, i], by[B, i], by[SHIFT, i], by[EXTRA, i] = _quotient(lo, hi, form, x, y, i)
    elif code == SQRT:
        for i in range(width):
            by[A, i], by[B, i], by[SHIFT, i], by[EXTRA, i] = _root(lo[x, i], hi[x, i])
    elif code == INV:
        for i in range(width):
            by[A, i], by[B, i], by[SHIFT, i], by[EXTRA, i] = _inverse(lo[x, i], hi[x, i])
    elif code in (COS, SIN):
        for i in range(width):
            by[A, i], by[B, i], by[SHIFT, i], by[EXTRA, i] = _wave(lo, hi, form, x, z, i, code == SIN)
    elif code == ATAN2:
        for i in range(width):
            by[A, i], by[B, i], by[SHIFT, i], by[EXTRA, i] = _angle(lo, hi, form, x, y, i)
    elif code == FABS:
        for i in range(width):
            share, loss = _positive_part(lo[x, i], hi[x, i])
            by[A, i], by[B, i], by[SHIFT, i], by[EXTRA, i] = 2.0 * share - 1.0, 0.0, loss, loss
    elif code in (FMIN, FMAX):
        larger, sign = (A, 1.0) if code == FMAX else (B, -1.0)
        for i in range(width):
            share, loss = _positive_part(lo[x, i] - hi[y, i], hi[x, i] - lo[y, i])
            by[larger, i], by[B - larger, i] = share, 1.0 - share
            by[SHIFT, i], by[EXTRA, i] = 0.5 * sign * loss, 0.5 * loss
    else:
        _interval_alone(lo, hi, z, by)
        if code == IF_ELSE_ZERO:
            for i in range(width):
                if lo[x, i] > 0.0 or hi[x, i] < 0.0:
                    by[A, i], by[B, i], by[SHIFT, i], by[EXTRA, i] = 0.0, 1.0, 0.0, 0.0


@numba.njit(**_INLINE)
def _same(by, a, b):  # type: ignore[no-untyped-def]
    """Exactly a x + b y, in each box."""
    by[A, :], by[B, :], by[SHIFT, :], by[EXTRA, :] = a, b, 0.0, 0.0


@numba.njit(**_INLINE)
def _interval_alone(lo, hi, z, by):  # type: ignore[no-untyped-def]
    """Where nothing but the interval is known."""
    for i in range(lo.shape[1]):
        middle = 0.5 * lo[z, i] + 0.5 * hi[z, i]
        radius = max(hi[z, i] - middle, middle - lo[z, i])
        by[A, i], by[B, i], by[SHIFT, i], by[EXTRA, i] = 0.0, 0.0, middle, radius


@numba.njit(**_INLINE)
def _away(lo, hi, form, x, i):  # type: ignore[no-untyped-def]
    """How far row x may be from its centre."""
    c = form[x, CENTRE, i]
    seen = max(hi[x, i] - c, c - lo[x, i])
    return min(seen, form[x, RADIUS, i] + form[x, REMAINDER, i]) * (1.0 + NOISE)


@numba.njit(**_OPTIONS)
def _product(lo, hi, form, x, y, shared, by):  # type: ignore[no-untyped-def]
    """The tangent plane d x + c y - c d at the centres c and d leaves out (x - c)(y - d).

    In this product each t_k^2 is in [0, 1], so half of its factor moves to the shift.
    """
    width, count = lo.shape[1], (form.shape[1] - SLOPES) // 2
    by[SHIFT, :], by[EXTRA, :] = 0.0, 0.0
    for k in range(count):
        if shared >> k & 1:
            row = np.uint64(SLOPES + k)
            for i in range(width):
                both = form[x, row, i] * form[y, row, i]
                by[SHIFT, i] += both
                by[EXTRA, i] += abs(both)
    for i in range(width):
        c, d = form[x, CENTRE, i], form[y, CENTRE, i]
        plain = _away(lo, hi, form, x, i) * _away(lo, hi, form, y, i)
        most = (form[x, RADIUS, i] + form[x, REMAINDER, i]) * (form[y, RADIUS, i] + form[y, REMAINDER, i])
        split = most * (1.0 + NOISE) - 0.5 * by[EXTRA, i]
        better = split < plain
        by[A, i], by[B, i] = d, c
        by[SHIFT, i] = (0.5 * by[SHIFT, i] if better else 0.0) - c * d
        by[EXTRA, i] = (split if better else plain) + abs(c * d) * NOISE


@numba.njit(**_INLINE)
def _quotient(lo, hi, form, x, y, i):  # type: ignore[no-untyped-def]
    """x / y = q + (x - q y) / y, where x - q y is about 0 in the middle, and 1 / y is a, give or take an error."""
    c, d = form[x, CENTRE, i], form[y, CENTRE, i]
    p, r = 1.0 / hi[y, i], 1.0 / lo[y, i]
    q, a = c / d, 0.5 * p + 0.5 * r
    error = 0.5 * abs(r - p) + abs(a) * NOISE
    most = abs(c - q * d) + form[x, REMAINDER, i] + abs(q) * form[y, REMAINDER, i] + TINY
    for k in range(SLOPES, SLOPES + (form.shape[1] - SLOPES) // 2):
        most += abs(form[x, k, i] - q * form[y, k, i])
    size = abs(c) + form[x, RADIUS, i] + abs(q) * (abs(d) + form[y, RADIUS, i] + form[y, REMAINDER, i])
    extra = (most + size * NOISE) * error * (1.0 + NOISE) + abs(a) * size * NOISE
    return a, -a * q, q, extra


@numba.njit(**_INLINE)
def _root(low, high):  # type: ignore[no-untyped-def]
    """A root lies between its chord over the interval and the tangent along it."""
    p, q = np.sqrt(abs(low)), np.sqrt(abs(high))
    slope = 1.0 / (p + q)
    chord, tangent = p * q * slope, 0.25 * (p + q)
    return slope, 0.0, 0.5 * (chord + tangent), 0.5 * abs(tangent - chord) + q * NOISE


@numba.njit(**_INLINE)
def _inverse(low, high):  # type: ignore[no-untyped-def]
    """An inverse lies between its chord over the interval, which does not hold 0, and the tangent along it."""
    p, q = 1.0 / low, 1.0 / high
    chord, tangent = p + q, 2.0 * np.sqrt(abs(p * q)) * np.sign(p)
    return -p * q, 0.0, 0.5 * (chord + tangent), 0.5 * abs(chord - tangent) + abs(chord) * NOISE


@numba.njit(**_INLINE)
def _wave(lo, hi, form, x, z, i, sine):  # type: ignore[no-untyped-def]
    """The tangent of cosine or sine at the centre; the second derivative is minus the function, which z bounds."""
    near = max(abs(lo[x, i]), abs(hi[x, i])) <= LIMIT
    c = min(max(form[x, CENTRE, i], lo[x, i]), hi[x, i]) if near else 0.0
    d = max(hi[x, i] - c, c - lo[x, i]) * (1.0 + NOISE)
    low, high = shifted_cosine(c, c, QUARTER if sine else 0.0)
    p, q = shifted_cosine(c, c, 0.0 if sine else QUARTER)
    slope = (0.5 * p + 0.5 * q) * (1.0 if sine else -1.0)
    least, most = -0.5 * d * d * max(hi[z, i], 0.0), -0.5 * d * d * min(lo[z, i], 0.0)
    shift = 0.5 * (low + high) - slope * c + 0.5 * (least + most)
    extra = 0.5 * (high - low) + 0.5 * (q - p) * d + 0.5 * (most - least) + (1.0 + abs(c) + d * d) * NOISE
    return slope, 0.0, shift, extra if near else np.inf


@numba.njit(**_INLINE)
def _angle(lo, hi, form, x, y, i):  # type: ignore[no-untyped-def]
    """atan2(x, y) by the mean-value theorem; its gradient is (y, -x) / (x^2 + y^2)."""
    a, b, c, d = lo[x, i], hi[x, i], lo[y, i], hi[y, i]
    p, q = min(max(form[x, CENTRE, i], a), b), min(max(form[y, CENTRE, i], c), d)
    near, far = min(max(a, 0.0), b) ** 2 + min(max(c, 0.0), d) ** 2, max(a * a, b * b) + max(c * c, d * d)
    u, u_error = _over(c, d, near, far)
    v, v_error = _over(-b, -a, near, far)
    rest = u_error * max(b - p, p - a) + v_error * max(d - q, q - c)
    extra = rest * (1.0 + NOISE) + (4.0 + abs(u * p) + abs(v * q)) * NOISE
    return u, v, angle(p, q) - u * p - v * q, extra


@numba.njit(**_INLINE)
def _over(a, b, near, far):  # type: ignore[no-untyped-def]
    """Middle and radius of [a, b] / [near, far], near > 0."""
    low, high = (a / far if a > 0.0 else a / near), (b / near if b > 0.0 else b / far)
    return 0.5 * (low + high), 0.5 * (high - low) + (abs(low) + abs(high)) * NOISE


@numba.njit(**_INLINE)
def _positive_part(low, high):  # type: ignore[no-untyped-def]
    """share and loss such that share e <= max(e, 0) <= share e + loss for e in [low, high]."""
    low, high = min(low * (1.0 + NOISE), 0.0), max(high * (1.0 + NOISE), 0.0)
    share = high / (high - low) if low < 0.0 else 1.0
    return share, share * ((high - low) * NOISE - low)
