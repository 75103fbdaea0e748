"""The cells of a section over which a margin is proved. A cell whose proof fails is cut in four.

They are a lower bound of the true part, as in `largest_region`.
"""

from __future__ import annotations

import math
import time
from collections import deque

import numpy as np

from design.budget import Budget
from design.certificates import Certificate, CertifiedRegion, LowerBounds, Refuter, answer_by_boxes, checked_boxes
from design.claims import Statement
from design.errors import InvalidSection
from design.maps.map_index import index_of
from design.maps.sampled_map import Map, map_of
from design.maps.section import Section
from design.regions import Box, Region
from kinematics import Array, FviBounds, Mechanism, whole

DEPTH = 7  # at most 2^7 cells along each axis
MOST_BOXES_A_CELL = 100_000


def certified_cells(
    robot: Mechanism,
    region: Region,
    axes: tuple[str, str],
    margin: str,
    *,
    at_least: float | None = None,
    at_most: float | None = None,
    depth: int = DEPTH,
    bounds: FviBounds | None = None,
    characteristic_length: float | None = None,
    most_boxes: int = MOST_BOXES_A_CELL,
    seconds: float = math.inf,
) -> CertifiedRegion:
    """The cells of a plane over which the margin is proved for all values of the other coordinates.

    The plane is first cut in four. A cell is tried if a map finds no value that breaks the bound at its corners and at
    the nodes inside it. A cell that is not proved is cut in four again, down to the smallest cells.

    Args:
        robot: the mechanism with its geometry.
        region: a box. In each cell the other coordinates have their whole intervals.
        axes: the two coordinates of the plane.
        margin, at_least, at_most, bounds, characteristic_length: as in `certify`.
        depth: the sides of the smallest cells are the region's sides over 2^depth.
        most_boxes: the most boxes for each cell.
        seconds: time for all cells. The largest cells come first. Cells that are not tried in time are not proved.

    Raises:
        InvalidRegion, InvalidValue: see `certify`.
        InvalidSection: see `Section.check`, or the region is not a box.
        OutOfTime: the map alone needs more time.
    """
    if not isinstance(region, Box):
        raise InvalidSection("cells", repr(region), "a Box; a Cylinder has `certified_cylinder`")
    started, nodes, budget = time.perf_counter(), 2 ** whole("depth", depth, 0, 10) + 1, Budget(seconds)
    bound = robot.margin_named(margin).bound(at_least, at_most)
    statement = Statement.of(robot, margin, bound, bounds, characteristic_length)
    index = index_of(robot, margin, statement.bounds, statement.length)
    chart = map_of(index, Section(region, axes), robot.pose_names, (nodes, nodes), seconds=seconds)
    most_boxes, lower = checked_boxes(most_boxes), LowerBounds(statement, region)
    proved, boxes, left, complete = _proofs(lower, chart, nodes - 1, most_boxes, budget)
    return CertifiedRegion(margin, bound, tuple(proved), boxes, left, complete, time.perf_counter() - started)


def _proofs(
    lower: LowerBounds, chart: Map, size: int, most_boxes: int, budget: Budget
) -> tuple[list[Certificate], int, Array, bool]:
    """Returns the proved cells of a chart of `size` by `size` cells, the number of boxes bounded, the boxes left in the
    smallest cells, and whether all cells were tried.
    """
    holds, refuter = lower.statement.bound.room(chart.values) >= 0.0, Refuter(lower.statement)  # NaN does not hold
    cells, proved, left, boxes = deque([(0, 0, size)]), [], [np.empty((0, 2, chart.poses.shape[-1]))], 0
    while cells and not budget.spent:
        column, row, size = cells.popleft()
        if holds[row : row + size + 1, column : column + size + 1].all():
            found = answer_by_boxes(lower, refuter, _cell(chart, column, row, size), most_boxes, budget, lambda _: None)
            boxes += found.boxes
            if found.status == "proved":
                proved.append(found)
                continue
            if size == 1 and found.status == "undecided":
                left.append(found.left)
        if size > 1:
            half = size // 2
            cells += [(column + i * half, row + j * half, half) for i in (0, 1) for j in (0, 1)]
    return proved, boxes, np.concatenate(left), not cells


def _cell(chart: Map, column: int, row: int, size: int) -> Box:
    """The map's region between two of its nodes along each of both axes."""
    sides = chart.first[[column, column + size]], chart.second[[row, row + size]]
    cut = {name: (float(a), float(b)) for name, (a, b) in zip(chart.section.axes, sides, strict=True)}
    return Box(**{**chart.section.region.intervals, **cut})
