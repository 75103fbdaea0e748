"""The part of a map where an index is at least a bound: its area, the index's mean and deviation over it, its boundary.

The map is taken as linear over the four triangles that each cell makes with its middle; the triangles are cut exactly
at the bound and at a curved boundary of the region, and integrated exactly. What remains is the error of that
interpolation, which falls with the square of the step; the grid is refined until no figure moves by more than a
tolerance, and, where that area is as good as none, to the finest, and then close around the part.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from contourpy import contour_generator

from design.budget import Budget
from design.errors import OutOfTime
from design.maps.map_index import Index
from design.maps.sampled_map import Map, Window, map_of, window_of
from design.maps.section import Section
from design.maps.small_part import window_of_part
from kinematics import Array, finite, positive

COARSEST = 33  # nodes along an axis
FINEST = 513
TOLERANCE = 1e-3
_GOOD, _INSET = 2, 3  # columns of a vertex, after its two coordinates


@dataclass(frozen=True)
class Integrals:
    """Area-weighted figures over the part of a section where the index is at least a bound.

    Attributes:
        area: [m^2; m rad or rad^2 where angles are on the axes].
        mean, deviation: of the index over that area; NaN where there is none.
    """

    area: float
    mean: float
    deviation: float

    def moved(self, other: Integrals, whole: float) -> float:
        """The largest change of a figure: the area's over the whole plane's, the others' over the larger of both."""
        if math.isnan(self.mean) or math.isnan(other.mean):
            return 0.0 if self.area == other.area else math.inf  # both empty, or one of them
        level = max(abs(self.mean), self.deviation) or 1.0
        changes = (abs(self.mean - other.mean), abs(self.deviation - other.deviation))
        return max(abs(self.area - other.area) / whole, *(change / level for change in changes))


@dataclass(frozen=True)
class LevelSet:
    """Where an index is at least a bound (at most, for one that is better the smaller).

    Attributes:
        map: the finest one, which the rest is from; close around a part that is small beside the plane.
        bound: in the index's unit; None takes all that is in reach.
        figures: of the finest map.
        coarser: of the map with half as many steps; the difference is what the figures moved by last. NaN where time
            was for one map only.
        moved: the largest change of a figure then, see `Integrals.moved`.
        tolerance: what was asked of it.
    """

    map: Map
    bound: float | None
    figures: Integrals
    coarser: Integrals
    moved: float
    tolerance: float

    @property
    def settled(self) -> bool:
        """Whether the figures stood still; where not, they are the finest grid's, and may be far off."""
        return self.moved <= self.tolerance

    @property
    def whole(self) -> float:
        """Area of the map [m^2; m rad or rad^2 where angles are on the axes]."""
        first, second = self.map.first, self.map.second
        return float((first[-1] - first[0]) * (second[-1] - second[0]))

    @property
    def step(self) -> tuple[float, float]:
        """Between nodes along both axes [m or rad]; a part that is narrower may have been missed."""
        first, second = self.map.first, self.map.second
        return float(first[1] - first[0]), float(second[1] - second[0])

    @property
    def boundary(self) -> list[Array]:
        """Closed polylines (k, 2) around each part and each hole."""
        return boundary(self.map, self.bound)


def level_set(
    index: Index,
    section: Section,
    names: tuple[str, ...],
    bound: float | None,
    tolerance: float = TOLERANCE,
    seconds: float = math.inf,
) -> LevelSet:
    """Map an index on ever finer grids until area, mean and deviation stand still; see `LevelSet.settled`.

    Where an area is within the tolerance of 0 on the finest grid, the part that a few nodes saw, or that climbing from
    the best nodes finds between them, is mapped on grids of its own. An area of 0 is what all this saw: see
    `LevelSet.step`.

    Args:
        index: of `index_of`.
        section: the plane.
        names: the robot's `pose_names`.
        bound: the index is to be at least this (at most, where smaller is better); None: in reach is enough.
        tolerance: the area may move by this part of the map's, mean and deviation by this part of the larger one.
        seconds: after so many the finest map that is complete is the last.

    Raises:
        InvalidRegion, InvalidSection: see `Section.check`.
        InvalidValue: a bound that is not finite, or a tolerance or a time not above 0.
        OutOfTime: not even the coarsest map was complete.
    """
    bound = None if bound is None else finite("bound", bound)
    if math.isfinite(index.least):
        bound = max(index.least, -math.inf if bound is None else bound)
    tolerance, budget = positive("tolerance", tolerance), Budget(seconds)
    section.check(names)
    found = _refined(index, section, names, bound, tolerance, budget, window_of(section))
    while bound is not None and not budget.spent and found.figures.area <= tolerance * found.whole:
        window = window_of_part(index, section, names, found.map, bound, budget)
        if window is None:
            break
        found = _refined(index, section, names, bound, tolerance, budget, window)
    return found


def _refined(
    index: Index,
    section: Section,
    names: tuple[str, ...],
    bound: float | None,
    tolerance: float,
    budget: Budget,
    window: Window,
) -> LevelSet:
    """`level_set` within a window, whose area is the one that counts."""
    whole = math.prod(high - low for low, high in window)
    none = Integrals(math.nan, math.nan, math.nan)
    count, found = COARSEST, None
    while count <= FINEST:
        try:
            chart = map_of(index, section, names, (count, count), window=window, seconds=max(budget.left, 1e-9))
        except OutOfTime:
            if found is None:
                raise
            break
        now = integrals(chart, bound)
        before, moved = (found.figures, now.moved(found.figures, whole)) if found else (none, math.inf)
        found = LevelSet(chart, bound, now, before, moved, tolerance)
        if found.settled and now.area > tolerance * whole:
            break
        count = 2 * count - 1
    assert found is not None
    return found


def integrals(chart: Map, bound: float | None) -> Integrals:
    """The figures of one map."""
    triangles = _triangles(chart)
    if bound is not None:
        triangles = _clipped(triangles, _GOOD, bound)
    triangles = _clipped(triangles, _INSET, 0.0)
    (ax, ay), (bx, by) = (np.moveaxis(triangles[:, k, :2] - triangles[:, 0, :2], -1, 0) for k in (1, 2))
    areas = 0.5 * np.abs(ax * by - ay * bx)
    total = float(areas.sum())
    if total == 0.0:
        return Integrals(0.0, math.nan, math.nan)
    values = triangles[:, :, _GOOD]
    mean = float((areas * values.mean(axis=1)).sum() / total)
    values = values - mean
    squares = ((values**2).sum(axis=1) + values.sum(axis=1) ** 2) / 12.0  # of a linear function over a triangle
    deviation = math.sqrt(float((areas * squares).sum() / total))
    return Integrals(total, mean, deviation)


def boundary(chart: Map, bound: float | None) -> list[Array]:
    """Closed polylines (k, 2) around the part of the plane where the index is at least the bound."""
    good = chart.values
    spare = np.where(np.isnan(good), np.nan, 1.0)
    if np.isnan(good).all():
        return []
    if bound is not None:
        spare = good - bound
    if np.isfinite(chart.inset).all():
        scale = np.nanmax(np.abs(spare)) / np.abs(chart.inset).max()
        spare = np.minimum(spare, scale * chart.inset)
    generator = contour_generator(chart.first, chart.second, np.ma.masked_invalid(spare), fill_type="OuterOffset")
    filled: Any = generator.filled(0.0, np.inf)  # all points of each polygon, and where its rings start and end
    return [ring for points, starts in zip(*filled, strict=True) for ring in np.split(points, starts[1:-1])]


def _triangles(chart: Map) -> Array:
    """(t, 3, 4) vertices (first, second, value, inset); those with a vertex out of reach are left out."""
    first, second = np.meshgrid(chart.first, chart.second)
    inset = np.where(np.isinf(chart.inset), 1.0, chart.inset)
    nodes = np.stack([first, second, chart.values, inset], axis=-1)
    corners = [nodes[:-1, :-1], nodes[:-1, 1:], nodes[1:, 1:], nodes[1:, :-1]]
    middle = sum(corners) / 4.0
    sides = [np.stack([corners[k], corners[(k + 1) % 4], middle], axis=-2) for k in range(4)]
    triangles = np.concatenate([side.reshape(-1, 3, 4) for side in sides])
    result: Array = triangles[np.isfinite(triangles[:, :, _GOOD]).all(axis=1)]
    return result


def _clipped(triangles: Array, column: int, level: float) -> Array:
    """The parts (s, 3, 4) of triangles (t, 3, 4) where a column, linear over each, is at least a level."""
    inside = triangles[:, :, column] >= level
    count = inside.sum(axis=1)
    parts = [triangles[count == 3]]
    for many, odd in ((1, True), (2, False)):
        some = triangles[count == many]
        if not len(some):
            continue
        # Turn each triangle so that the vertex that differs from the other two comes first.
        turn = (np.argmax(inside[count == many] == odd, axis=1)[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(some, turn[:, :, None], axis=1), 1, 0)
        ab, ac = _cut(a, b, column, level), _cut(a, c, column, level)
        corners = [(a, ab, ac)] if odd else [(ab, b, c), (ab, c, ac)]
        parts += [np.stack(corner, axis=1) for corner in corners]
    return np.concatenate(parts)


def _cut(a: Array, b: Array, column: int, level: float) -> Array:
    """(s, 4) where the edges from a to b cross the level."""
    share = (level - a[:, column]) / (b[:, column] - a[:, column])
    result: Array = a + share[:, None] * (b - a)
    return result
