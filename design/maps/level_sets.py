"""The level set: the part of a map where an index keeps a bound. Its area, boundary, mean and deviation.

Each cell and its middle make four triangles. The map is taken as linear over each triangle. The triangles are cut
exactly at the bound and at a curved boundary of the region, and integrated exactly. The only error is that of this
interpolation; it falls with the square of the step. The grid is refined until no figure changes by more than a
tolerance. If the area is almost zero, the grid is refined to the finest, and then a grid close around the part is used.
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
_SAME = 1e-9  # of its size: how much an index may differ that does not change over the plane
_ROUNDING = 1e-13  # of the mean: smaller deviations are the rounding of the sums
_GOOD, _INSET = 2, 3  # columns of a vertex, after its two coordinates


@dataclass(frozen=True)
class Integrals:
    """Area-weighted figures over the part of a section where the index keeps a bound.

    Attributes:
        area: [m^2; m rad or rad^2 if angles are on the axes].
        mean, deviation: of the index over that area; NaN if the area is 0.
    """

    area: float
    mean: float
    deviation: float

    def moved(self, other: Integrals, whole: float) -> float:
        """The largest relative change of a figure: the area over the whole plane, others over the larger value."""
        if math.isnan(self.mean) or math.isnan(other.mean):
            return 0.0 if self.area == other.area else math.inf  # both empty, or one of them
        level = max(abs(self.mean), self.deviation) or 1.0
        changes = (abs(self.mean - other.mean), abs(self.deviation - other.deviation))
        return max(abs(self.area - other.area) / whole, *(change / level for change in changes))


@dataclass(frozen=True)
class LevelSet:
    """The part where an index is at least a bound (at most, for an index that should be small).

    Attributes:
        map: the finest map, which all else comes from. If the part is small, the map is close around it.
        bound: in the index's unit; None takes all that is in reach.
        figures: those of the finest map.
        coarser: those of the map with half as many steps, to show the last change. NaN if there was time for only one
            map.
        moved: the largest change between the two, see `Integrals.moved`.
        tolerance: the change that was allowed.
    """

    map: Map
    bound: float | None
    figures: Integrals
    coarser: Integrals
    moved: float
    tolerance: float

    @property
    def settled(self) -> bool:
        """Whether the figures changed by no more than the tolerance. If not, they may be far off."""
        return self.moved <= self.tolerance

    @property
    def whole(self) -> float:
        """Area of the map [m^2; m rad or rad^2 if angles are on the axes]."""
        first, second = self.map.first, self.map.second
        return float((first[-1] - first[0]) * (second[-1] - second[0]))

    @property
    def step(self) -> tuple[float, float]:
        """Distance between nodes along both axes [m or rad]. The map may miss a narrower part."""
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
    """Map an index on finer and finer grids until area, mean and deviation stop changing; see `LevelSet.settled`.

    If the area on the finest grid is 0 to the tolerance, a part may still be found at a few nodes, or between nodes by
    a search that starts from the best ones. This part is then mapped on its own grids. An area of 0 means that no part
    was
    found: see `LevelSet.step`.

    Args:
        index: an index from `index_of`.
        section: the plane.
        names: the robot's `pose_names`.
        bound: the index should be at least this (at most, if it should be small); None takes all that is in reach.
        tolerance: the allowed change: of the area over the map's area, of mean and deviation over the larger value.
        seconds: after so much time, the finest complete map is used.

    Raises:
        InvalidRegion, InvalidSection: see `Section.check`.
        InvalidValue: the bound is not finite, or the tolerance or the time is not above 0.
        OutOfTime: the time ended before the coarsest map was complete.
    """
    bound = None if bound is None else finite("bound", bound)
    if math.isfinite(index.least):
        bound = max(index.least, -math.inf if bound is None else bound)
    tolerance, budget = positive("tolerance", tolerance), Budget(seconds)
    section.check(names)
    found = _refined(index, section, names, bound, tolerance, budget, window_of(section))
    while (
        bound is not None and not budget.spent and not _is_flat(found) and found.figures.area <= tolerance * found.whole
    ):
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
    """`level_set` within a window. Changes of the area are relative to the window's area."""
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
        if found.settled and (now.area > tolerance * whole or _is_flat(found)):
            break
        count = 2 * count - 1
    assert found is not None
    return found


def _is_flat(found: LevelSet) -> bool:
    """Whether the index is one number at all nodes of two maps, and misses the bound: finer ones would show no more."""
    values = found.map.values[np.isfinite(found.map.values)]
    flat = values.size and np.ptp(values) <= _SAME * np.abs(values).max()
    return bool(flat and found.settled and found.figures.area == 0.0)


def integrals(chart: Map, bound: float | None) -> Integrals:
    """The figures of one map."""
    triangles = _triangles(chart)
    if bound is not None:
        triangles = _clipped(triangles, _GOOD, chart.sense * bound)
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
    deviation = deviation if deviation > _ROUNDING * abs(mean) else 0.0
    return Integrals(total, chart.sense * mean, deviation)


def boundary(chart: Map, bound: float | None) -> list[Array]:
    """Closed polylines (k, 2) around the part of the plane where the index keeps the bound."""
    good = chart.good
    spare = np.where(np.isnan(good), np.nan, 1.0)
    if np.isnan(good).all():
        return []
    if bound is not None:
        spare = good - chart.sense * bound
    if np.isfinite(chart.inset).all():
        scale = np.nanmax(np.abs(spare)) / np.abs(chart.inset).max()
        spare = np.minimum(spare, scale * chart.inset)
    generator = contour_generator(chart.first, chart.second, np.ma.masked_invalid(spare), fill_type="OuterOffset")
    filled: Any = generator.filled(0.0, np.inf)  # all points of each polygon, and where its rings start and end
    return [ring for points, starts in zip(*filled, strict=True) for ring in np.split(points, starts[1:-1])]


def _triangles(chart: Map) -> Array:
    """(t, 3, 4) vertices (first, second, value, inset). Triangles with a vertex out of reach are left out."""
    first, second = np.meshgrid(chart.first, chart.second)
    inset = np.where(np.isinf(chart.inset), 1.0, chart.inset)
    nodes = np.stack([first, second, chart.good, inset], axis=-1)
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
    """(s, 4) the points where the edges from a to b cross the level."""
    share = (level - a[:, column]) / (b[:, column] - a[:, column])
    result: Array = a + share[:, None] * (b - a)
    return result
