"""Proof that a way stays inside a region, at every pose.

The way gives bounds of the pose over each of its intervals. An interval whose bounds leave the region is halved. A
region is convex. It bounds each coordinate alone, except for its circle about the z axis. So a box of poses is inside
if three corners are: the lowest, the highest, and the one furthest from the z axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from design import Region
from kinematics import Array, Value
from trajectory import Way

TOLERANCE = 1e-6  # rad, or times the region's size: a way may leave by this, as it may run along the boundary
_START = 64  # the way is first cut into at least so many intervals
_SMALLEST = 1e-9  # times the way's length: narrower intervals are not halved


@dataclass(frozen=True, eq=False)
class Leaving(Value):
    """A pose where a way is outside the region, or cannot be proved to be inside.

    Attributes:
        pose: (n,) the pose furthest outside, of the ends and middles of the tested intervals.
        room: its distance inside the region's boundary, so negative [m or rad].
    """

    pose: Array
    room: float


def leaving(region: Region, way: Way, names: Sequence[str]) -> Leaving | None:
    """The pose of a way that is furthest outside; None if the whole way is proved to be inside, to `TOLERANCE`."""
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
