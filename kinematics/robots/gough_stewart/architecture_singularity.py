"""Find hexapods whose legs are dependent at every pose, and name the reason.

The determinant of the inverse Jacobian is a polynomial of the pose, so it vanishes everywhere as soon as it vanishes at
a few poses without special position. The best-known reasons are named: Ma and Angeles (1991) for similar regular
hexagons, Husty and Karger (2000) and Roeschel and Mick (1998) for planar images of points on one conic.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics import displacement

POSES = 8
DEPENDENT = 1e-6  # smallest over largest singular value: a geometry this close is as good as singular
_SAME = 1e-9  # coincidence, relative to the size of the base or platform


def why_singular(base: Array, platform: Array) -> str | None:
    """Why the legs from `base` (6, 3) to `platform` (6, 3), each in its own frame, are dependent at every pose.

    Returns:
        The reason in words, or None where the six legs are independent at some pose.
    """
    a, b = _normalised(base), _normalised(platform)
    twins = [(i, j) for i in range(6) for j in range(i) if _coincide(a, i, j) and _coincide(b, i, j)]
    if twins:
        return f"legs {twins[0][1] + 1} and {twins[0][0] + 1} are one leg: both their ends coincide"
    for name, points in (("base", a), ("platform", b)):
        if _rank(points) < 2:
            return f"the {name} points lie on one line, about which the platform turns freely"
    if dependence(base, platform) >= DEPENDENT:
        return None
    return _planar_reason(a, b) or _shared_point(a, b) or "its legs are linearly dependent at every pose"


def dependence(base: Array, platform: Array) -> float:
    """Largest ratio of the smallest to the largest singular value of the legs' lines over eight generic poses."""
    a, b = _normalised(base), _normalised(platform)
    rotation, translation = displacement(np.random.default_rng(8).normal(size=(POSES, 8)))
    ends = translation[:, None, :] + np.einsum("kij,lj->kli", rotation, b)
    legs = ends - a
    u = legs / np.linalg.norm(legs, axis=-1, keepdims=True)
    lines = np.concatenate([u, np.cross(ends - translation[:, None, :], u)], axis=-1)
    values = np.linalg.svd(lines, compute_uv=False)
    return float(np.max(values[:, -1] / values[:, 0]))


def _normalised(points: Array) -> Array:
    """About their centroid, with mean square radius 1; unchanged where all coincide."""
    centred = points - points.mean(axis=0)
    size = math.sqrt(np.mean(np.sum(centred**2, axis=1)))
    result: Array = centred / size if size > 0.0 else centred
    return result


def _coincide(points: Array, i: int, j: int) -> bool:
    return bool(np.linalg.norm(points[i] - points[j]) <= _SAME)


def _rank(points: Array) -> int:
    values = np.linalg.svd(points, compute_uv=False)
    return int(np.sum(values > _SAME))


def _shared_point(a: Array, b: Array) -> str | None:
    for name, points in (("base", a), ("platform", b)):
        for i in range(6):
            legs = [j + 1 for j in range(6) if _coincide(points, i, j)]
            if len(legs) > 3:
                return f"legs {', '.join(map(str, legs))} meet in one {name} point, which three legs hold already"
    return None


def _planar_reason(a: Array, b: Array) -> str | None:
    """Planar points related by a similarity, an affinity or a collineation, with the base on a conic."""
    if _rank(a) != 2 or _rank(b) != 2:
        return None
    u, v = (_in_plane(points) for points in (a, b))
    if not _on_conic(u):
        return None
    for word, holds in (
        ("similar to", _similar),
        ("an affine image of", _affine),
        ("a projective image of", _projective),
    ):
        if holds(u, v):
            return f"the platform is {word} the base, whose six points lie on one conic"
    return None


def _in_plane(points: Array) -> Array:
    """(6, 2) coordinates in the points' plane."""
    result: Array = points @ np.linalg.svd(points)[2][:2].T
    return result


def _dependent(matrix: Array) -> bool:
    values = np.linalg.svd(matrix, compute_uv=False)
    return bool(values[-1] <= DEPENDENT * values[0])


def _on_conic(u: Array) -> bool:
    x, y = u.T
    return _dependent(np.stack([x * x, x * y, y * y, x, y, np.ones(6)], axis=1))


def _similar(u: Array, v: Array) -> bool:
    """|v| over u, turned and reflected or not: both have mean square radius 1 already."""
    z, w = u @ [1.0, 1.0j], v @ [1.0, 1.0j]
    return any(abs(abs(np.vdot(z, other)) / 6.0 - 1.0) <= DEPENDENT for other in (w, w.conj()))


def _affine(u: Array, v: Array) -> bool:
    fit, *_ = np.linalg.lstsq(u, v, rcond=None)
    return bool(np.abs(u @ fit - v).max() <= DEPENDENT)


def _projective(u: Array, v: Array) -> bool:
    """v x (H u) = 0 has a solution H."""
    p, zero = np.column_stack([u, np.ones(6)]), np.zeros((6, 3))
    rows = np.concatenate([np.hstack([p, zero, -v[:, :1] * p]), np.hstack([zero, p, -v[:, 1:] * p])])
    _, values, right = np.linalg.svd(rows)
    return bool(values[-1] <= DEPENDENT * values[0]) and not _dependent(right[-1].reshape(3, 3))
