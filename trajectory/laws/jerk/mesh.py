"""The knots of the jerk law: those of the path, and others where the motion is slow or exceeds its rows."""

from __future__ import annotations

import numpy as np

from kinematics import Array
from trajectory.laws.jerk.limit_rows import PARTS, progress_at
from trajectory.laws.jerk.motion import SquaredRate
from trajectory.paths import Path

LEAST_IN_PIECE = 6  # least intervals between two knots of the path; a corner needs so many
_BY_TIME = 0.8  # share of the knots at equal times; the others are at equal u
_BY_EXCESS = 0.2  # share of all knots that are placed where rows are exceeded between the stations
_SHORTEST = 1e-10  # in u: closer knots of the path count as one


def piece_edges(path: Path) -> Array:
    """(p + 1,) u at the path's own knots, from 0 to 1."""
    inside = progress_at(np.array(path.knots[1:-1]) / path.length)
    edges = [0.0]
    for u in inside:
        if u - edges[-1] > _SHORTEST and 1.0 - u > _SHORTEST:
            edges.append(float(u))
    return np.array([*edges, 1.0])


def first_mesh(edges: Array, intervals: int) -> Array:
    """Knots of u, about evenly, each piece between the path's knots with a few."""
    return _divided(edges, np.array([0.0, 1.0]), np.array([0.0, 1.0]), intervals)


def next_mesh(edges: Array, motion: SquaredRate, over: Array, intervals: int) -> Array:
    """About so many intervals of u for a motion that is known.

    The excess between stations falls with the square of an interval's size. So knots with a density proportional to its
    square root make the excess even.

    Args:
        edges: of the pieces.
        motion: of n intervals.
        over: (n,) what each exceeds of a row that is 1.
        intervals: wanted; more where the pieces are many.
    """
    parts = motion.finer(PARTS)
    times, root = parts.times(), np.repeat(np.sqrt(over), PARTS)
    filled = (1.0 - _BY_TIME) * parts.knots + _BY_TIME * times / times[-1]
    if root.any():
        exceeded = np.concatenate([[0.0], np.cumsum(root)]) / root.sum()
        filled = (1.0 - _BY_EXCESS) * filled + _BY_EXCESS * exceeded
    return _divided(edges, parts.knots, filled, intervals)


def _divided(edges: Array, knots: Array, filled: Array, intervals: int) -> Array:
    """Each piece in parts that fill the same share of `filled` (k,), which rises from 0 to 1 over the knots."""
    at_edges = np.interp(edges, knots, filled)
    parts = []
    for k in range(edges.size - 1):
        count = max(LEAST_IN_PIECE, round(intervals * (at_edges[k + 1] - at_edges[k])))
        inside = at_edges[k] + (at_edges[k + 1] - at_edges[k]) * np.arange(1, count) / count
        parts += [edges[k : k + 1], np.interp(inside, filled, knots)]
    return np.concatenate([*parts, edges[-1:]])
