"""Rigid displacements as points of Study's quadric, in which a leg of given length is a quadric too.

x = (e, f), two quaternions in eight homogeneous coordinates. The rotation is that of e and the displacement's
translation p enters as 2 f = p e, so that e . f = 0 (Study's quadric) and, with K = e . e,

    K R b = e b e*,   K p = 2 f e*,   K R^T p = 2 e* f,   K |p|^2 = 4 f . f.

|p + R b - a|^2 = q^2 times K is then quadratic in x. Formulation: Husty, Mechanism and Machine Theory 31 (1996).
"""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Array


def leg_quadrics(base: Array, platform: Array, squares: Array) -> Array:
    """(..., m, 3), (..., m, 3), (..., m) points a, b and squared lengths q^2 -> (..., m, 8, 8) symmetric matrices.

    Real or complex: nothing is conjugated.
    """
    inner = np.sum(base * platform, axis=-1)
    constant = np.sum(base * base, axis=-1) + np.sum(platform * platform, axis=-1) - squares
    outer = base[..., :, None] * platform[..., None, :]
    cross = np.cross(platform, base)
    result = np.zeros((*constant.shape, 8, 8), dtype=np.result_type(base, platform, squares, float))
    result[..., range(4), range(4)] = constant[..., None]
    result[..., range(4, 8), range(4, 8)] = 4.0
    result[..., 0, 0] -= 2.0 * inner
    result[..., 0, 1:4] = result[..., 1:4, 0] = -2.0 * cross
    result[..., 1:4, 1:4] -= 2.0 * (outer + np.swapaxes(outer, -1, -2) - inner[..., None, None] * np.eye(3))
    mixed = np.zeros((*inner.shape, 4, 4), dtype=result.dtype)
    mixed[..., 0, 1:] = 2.0 * (platform - base)
    mixed[..., 1:, 0] = -2.0 * (platform - base)
    mixed[..., 1:, 1:] = 2.0 * skew(base + platform)
    result[..., :4, 4:] = mixed
    result[..., 4:, :4] = np.swapaxes(mixed, -1, -2)
    return result


def study_quadric() -> Array:
    """(1, 8, 8) the matrix of 2 e . f."""
    return np.kron(np.array([[0.0, 1.0], [1.0, 0.0]]), np.eye(4))[None]


def skew(v: Array) -> Array:
    """(..., 3) -> (..., 3, 3), v x as a matrix."""
    result = np.zeros((*v.shape, 3), dtype=v.dtype)
    result[..., 0, 1], result[..., 0, 2] = -v[..., 2], v[..., 1]
    result[..., 1, 0], result[..., 1, 2] = v[..., 2], -v[..., 0]
    result[..., 2, 0], result[..., 2, 1] = -v[..., 1], v[..., 0]
    return result


def point(rotation: Array, translation: Array) -> Array:
    """(..., 3, 3) and (..., 3), real -> (..., 8) of norm 1."""
    e = quaternion(rotation)
    f = 0.5 * _product(np.concatenate([np.zeros_like(translation[..., :1]), translation], axis=-1), e)
    x = np.concatenate([e, f], axis=-1)
    result: Array = x / np.linalg.norm(x, axis=-1, keepdims=True)
    return result


def displacement(x: Array) -> tuple[Array, Array]:
    """(..., 8) with K != 0 -> rotation (..., 3, 3) and translation (..., 3)."""
    e, f = x[..., :4], x[..., 4:]
    size = np.sum(e * e, axis=-1)[..., None]
    conjugate = e * np.array([1.0, -1.0, -1.0, -1.0])
    scalar, vector = e[..., :1], e[..., 1:]
    outer = vector[..., :, None] * vector[..., None, :]
    square = (scalar**2 - np.sum(vector**2, axis=-1, keepdims=True))[..., None]
    rotation = square * np.eye(3) + 2.0 * outer + 2.0 * scalar[..., None] * skew(vector)
    return rotation / size[..., None], 2.0 * _product(f, conjugate)[..., 1:] / size


def quaternion(rotation: Array) -> Array:
    """(..., 3, 3) -> (..., 4) unit quaternion, scalar first; from the largest of four forms: well-conditioned."""
    r = rotation
    trace = np.trace(r, axis1=-2, axis2=-1)
    k = np.empty((*trace.shape, 4, 4))
    k[..., 0, 0] = 1.0 + trace
    k[..., 0, 1:] = k[..., 1:, 0] = np.stack(
        [r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0], r[..., 1, 0] - r[..., 0, 1]], axis=-1
    )
    k[..., 1:, 1:] = r + np.swapaxes(r, -1, -2) + (1.0 - trace)[..., None, None] * np.eye(3)
    best = np.argmax(np.einsum("...ii->...i", k), axis=-1)
    row = np.take_along_axis(k, best[..., None, None], axis=-2)[..., 0, :]
    result: Array = row / np.linalg.norm(row, axis=-1, keepdims=True)
    return result


def _product(p: Array, q: Array) -> Array:
    """Quaternion product, scalar first."""
    scalar = p[..., :1] * q[..., :1] - np.sum(p[..., 1:] * q[..., 1:], axis=-1, keepdims=True)
    vector = p[..., :1] * q[..., 1:] + q[..., :1] * p[..., 1:] + np.cross(p[..., 1:], q[..., 1:])
    return np.concatenate([scalar, vector], axis=-1)
