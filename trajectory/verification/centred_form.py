"""Lower bounds of claims along a path, from interval bounds of the claims and of their gradients."""

from __future__ import annotations

import numpy as np

from kinematics import Array
from trajectory.paths import PathBox

_UP = 1.0 + 2.0**-48  # covers the roundings of products and of their sum over fewer than ten coordinates


def lower_bounds(least: Array, most: Array, point: Array, box: PathBox, half: Array) -> Array:
    """(k, claims) lower bounds over intervals of s: the plain ones, or f(m) - max |f'| r where that is better.

    Args:
        least, most: (k, claims (1 + n)) bounds over `box` of the claims, then of their gradients by the pose.
        point: (k, claims) lower bounds of the claims in the middle of the interval.
        box: bounds of the pose and of its derivative.
        half: (k,) half of the interval, or more.
    """
    count = point.shape[1]
    natural = least[:, :count]
    defined = np.isfinite(natural) & np.isfinite(most[:, :count])  # so smooth on all of the box
    slope = _steepest(least[:, count:], most[:, count:], box, count)
    with np.errstate(invalid="ignore"):
        centred = point - slope * half[:, None] * _UP
        centred -= np.abs(centred) * 2.0**-50
    return np.where(defined & (centred > natural), centred, natural)


def _steepest(least: Array, most: Array, box: PathBox, count: int) -> Array:
    """(k, claims) bound of the modulus of each claim's derivative by s, from its gradient and the path's derivative."""
    shape = (len(least), count, box.low.shape[1])
    gradient = [v.reshape(shape) for v in (least, most)]
    rates = [v[:, None, :] for v in (box.first_low, box.first_high)]
    with np.errstate(invalid="ignore"):
        products = np.stack([g * r for g in gradient for r in rates])
        lowest, highest = products.min(axis=0), products.max(axis=0)
        rounding = np.maximum(np.abs(lowest), np.abs(highest)).sum(axis=-1) * 2.0**-48
        slope = np.maximum(np.abs(lowest.sum(axis=-1)), np.abs(highest.sum(axis=-1))) + rounding
    result: Array = np.nan_to_num(slope, nan=np.inf, posinf=np.inf)
    return result
