"""Distances between straight members, over arrays of poses."""

from __future__ import annotations

import numpy as np

Array = np.ndarray


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
    return np.fmin(ends, _perpendicular(a, b, c, d))


def _point_to_segment(p: Array, a: Array, b: Array) -> Array:
    along = b - a
    square = _dot(along, along)
    t = np.divide(_dot(p - a, along), square, out=np.zeros_like(square), where=square > 0.0)
    return np.linalg.norm(p - a - np.clip(t, 0.0, 1.0)[..., None] * along, axis=-1)


def _perpendicular(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Length of the common perpendicular where its feet lie inside both segments; NaN elsewhere."""
    u, v, w = b - a, d - c, c - a
    uu, uv, vv, uw, vw = _dot(u, u), _dot(u, v), _dot(v, v), _dot(u, w), _dot(v, w)
    det = uu * vv - uv * uv
    skew = det > 1e-14 * uu * vv  # nearly parallel: an end is as near
    det = np.where(skew, det, 1.0)
    s, t = (uw * vv - vw * uv) / det, (uw * uv - vw * uu) / det
    inside = skew & (s > 0) & (s < 1) & (t > 0) & (t < 1)
    return np.where(inside, np.linalg.norm(s[..., None] * u - t[..., None] * v - w, axis=-1), np.nan)


def _dot(u: Array, v: Array) -> Array:
    return (u * v).sum(axis=-1)
