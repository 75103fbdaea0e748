"""Orientations: R = Rz(yaw) Ry(pitch) Rx(roll), and rotations about any axis."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics.rigid_displacements import skew


def rotation(angles: Array) -> Array:
    """(..., 3) roll, pitch, yaw [rad] -> (..., 3, 3)."""
    (cr, cp, cy), (sr, sp, sy) = np.moveaxis(np.cos(angles), -1, 0), np.moveaxis(np.sin(angles), -1, 0)
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def rotation_symbolic(angles: ca.SX) -> ca.SX:
    """(3,) roll, pitch, yaw -> (3, 3)."""
    (cr, cp, cy), (sr, sp, sy) = ([f(angles[k]) for k in range(3)] for f in (ca.cos, ca.sin))
    return ca.vertcat(
        ca.horzcat(cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
        ca.horzcat(sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
        ca.horzcat(-sp, cp * sr, cp * cr),
    )


def angles(matrix: Array) -> Array:
    """(..., 3, 3) -> (..., 3) roll, pitch, yaw [rad], pitch within a quarter turn of zero.

    Where the pitch is a quarter turn, only yaw - roll (or yaw + roll) has a meaning; the three still give the matrix.
    """
    yaw = np.arctan2(matrix[..., 1, 0], matrix[..., 0, 0])
    c, s = np.cos(yaw), np.sin(yaw)
    pitch = np.arctan2(-matrix[..., 2, 0], c * matrix[..., 0, 0] + s * matrix[..., 1, 0])
    roll = np.arctan2(s * matrix[..., 0, 2] - c * matrix[..., 1, 2], c * matrix[..., 1, 1] - s * matrix[..., 0, 1])
    return np.stack([roll, pitch, yaw], axis=-1)


def turn(vector: Array) -> Array:
    """(..., 3) axis times angle [rad] -> (..., 3, 3), rot(u, theta); by a quaternion, so smooth at zero."""
    half = 0.5 * np.linalg.norm(vector, axis=-1)[..., None]
    v = 0.5 * np.sinc(half / np.pi) * vector
    scalar = np.cos(half)[..., None]
    outer = v[..., :, None] * v[..., None, :]
    result: Array = (2.0 * scalar**2 - 1.0) * np.eye(3) + 2.0 * outer + 2.0 * scalar * skew(v)
    return result
