"""Maps: the values of an index on a grid over a section, each the worst over the section's other coordinates.

The worst value comes from a dense grid and from descents that start at its worst points. The true worst value is at
least as bad, close but not proved. For proofs see `certified_cells`. Poses are made in chunks, so that memory
holds little more than the map.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.ndimage import minimum_filter

from design.budget import Budget
from design.errors import OutOfTime
from design.maps.map_index import Index
from design.maps.section import Section
from design.sampling import descend
from kinematics import Array, Value, whole

REST = {0: 1, 1: 49, 2: 13, 3: 7, 4: 5}  # number of other coordinates: poses along each of them
Window = tuple[tuple[float, float], tuple[float, float]]  # lower and upper bound of both axes
_MINIMA = 3  # local minima that a descent starts from
_ROUNDS = 22  # rounds of a descent: its step ends near a millionth of the grid's step
_CHUNK = 1 << 18  # poses


@dataclass(frozen=True, eq=False)
class Map(Value):
    """An index over a plane.

    Attributes:
        section: the plane.
        index, sense: the index's name and sense.
        first, second: (a,), (b,) values of the two axes [m or rad].
        values: (b, a) the worst value at each node; NaN if some pose of the node is out of reach. Nodes outside a
            curved boundary have values too, so that the map can be interpolated up to it.
        poses: (b, a, n) the pose with this value.
        inset: (b, a) distance of the node inside a curved boundary of the region, negative outside [m]; inf without
            one.
    """

    section: Section
    index: str
    sense: int
    first: Array
    second: Array
    values: Array
    poses: Array
    inset: Array

    @property
    def good(self) -> Array:
        """(b, a) the values, negative if smaller is better."""
        result: Array = self.sense * self.values
        return result

    @property
    def worst(self) -> tuple[float, Array]:
        """Worst value of the nodes in the region and its pose (n,); infinitely bad if one is out of reach."""
        good = np.where(np.isnan(self.values), -np.inf, self.good)
        row, column = np.unravel_index(int(np.where(self.inset >= 0.0, good, np.inf).argmin()), good.shape)
        return self.sense * float(good[row, column]), self.poses[row, column]


def map_of(
    index: Index,
    section: Section,
    names: tuple[str, ...],
    counts: tuple[int, int],
    *,
    window: Window | None = None,
    seconds: float = math.inf,
) -> Map:
    """Map an index.

    Args:
        index: of `index_of`.
        section: the plane.
        names: the robot's `pose_names`.
        counts: number of nodes along each of the two axes, 2 or more.
        window: bounds of both axes, within the region's bounds; by default the region's bounds.
        seconds: the time that the map may take [s].

    Raises:
        InvalidRegion, InvalidSection: see `Section.check`.
        InvalidValue: a count is below 2, or the time is not above 0.
        OutOfTime: the map needs more time.
    """
    section.check(names)
    first, second = (
        np.linspace(low, high, whole("nodes of a map along an axis", count, 2))
        for (low, high), count in zip(window or window_of(section), counts, strict=True)
    )
    points = np.stack(np.meshgrid(first, second), axis=-1)
    good, poses = worst_behind(index, section, names, points.reshape(-1, 2), Budget(seconds))
    values = index.sense * np.where(np.isinf(good) & (good < 0), np.nan, good).reshape(points.shape[:2])
    poses = poses.reshape(*points.shape[:2], len(names))
    return Map(section, index.name, index.sense, first, second, values, poses, section.inset(points))


def window_of(section: Section) -> Window:
    """The window of the whole plane."""
    first, second = (section.region.intervals[name] for name in section.axes)
    return first, second


def worst_behind(
    index: Index, section: Section, names: tuple[str, ...], points: Array, budget: Budget | None = None
) -> tuple[Array, Array]:
    """The lowest goodness (k,) over all poses of each point (k, 2), -inf out of reach, and the pose (k, n) with it.

    Raises:
        OutOfTime: the budget is used up before the last point.
    """
    rest = len(section.rest(names))
    each = REST.get(rest, 3)
    unit = np.array(list(product(np.linspace(0.0, 1.0, each), repeat=rest)))
    good, poses = np.empty(len(points)), np.empty((len(points), len(names)))
    listed = section.listed()
    step = max(1, _CHUNK // (len(unit) * len(listed)))
    for first in range(0, len(points), step):
        if budget is not None and budget.spent:
            raise OutOfTime(f"map of {index.name}", budget.seconds, f"{first} of {len(points)} nodes")
        part = slice(first, first + step)
        found = [_worst(index, section, names, points[part], one, unit) for one in listed]
        values, where = (np.stack(column) for column in zip(*found, strict=True))
        lowest, rows = values.argmin(axis=0), np.arange(values.shape[1])
        good[part], poses[part] = values[lowest, rows], where[lowest, rows]
    return good, poses


def _worst(
    index: Index, section: Section, names: tuple[str, ...], points: Array, listed: Mapping[str, float], unit: Array
) -> tuple[Array, Array]:
    """`worst_behind` for one chunk and one listed combination; unit (g, r) is the grid of the other coordinates."""
    count, rest = len(points), unit.shape[1]

    def poses_at(node: Array, where: Array) -> Array:
        return section.poses(points[node], listed, where, names)

    every = np.broadcast_to(np.arange(count)[:, None], (count, len(unit)))
    values = index.goodness(poses_at(every, np.broadcast_to(unit, (*every.shape, rest))))
    rows, columns = np.arange(count), values.argmin(axis=1)
    best, where = values[rows, columns], unit[columns].copy()
    if rest:
        node, start = _local_minima(values, unit)

        def value(trial: Array) -> Array:
            nodes = node.reshape(-1, *(1,) * (trial.ndim - 2))
            return index.goodness(poses_at(np.broadcast_to(nodes, trial.shape[:-1]), trial))

        each = round(len(unit) ** (1.0 / rest))
        found, lowest = descend(value, start, np.full(rest, 1.0 / (each - 1)), _ROUNDS)
        order = np.argsort(-lowest, kind="stable")  # so that a node's lowest is written last
        best[node[order]], where[node[order]] = lowest[order], found[order]
    return best, poses_at(rows, where)


def _local_minima(values: Array, unit: Array) -> tuple[Array, Array]:
    """The lowest local minima of each row of values (k, g) on the grid (g, r): their rows (m,) and points (m, r)."""
    count, rest = len(values), unit.shape[1]
    each = round(values.shape[1] ** (1.0 / rest))
    grid = values.reshape(count, *(each,) * rest)
    minima = np.where(grid <= minimum_filter(grid, size=(1, *(3,) * rest)), grid, np.inf).reshape(count, -1)
    columns = np.argpartition(minima, _MINIMA, axis=1)[:, :_MINIMA]
    node, pick = np.nonzero(np.isfinite(np.take_along_axis(minima, columns, axis=1)))
    return node, unit[columns[node, pick]]
