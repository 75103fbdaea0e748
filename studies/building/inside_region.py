"""Proof that a way stays inside a region, at every pose.

The way gives bounds of the pose over intervals of itself, and these are halved where they reach out of the region. A
region is convex, and bounded coordinate by coordinate but for its circle about the z axis: a box of poses is inside
where its lower, its upper and its outermost corner are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from design import Region
from kinematics import Array, Value
from trajectory import Way

TOLERANCE = 1e-6  # rad, or of the region's size, by which a way may leave it: it may run along the boundary
_START = 64  # intervals, at least, that the way is cut into first
_SMALLEST = 1e-9  # of the length: narrower intervals are not halved


@dataclass(frozen=True, eq=False)
class Leaving(Value):
    """Where a way is outside the region, or could not be proved not to be.

    Attributes:
        pose: (n,) the one furthest out, of the ends and middles of the intervals looked at.
        room: how far it is inside, so negative [m or rad].
    """

    pose: Array
    room: float


def leaving(region: Region, way: Way, names: Sequence[str]) -> Leaving | None:
    """The pose of a way that is furthest outside; None where all of it is proved to be inside, to `TOLERANCE`."""
    grown = region.grown(TOLERANCE)
    edges = np.unique(np.concatenate([way.knots, np.linspace(0.0, way.length, _START + 1)]))
    low, high = edges[:-1], edges[1:]
    found: Leaving | None = None
    while low.size:
        middle = 0.5 * low + 0.5 * high
        box, (poses,) = way.enclose(low, high), way.evaluate(np.stack([low, middle, high]), 0)
        outermost = np.where(np.abs(box.low) > np.abs(box.high), box.low, box.high)
        least = np.min([grown.room(corner, names) for corner in (box.low, box.high, outermost)], axis=0)
        rooms = grown.room(poses, names)
        worst, one = rooms.argmin(axis=0), np.arange(low.size)
        room, poses = rooms[worst, one], poses[worst, one]
        stuck = (high - low <= _SMALLEST * way.length) & ~(least >= 0.0)
        outside = ~(room >= 0.0) | stuck
        if outside.any():
            room = np.where(stuck, np.minimum(least, room), room)
            k = int(np.where(outside, room, np.inf).argmin())
            if found is None or room[k] < found.room:
                found = Leaving(poses[k], float(min(room[k], region.room(poses[k], names))))
        still = ~(least >= 0.0) & ~outside
        low, high, middle = low[still], high[still], middle[still]
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return found
