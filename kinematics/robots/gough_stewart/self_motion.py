"""Poses of a 6-UPS platform that are not isolated: with its legs locked, the platform can still move.

Where a path of the continuation ends at a point of deficient rank, a small step along each null direction is brought
back onto the quadrics by Gauss-Newton. From a multiple but isolated point it falls back; on a continuum it stays away.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from kinematics.arrays import Array
from kinematics.errors import LinkwrightError

_FINITE = 1e-8  # |e . e| of a unit point that is a pose
_STEP = 0.02  # along a null direction, between unit points
_AWAY = 0.1 * _STEP  # a solution as far as this is another one
_DEFICIENT = 1e-4  # ratio of singular values from which a null direction is tried
_RANK = 1e-6  # ratio of singular values below which Gauss-Newton leaves a direction alone
_CLOSED = 1e-12  # error of the quadrics, of norm 1, at a solution
_ITERATIONS = 40  # a step away from a multiple point is halved in each


class SelfMotion(LinkwrightError):
    """The platform can move with its joints locked, so its assembly modes are not isolated and have no list.

    Attributes:
        pose: (6,) one pose of the motion.
        dimension: of the motion about that pose.
    """

    exit_status = 1

    def __init__(self, pose: Sequence[float], dimension: int) -> None:
        self.pose, self.dimension = tuple(float(v) for v in pose), dimension
        where = ", ".join(f"{v:.6g}" for v in self.pose)
        super().__init__(
            f"assembly modes: found a self-motion of dimension {dimension} through pose ({where}), which moves with "
            "these joints locked; expected isolated poses"
        )


def on_continuum(system: Array, points: Array) -> Array:
    """(7, 8, 8) quadrics, (k, 8) solutions -> (k,) dimension of the solutions about each; 0 if isolated or no pose."""
    system = system / np.linalg.norm(system, axis=(1, 2), keepdims=True)
    finite = np.abs(np.sum(points[:, :4] ** 2, axis=1)) > _FINITE
    return np.array([_dimension(system, x) if pose else 0 for x, pose in zip(points, finite, strict=True)], dtype=int)


def real_point(system: Array, points: Array) -> tuple[Array, int] | None:
    """A real point (8,) that is not isolated, and the dimension there, from complex ones (k, 8); None if not found."""
    system = system / np.linalg.norm(system, axis=(1, 2), keepdims=True)
    starts = np.concatenate([points.real, points.real + points.imag, points.real - points.imag])
    settled = _settled(system, starts)
    size = np.sum(settled[:, :4] ** 2, axis=1)
    for x in settled[(_error(system, settled) < _CLOSED) & (size > _FINITE)]:
        dimension = _dimension(system, x)
        if dimension:
            return x, dimension
    return None


def _dimension(system: Array, x: Array) -> int:
    x = _settled(system, x[None])[0]
    _, values, vectors = np.linalg.svd(np.vstack([2.0 * system @ x, x.conj()]))
    null = vectors[values < _DEFICIENT * values[0]].conj()
    if not len(null):
        return 0
    moved = _settled(system, x + _STEP * null) - x
    stayed = (_error(system, x + moved) < _CLOSED) & (np.linalg.norm(moved, axis=1) > _AWAY)
    return int(np.sum(np.linalg.svd(moved[stayed], compute_uv=False) > _AWAY)) if stayed.any() else 0


def _settled(system: Array, points: Array) -> Array:
    """(k, 8) unit points brought to the nearest solutions by Gauss-Newton; real ones stay real."""
    points = points / np.linalg.norm(points, axis=1, keepdims=True)
    for _ in range(_ITERATIONS):
        jacobian = np.einsum("aij,kj->kai", system, points)
        value = np.einsum("kai,ki->ka", jacobian, points)
        change = (np.linalg.pinv(2.0 * jacobian, rcond=_RANK) @ value[..., None])[..., 0]
        points = points - change
        points /= np.linalg.norm(points, axis=1, keepdims=True)
    return points


def _error(system: Array, points: Array) -> Array:
    result: Array = np.abs(np.einsum("aij,ki,kj->ka", system, points, points)).max(axis=1)
    return result
