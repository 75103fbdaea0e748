"""Matrices S that make a given one nearly the identity: what claims are scaled with, box by box."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Array


def near_inverse(values: Array) -> Array:
    """(k, m, n) -> (k, n, n) the inverse of a square matrix, or R^-1 of the QR factors; the identity where unusable."""
    size = np.abs(values).max(axis=(-2, -1), initial=0.0)
    usable = np.isfinite(size) & (size > 1e-30) & (size < 1e30)  # NaN is neither
    eye = np.eye(values.shape[-1])
    result = np.broadcast_to(eye, (len(values), *eye.shape)).copy()
    size = size[usable][:, None, None]
    values = values[usable] / size
    if values.shape[-2] != values.shape[-1]:
        values = np.linalg.cholesky(np.swapaxes(values, -1, -2) @ values + 1e-14 * eye, upper=True)
    regular = np.abs(np.linalg.det(values)) > 1e-200
    result[np.flatnonzero(usable)[regular]] = np.linalg.inv(values[regular]) / size[regular]
    return result
