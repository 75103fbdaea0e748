"""The largest region of a family over which a margin is proved: a cylinder's radius, or the cells of a section.

Both are lower bounds of what holds: beyond them a claim fails, or was not proved with the boxes allowed.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from design.branch_and_bound import search
from design.certificate import MOST_BOXES, Certificate, answer, certify, first_failing
from design.errors import InvalidSection
from design.index import index_of
from design.lower_bounds import LowerBounds
from design.maps import map_of
from design.region import Box, Cylinder, Region
from design.section import Section
from design.symmetry import mirrors_of
from kinematics import FviBounds, Mechanism
from kinematics.errors import InvalidValue

Array = np.ndarray
DEPTH = 7  # cells: at most 2^7 along each axis
MOST_BOXES_A_CELL = 100_000


@dataclass(frozen=True)
class CertifiedRegion:
    """What is proved of a family of regions.

    Attributes:
        margin, at_least: the claim.
        certificates: proofs whose regions together are the certified one; none where nothing is proved.
        boxes: how many boxes were bounded, those of attempts that came to nothing included.
        left: (k, 2, n) lower and upper bounds of boxes that were neither proved nor refuted.
        seconds: wall-clock time.
    """

    margin: str
    at_least: float
    certificates: tuple[Certificate, ...]
    boxes: int
    left: Array
    seconds: float

    @property
    def radius(self) -> float:
        """Of the largest proved cylinder [m]; 0 where none is."""
        radii = [c.region.radius for c in self.certificates if isinstance(c.region, Cylinder)]
        return max(radii, default=0.0)

    def cells(self, axes: tuple[str, str]) -> Array:
        """(k, 2, 2) lower and upper bounds of the proved cells in the plane of two coordinates."""
        bounds = [[c.region.intervals[name] for name in axes] for c in self.certificates]
        return np.array(bounds).reshape(-1, 2, 2).swapaxes(1, 2)

    def area(self, axes: tuple[str, str]) -> float:
        """Of the proved cells in the plane of two coordinates, which do not overlap."""
        cells = self.cells(axes)
        return float((cells[:, 1] - cells[:, 0]).prod(axis=1).sum())


def certified_cylinder(
    robot: Mechanism,
    region: Cylinder,
    margin: str,
    *,
    at_least: float,
    tolerance: float = 1e-3,
    bounds: FviBounds | None = None,
    characteristic_length: float | None = None,
    most_boxes: int = MOST_BOXES,
) -> CertifiedRegion:
    """The largest radius, to a tolerance, up to the region's, with which the margin is proved; by bisection.

    A smaller cylinder lies inside a larger one, so what is proved of one holds in all smaller ones.

    Args:
        robot: the mechanism with its geometry.
        region: the largest cylinder of the family; its other coordinates hold for all.
        margin, at_least, bounds, characteristic_length, most_boxes: as in `certify`, for each radius.
        tolerance: of the radius [m].

    Raises:
        InvalidRegion, InvalidValue: see `certify`; or a tolerance not above 0.
    """
    if not (np.isfinite(tolerance) and tolerance > 0.0):
        raise InvalidValue("tolerance", tolerance, "a finite number > 0")
    started, best, boxes = time.perf_counter(), [], 0
    others = {name: pair for name, pair in region.intervals.items() if name not in ("x", "y")}
    left = np.empty((0, 2, len(robot.pose_names)))
    low, high, radius = 0.0, region.radius, region.radius
    while True:
        found = certify(
            robot,
            Cylinder(radius, **others),
            margin,
            at_least=at_least,
            bounds=bounds,
            characteristic_length=characteristic_length,
            most_boxes=most_boxes,
        )
        boxes += found.boxes
        if found.status == "proved":
            low, best = radius, [found]
        else:
            high, left = radius, found.left if found.status == "undecided" else left
        if high - low <= tolerance or low == region.radius:
            break
        radius = 0.5 * (low + high)
    return CertifiedRegion(margin, at_least, tuple(best), boxes, left, time.perf_counter() - started)


def certified_cells(
    robot: Mechanism,
    region: Region,
    axes: tuple[str, str],
    margin: str,
    *,
    at_least: float,
    depth: int = DEPTH,
    bounds: FviBounds | None = None,
    characteristic_length: float | None = None,
    most_boxes: int = MOST_BOXES_A_CELL,
) -> CertifiedRegion:
    """The cells of a plane over which the margin is proved for all values of the other coordinates.

    The plane is cut into quarters: a cell is tried where a map of its corners, and of those within it, finds nothing
    below the bound; what is not proved is cut again, down to the smallest cells.

    Args:
        robot: the mechanism with its geometry.
        region: a box; its other coordinates hold as a whole for each cell.
        axes: the two coordinates of the plane.
        margin, at_least, bounds, characteristic_length: as in `certify`.
        depth: the smallest cells are the region's sides over 2^depth.
        most_boxes: of each attempt.

    Raises:
        InvalidRegion, InvalidValue: see `certify`.
        InvalidSection: see `Section.check`, or the region is not a box.
    """
    if not isinstance(region, Box):
        raise InvalidSection("cells", repr(region), "a Box; a Cylinder has `certified_cylinder`")
    if not 0 <= depth <= 10:
        raise InvalidValue("depth", depth, "a whole number from 0 to 10")
    if not np.isfinite(at_least):
        raise InvalidValue("at_least", at_least, "a finite number")
    started, names = time.perf_counter(), robot.pose_names
    if margin not in robot.margins:
        raise InvalidValue(f"{type(robot).__name__} margin", margin, f"one of {', '.join(robot.margins)}")
    fvi_bounds = bounds or robot.fvi_bounds
    length = robot.characteristic_length if characteristic_length is None else float(characteristic_length)
    nodes = 2**depth + 1
    chart = map_of(index_of(robot, margin, fvi_bounds, length), Section(region, axes), names, (nodes, nodes))
    holds = chart.goodness >= at_least  # NaN is not
    lower = LowerBounds(robot, region, margin, at_least, fvi_bounds, length)

    def failing(poses: Array) -> Array | None:
        return first_failing(robot, margin, poses, at_least, fvi_bounds, length)

    cells, proved, left, boxes = [(0, 0, nodes - 1)], [], [], 0
    while cells:
        column, row, size = cells.pop()
        if holds[row : row + size + 1, column : column + size + 1].all():
            sides = dict(
                zip(axes, (chart.first[[column, column + size]], chart.second[[row, row + size]]), strict=True)
            )
            cell = Box(**{**region.intervals, **{name: (float(a), float(b)) for name, (a, b) in sides.items()}})
            mirrors = mirrors_of(robot, cell, margin)
            found = search(lower, cell, mirrors, names, failing, most_boxes, lambda _: None)
            boxes += found.boxes
            if found.counterexample is None and not len(found.left):
                proved.append(answer(robot, cell, mirrors, margin, at_least, fvi_bounds, length, found))
                continue
            if size == 1 and found.counterexample is None:
                left.append(found.left)
        if size > 1:
            half = size // 2
            cells += [(column + i * half, row + j * half, half) for i in (0, 1) for j in (0, 1)]
    unproved = np.concatenate([np.empty((0, 2, len(names))), *left])
    return CertifiedRegion(margin, at_least, tuple(proved), boxes, unproved, time.perf_counter() - started)
