"""The part of a map where an index is at least a bound: its area, the index's mean and deviation over it, its boundary.

The map is taken as linear over the four triangles that each cell makes with its middle; the triangles are cut exactly
at the bound and at a curved boundary of the region, and integrated exactly. What remains is the error of that
interpolation, which falls with the square of the step; the grid is refined until no figure moves by more than a
tolerance, and, where no node is good, to the finest: no finding says no more than that.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from contourpy import contour_generator

from design.errors import NotConverged
from design.index import Index
from design.maps import Map, map_of
from design.section import Section
from kinematics.errors import InvalidValue

Array = np.ndarray
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
        map: the finest one, which the rest is from.
        bound: in the index's unit; None takes all that is in reach.
        figures: of the finest map.
        coarser: of the map with half as many steps; the difference is what the figures moved by last.
    """

    map: Map
    bound: float | None
    figures: Integrals
    coarser: Integrals

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
    index: Index, section: Section, names: tuple[str, ...], bound: float | None, tolerance: float = TOLERANCE
) -> LevelSet:
    """Map an index on ever finer grids until area, mean and deviation stand still.

    An area of 0 is what the finest grid saw: see `LevelSet.step`.

    Args:
        index: of `index_of`.
        section: the plane.
        names: the robot's `pose_names`.
        bound: the index is to be at least this (at most, where smaller is better); None: in reach is enough.
        tolerance: the area may move by this part of the plane's, mean and deviation by this part of the larger one.

    Raises:
        InvalidRegion, InvalidSection: see `Section.check`.
        InvalidValue: a bound that is not finite, or a tolerance not above 0.
        NotConverged: they still move on the finest grid.
    """
    if bound is not None and not math.isfinite(bound):
        raise InvalidValue("bound", bound, "a finite number")
    if not (math.isfinite(tolerance) and tolerance > 0.0):
        raise InvalidValue("tolerance", tolerance, "a finite number > 0")
    section.check(names)
    whole = math.prod(high - low for low, high in (section.region.intervals[n] for n in section.axes))
    count, before, moved = COARSEST, None, math.inf
    while count <= FINEST:
        chart = map_of(index, section, names, (count, count))
        now = integrals(chart, bound)
        if before is not None:
            moved = now.moved(before, whole)
            if moved <= tolerance and (now.area > 0.0 or count == FINEST):
                return LevelSet(chart, bound, now, before)
        before, count = now, 2 * count - 1
    hint = "ask for less, or map `reach` where the edge of reach is the boundary"
    raise NotConverged(f"area, mean or deviation of {index.name}", moved, tolerance, hint)


def integrals(chart: Map, bound: float | None) -> Integrals:
    """The figures of one map."""
    triangles = _triangles(chart)
    if bound is not None:
        triangles = _clipped(triangles, _GOOD, -bound if chart.smaller_is_better else bound)
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
    return Integrals(total, -mean if chart.smaller_is_better else mean, deviation)


def boundary(chart: Map, bound: float | None) -> list[Array]:
    """Closed polylines (k, 2) around the part of the plane where the index is at least the bound."""
    good = chart.goodness
    spare = np.where(np.isnan(good), np.nan, 1.0)
    if np.isnan(good).all():
        return []
    if bound is not None:
        spare = good + bound if chart.smaller_is_better else good - bound
    if np.isfinite(chart.inset).all():
        scale = np.nanmax(np.abs(spare)) / np.abs(chart.inset).max()
        spare = np.minimum(spare, scale * chart.inset)
    generator = contour_generator(chart.first, chart.second, np.ma.masked_invalid(spare), fill_type="OuterOffset")
    filled: Any = generator.filled(0.0, np.inf)  # all points of each polygon, and where its rings start and end
    return [ring for points, starts in zip(*filled, strict=True) for ring in np.split(points, starts[1:-1])]


def _triangles(chart: Map) -> Array:
    """(t, 3, 4) vertices (first, second, goodness, inset); those with a vertex out of reach are left out."""
    first, second = np.meshgrid(chart.first, chart.second)
    inset = np.where(np.isinf(chart.inset), 1.0, chart.inset)
    nodes = np.stack([first, second, chart.goodness, inset], axis=-1)
    corners = [nodes[:-1, :-1], nodes[:-1, 1:], nodes[1:, 1:], nodes[1:, :-1]]
    middle = sum(corners) / 4.0
    sides = [np.stack([corners[k], corners[(k + 1) % 4], middle], axis=-2) for k in range(4)]
    triangles = np.concatenate([side.reshape(-1, 3, 4) for side in sides])
    return triangles[np.isfinite(triangles[:, :, _GOOD]).all(axis=1)]


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
    return a + share[:, None] * (b - a)
