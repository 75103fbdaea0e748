"""Affine evaluation of a box program over boxes: lower bounds that know how values change together.

Every row holds an interval, as in `interval_interpreter`, and an affine form

    value = centre + sum_k slope_k t_k + rest,    |t_k| <= 1,    |rest| <= remainder,

with one t_k for each coordinate of the box. What two values have in common cancels in their difference, so what is lost
is of second order in the size of the box. The interval is cut to what the form allows, and the rule of the next
operation (`affine_rules`) relies on the interval. So every value on the way is as tight as both together. Nothing needs
a derivative, and a kink or a jump is an operation like any other.

A bend for each slope tells how much of the remainder is due to that coordinate. It only helps to choose cuts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numba
import numpy as np

from kinematics.evaluation.affine_rules import CENTRE, EXTRA, NOISE, RADIUS, REMAINDER, SHIFT, SLOPES, TINY, A, B, rule
from kinematics.evaluation.interval_interpreter import CONST, INPUT, OUTPUT, apply, checked_boxes
from kinematics.evaluation.threads import over_spans

if TYPE_CHECKING:
    from kinematics.evaluation.box_program import BoxProgram

BLOCK = 64  # boxes
_OPTIONS: dict[str, Any] = {"nogil": True, "cache": True, "error_model": "numpy"}


def bound_below(
    program: BoxProgram, low: np.ndarray, high: np.ndarray, moving: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """A number that no output falls below, for each box, and what to cut where that is negative.

    Args:
        low, high: (k, n) the boxes' bounds, one column an input.
        moving: (c,) the columns that have a slope. The others are unknown within their bounds.

    Returns:
        (k,) the bound, never NaN; -inf where an output may be undefined, inf without outputs. (k, c) how much each of
        `moving` moves or blurs an output whose bound is negative, at most; inf where that is not known.

    Raises:
        InvalidValue: as for `enclose`.
    """
    least, moves = np.full(len(low), np.inf), np.zeros((len(low), len(moving)))
    _run(program, low, high, moving, (least, moves, np.empty((0, 0, 2 + 2 * len(moving)))))
    return least, moves


class AffineForms(NamedTuple):
    """Outputs r of a program over k boxes: value <= upper, and value <= most + sum_c slopes_c t_c with |t_c| <= 1.

    Attributes:
        upper, most: (k, r); inf where an output may be undefined.
        slopes: (k, r, c); 0 where nothing is known of how the output moves.
        bends: (k, r, c) how much each coordinate blurs the output; NaN or infinite if unknown.
    """

    upper: np.ndarray
    most: np.ndarray
    slopes: np.ndarray
    bends: np.ndarray


def affine_forms(program: BoxProgram, low: np.ndarray, high: np.ndarray, moving: np.ndarray) -> AffineForms:
    """Upper bounds of each output, and how it moves; arguments and errors as of `bound_below`."""
    count = len(moving)
    forms = np.empty((len(low), program.outputs, 2 + 2 * count))
    _run(program, low, high, moving, (np.empty(len(low)), np.empty((len(low), count)), forms))
    return AffineForms(forms[:, :, 0], forms[:, :, 1], forms[:, :, 2 : 2 + count], forms[:, :, 2 + count :])


def _run(
    program: BoxProgram, low: np.ndarray, high: np.ndarray, moving: np.ndarray, out: tuple[np.ndarray, ...]
) -> None:
    """Fill the arrays of `out`: least bounds, moves, and forms unless there are none."""
    low, high = checked_boxes(program, low, high)
    slope_of = np.full(program.inputs, -1, dtype=np.int64)
    slope_of[moving] = np.arange(len(moving))
    p = program

    def run(span: slice) -> None:
        boxes = low[span], high[span], *(part[span] for part in out)
        _kernel(p.op, p.left, p.right, p.target, p.low, p.high, p.work_size, slope_of, boxes)

    over_spans(low.shape[0], run)


@numba.njit(**_OPTIONS)
def _kernel(op, left, right, target, least, most, work_size, slope_of, boxes):  # type: ignore[no-untyped-def]
    low, high, out_least, out_moves, out_forms = boxes
    count = out_moves.shape[1]
    width = min(BLOCK, (low.shape[0] + 7) // 8 * 8)
    lo, hi, by = np.zeros((work_size, width)), np.zeros((work_size, width)), np.zeros((4, width))
    form = np.zeros((work_size, SLOPES + 2 * count, width))
    moved_by = np.zeros(work_size, dtype=np.int64)  # a bit for each coordinate that moves the row
    for first in range(0, low.shape[0], width):
        size = min(width, low.shape[0] - first)
        for k in range(op.shape[0]):
            code = op[k]
            x, y, z = np.uint64(left[k]), np.uint64(right[k]), np.uint64(target[k])
            if code == OUTPUT:
                _write(lo, form, x, out_least[first : first + size], out_moves[first : first + size])
                if out_forms.shape[0]:
                    _copy(hi, form, x, out_forms[first : first + size, z])
            elif code == INPUT:
                for i in range(width):
                    box = first + min(i, size - 1)
                    lo[z, i], hi[z, i] = low[box, x], high[box, x]
                moved_by[z] = 1 << slope_of[x] if slope_of[x] >= 0 else 0
                _load(lo, hi, form, z, slope_of[x])
            elif code == CONST:
                lo[z, :], hi[z, :] = least[k], most[k]
                moved_by[z] = 0
                _load(lo, hi, form, z, -1)
            else:
                shared, moved_by[z] = moved_by[x] & moved_by[y], moved_by[x] | moved_by[y]
                apply(code, lo, hi, x, y, z)
                if moved_by[z] == 0:
                    _load(lo, hi, form, z, -1)
                else:
                    rule(code, lo, hi, form, x, y, z, shared, by)
                    _combine(form, by, x, y, z, moved_by[z])
                    _settle(lo, hi, form, z)


@numba.njit(**_OPTIONS)
def _write(lo, form, x, least, moves):  # type: ignore[no-untyped-def]
    """Let row x, an output, count in its boxes."""
    size, count = moves.shape
    for i in range(size):
        least[i] = min(least[i], lo[x, i])
        if lo[x, i] >= 0.0:
            continue
        for k in range(count):
            move = abs(form[x, SLOPES + k, i]) + form[x, SLOPES + count + k, i]
            moves[i, k] = max(moves[i, k], move if move == move else np.inf)


@numba.njit(**_OPTIONS)
def _copy(hi, form, x, forms):  # type: ignore[no-untyped-def]
    """Row x, an output, as in `AffineForms`."""
    for i in range(forms.shape[0]):
        most = form[x, CENTRE, i] + form[x, REMAINDER, i]
        forms[i, 0] = hi[x, i]
        forms[i, 1] = most + abs(most) * NOISE + TINY
        for k in range(2, forms.shape[1]):
            forms[i, k] = form[x, SLOPES + k - 2, i]


@numba.njit(**_OPTIONS)
def _load(lo, hi, form, z, slope):  # type: ignore[no-untyped-def]
    """The form of row z from its interval: with one slope, or all remainder if that is -1."""
    form[z, :, :] = 0.0
    for i in range(lo.shape[1]):
        middle = 0.5 * lo[z, i] + 0.5 * hi[z, i]
        radius = max(hi[z, i] - middle, middle - lo[z, i]) * (1.0 + NOISE)
        bounded = radius < np.inf
        form[z, CENTRE, i] = middle if bounded else 0.0
        if slope >= 0 and bounded:
            form[z, RADIUS, i] = form[z, SLOPES + slope, i] = radius
        else:
            form[z, REMAINDER, i] = radius if bounded else np.inf


@numba.njit(**_OPTIONS)
def _combine(form, by, x, y, z, moved_by):  # type: ignore[no-untyped-def]
    """Row z = a x + b y + shift. The remainder grows by `extra` and by all rounding, the bends by `extra`."""
    width, count = form.shape[2], (form.shape[1] - SLOPES) // 2
    for i in range(width):
        a, b, p, q = abs(by[A, i]), abs(by[B, i]), by[A, i] * form[x, CENTRE, i], by[B, i] * form[y, CENTRE, i]
        form[z, CENTRE, i] = p + q + by[SHIFT, i]
        size = abs(p) + abs(q) + abs(by[SHIFT, i]) + a * form[x, RADIUS, i] + b * form[y, RADIUS, i]
        rest = a * form[x, REMAINDER, i] + b * form[y, REMAINDER, i] + by[EXTRA, i]
        form[z, REMAINDER, i] = rest * (1.0 + NOISE) + size * NOISE + TINY
        form[z, RADIUS, i] = 0.0
        by[SHIFT, i] = 0.5 * by[EXTRA, i] / (form[x, RADIUS, i] + form[x, REMAINDER, i] + TINY)
        by[EXTRA, i] = 0.5 * by[EXTRA, i] / (form[y, RADIUS, i] + form[y, REMAINDER, i] + TINY)
    for k in range(count):
        slope, bend = np.uint64(SLOPES + k), np.uint64(SLOPES + count + k)
        if moved_by >> k & 1 == 0:
            form[z, slope, :], form[z, bend, :] = 0.0, 0.0
            continue
        for i in range(width):
            p, q, r, t = form[x, slope, i], form[y, slope, i], form[x, bend, i], form[y, bend, i]
            both = by[A, i] * p + by[B, i] * q
            form[z, slope, i] = both
            form[z, RADIUS, i] += abs(both)
            blurred = by[SHIFT, i] * (abs(p) + r) + by[EXTRA, i] * (abs(q) + t)
            form[z, bend, i] = abs(by[A, i]) * r + abs(by[B, i]) * t + blurred


@numba.njit(**_OPTIONS)
def _settle(lo, hi, form, z):  # type: ignore[no-untyped-def]
    """Cut the interval to what the form allows; where the form says less than the interval, let it say as much."""
    poor = 0
    for i in range(lo.shape[1]):
        c = form[z, CENTRE, i]
        spread = (form[z, RADIUS, i] + form[z, REMAINDER, i]) * (1.0 + NOISE) + abs(c) * NOISE
        bounded = (hi[z, i] - lo[z, i] < np.inf) & (spread < np.inf)
        lo[z, i] = max(lo[z, i], c - spread) if bounded else lo[z, i]
        hi[z, i] = min(hi[z, i], c + spread) if bounded else hi[z, i]
        good = bounded & (form[z, REMAINDER, i] < 0.5 * (hi[z, i] - lo[z, i]))
        form[z, RADIUS, i] = form[z, RADIUS, i] if good else -1.0
        poor += 0 if good else 1
    if poor:
        _give_up(lo, hi, form, z)


@numba.njit(**_OPTIONS)
def _give_up(lo, hi, form, z):  # type: ignore[no-untyped-def]
    """Where the radius is -1, a form that is all remainder."""
    width, count = form.shape[2], (form.shape[1] - SLOPES) // 2
    for k in range(count):
        slope, bend = np.uint64(SLOPES + k), np.uint64(SLOPES + count + k)
        for i in range(width):
            poor, was = form[z, RADIUS, i] < 0.0, form[z, slope, i]
            form[z, slope, i] = 0.0 if poor else was
            form[z, bend, i] += abs(was) if poor else 0.0
    for i in range(width):
        poor = form[z, RADIUS, i] < 0.0
        middle = 0.5 * lo[z, i] + 0.5 * hi[z, i]
        radius = max(hi[z, i] - middle, middle - lo[z, i]) * (1.0 + NOISE)
        bounded = radius < np.inf
        form[z, CENTRE, i] = (middle if bounded else 0.0) if poor else form[z, CENTRE, i]
        form[z, REMAINDER, i] = (radius if bounded else np.inf) if poor else form[z, REMAINDER, i]
        form[z, RADIUS, i] = 0.0 if poor else form[z, RADIUS, i]
