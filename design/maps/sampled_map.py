"""Maps: an index on a grid over a section, the worst over the coordinates that the section leaves open.

The worst is a dense grid's, followed downhill from its lowest local minima: an upper bound of the true one, close but
not proved; for a proof see `certified`. Poses pass by in chunks, so memory is bounded by the map itself.
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

REST = {0: 1, 1: 49, 2: 13, 3: 7, 4: 5}  # poses along each coordinate of the rest, by how many there are
Window = tuple[tuple[float, float], tuple[float, float]]  # lower and upper bound of both axes
_MINIMA = 3  # local minima that are followed downhill
_ROUNDS = 22  # of descent: halvings end at a millionth of the grid's step
_CHUNK = 1 << 18  # poses


@dataclass(frozen=True, eq=False)
class Map(Value):
    """An index over a plane.

    Attributes:
        section: the plane.
        index: its name.
        first, second: (a,), (b,) values of the two axes [m or rad].
        values: (b, a) the worst at each node, NaN where some pose behind it is out of reach; also beyond a curved
            boundary, where it continues the map.
        poses: (b, a, n) where that is.
        inset: (b, a) how far the node is inside a curved boundary of the region, negative beyond it [m]; inf: none.
    """

    section: Section
    index: str
    first: Array
    second: Array
    values: Array
    poses: Array
    inset: Array

    @property
    def lowest(self) -> tuple[float, Array]:
        """Worst value of the nodes in the region and its pose (n,); -inf where one is out of reach."""
        good = np.where(np.isnan(self.values), -np.inf, self.values)
        row, column = np.unravel_index(int(np.where(self.inset >= 0.0, good, np.inf).argmin()), good.shape)
        return float(good[row, column]), self.poses[row, column]


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
        counts: nodes along the two axes, 2 or more.
        window: bounds of both axes, a part of the region's; these by default.
        seconds: how long it may take.

    Raises:
        InvalidRegion, InvalidSection: see `Section.check`.
        InvalidValue: a count below 2, or a time not above 0.
        OutOfTime: it takes longer.
    """
    section.check(names)
    first, second = (
        np.linspace(low, high, whole("nodes of a map along an axis", count, 2))
        for (low, high), count in zip(window or window_of(section), counts, strict=True)
    )
    points = np.stack(np.meshgrid(first, second), axis=-1)
    good, poses = worst_behind(index, section, names, points.reshape(-1, 2), Budget(seconds))
    values = np.where(np.isinf(good) & (good < 0), np.nan, good).reshape(points.shape[:2])
    poses = poses.reshape(*points.shape[:2], len(names))
    return Map(section, index.name, first, second, values, poses, section.inset(points))


def window_of(section: Section) -> Window:
    """Of the whole plane."""
    first, second = (section.region.intervals[name] for name in section.axes)
    return first, second


def worst_behind(
    index: Index, section: Section, names: tuple[str, ...], points: Array, budget: Budget | None = None
) -> tuple[Array, Array]:
    """The lowest goodness (k,) over all poses behind each point (k, 2), -inf out of reach, and its pose (k, n).

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
    """`worst_behind` of one chunk and one listed combination; unit (g, r) is the grid of the rest."""
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
    """Of values (k, g) on the grid (g, r): rows (m,) and unit points (m, r) of each row's lowest local minima."""
    count, rest = len(values), unit.shape[1]
    each = round(values.shape[1] ** (1.0 / rest))
    grid = values.reshape(count, *(each,) * rest)
    minima = np.where(grid <= minimum_filter(grid, size=(1, *(3,) * rest)), grid, np.inf).reshape(count, -1)
    columns = np.argpartition(minima, _MINIMA, axis=1)[:, :_MINIMA]
    node, pick = np.nonzero(np.isfinite(np.take_along_axis(minima, columns, axis=1)))
    return node, unit[columns[node, pick]]
