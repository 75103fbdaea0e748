"""Distances between straight members, over arrays of poses."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics.arrays import Array

_NO_LENGTH = 1e-100  # m^2: a segment with a smaller square is a point
_PARALLEL = 1e-14  # squared sine of the angle below which only rounding is left of it


def segment_distances(one: Array, two: Array) -> Array:
    """Distance between two segments, each (..., 2, 3) with its ends one a row [m].

    The nearest points are either both inside, on the lines' common perpendicular, or one of them is an end: the
    smallest of five candidates is exact for parallel, crossing and degenerate segments too.

    Returns:
        (...,) [m]; NaN where an end is NaN.
    """
    (a, b), (c, d) = (np.moveaxis(np.asarray(s, dtype=float), -2, 0) for s in (one, two))
    ends = np.minimum(_point_to_segment(a, c, d), _point_to_segment(b, c, d))
    ends = np.minimum(ends, np.minimum(_point_to_segment(c, a, b), _point_to_segment(d, a, b)))
    result: Array = np.fmin(ends, _perpendicular(a, b, c, d))
    return result


def nearest_symbolic(one: ca.SX, two: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """The shortest way (3,) from one segment to another, each (3, 2) with its ends in columns [m]; and its two ends.

    These are shares of the segments, 0 at the first column and 1 at the second.

    The nearest point of the first segment's line, held within the segment; of the second, nearest to it, held within;
    and of the first again. As the square is convex, no further turn is needed. Parallel segments start from any point:
    both numerator and determinant are 0 there. Within 1e-7 rad of parallel, 1e-7 of the length may be lost.
    NaN where an end is NaN.
    """
    a, c = one[:, 0], two[:, 0]
    u, v, w = one[:, 1] - a, two[:, 1] - c, c - a
    uu, vv = ca.fmax(ca.dot(u, u), _NO_LENGTH), ca.fmax(ca.dot(v, v), _NO_LENGTH)
    uv, uw, vw = ca.dot(u, v), ca.dot(u, w), ca.dot(v, w)
    s = _within((uw * vv - vw * uv) / ca.fmax(uu * vv - uv * uv, _PARALLEL * uu * vv))
    t = _within((s * uv - vw) / vv)
    s = _within((uw + t * uv) / uu)
    return w + t * v - s * u, s, t


def _within(share: ca.SX) -> ca.SX:
    return ca.fmax(0, ca.fmin(1, share))


def _point_to_segment(p: Array, a: Array, b: Array) -> Array:
    along = b - a
    square = _dot(along, along)
    t = np.divide(_dot(p - a, along), square, out=np.zeros_like(square), where=square > 0.0)
    result: Array = np.linalg.norm(p - a - np.clip(t, 0.0, 1.0)[..., None] * along, axis=-1)
    return result


def _perpendicular(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Length of the common perpendicular where its feet lie inside both segments; NaN elsewhere."""
    u, v, w = b - a, d - c, c - a
    uu, uv, vv, uw, vw = _dot(u, u), _dot(u, v), _dot(v, v), _dot(u, w), _dot(v, w)
    det = uu * vv - uv * uv
    skew = det > _PARALLEL * uu * vv  # nearly parallel: an end is as near
    det = np.where(skew, det, 1.0)
    s, t = (uw * vv - vw * uv) / det, (uw * uv - vw * uu) / det
    inside = skew & (s > 0) & (s < 1) & (t > 0) & (t < 1)
    return np.where(inside, np.linalg.norm(s[..., None] * u - t[..., None] * v - w, axis=-1), np.nan)


def _dot(u: Array, v: Array) -> Array:
    result: Array = (u * v).sum(axis=-1)
    return result
