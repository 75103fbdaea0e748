"""The largest cylinder of a family over which a margin is proved.

It is a lower bound of the true region: in a larger cylinder the claim fails, or was not proved with the allowed boxes.
`certified_cells` proves the cells of a section.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np

from design.budget import Budget
from design.certificates.certificate import MOST_BOXES, Certificate, certify
from design.regions import Cylinder
from kinematics import Array, Bound, FviBounds, InvalidValue, Mechanism, Value, bisected, positive


@dataclass(frozen=True, eq=False)
class CertifiedRegion(Value):
    """The proved part of a family of regions.

    Attributes:
        margin, bound: the claim.
        certificates: proofs; their regions together are the certified region. Empty if nothing is proved.
        boxes: the number of boxes that were bounded, including those of failed attempts.
        left: (k, 2, n) lower and upper bounds of boxes that were neither proved nor refuted.
        complete: whether the search finished before its time ended.
        seconds: wall-clock time.
    """

    margin: str
    bound: Bound
    certificates: tuple[Certificate, ...]
    boxes: int
    left: Array
    complete: bool
    seconds: float

    @property
    def radius(self) -> float:
        """The radius of the largest proved cylinder [m]; 0 if none is proved."""
        radii = [c.region.radius for c in self.certificates if isinstance(c.region, Cylinder)]
        return max(radii, default=0.0)

    def cells(self, axes: tuple[str, str]) -> Array:
        """(k, 2, 2) lower and upper bounds of the proved cells in the plane of two coordinates."""
        bounds = [[c.region.intervals[name] for name in axes] for c in self.certificates]
        return np.array(bounds).reshape(-1, 2, 2).swapaxes(1, 2)

    def area(self, axes: tuple[str, str]) -> float:
        """The area of the proved cells in the plane of two coordinates. Cells do not overlap."""
        cells = self.cells(axes)
        return float((cells[:, 1] - cells[:, 0]).prod(axis=1).sum())


def certified_cylinder(
    robot: Mechanism,
    region: Cylinder,
    margin: str,
    *,
    at_least: float | None = None,
    at_most: float | None = None,
    tolerance: float | None = None,
    bounds: FviBounds | None = None,
    characteristic_length: float | None = None,
    most_boxes: int = MOST_BOXES,
    seconds: float = math.inf,
) -> CertifiedRegion:
    """The largest radius for which the margin is proved, to a tolerance, by bisection up to the region's radius.

    A smaller cylinder is inside a larger one, so a proof for one cylinder holds in all smaller ones.

    Args:
        robot: the mechanism with its geometry.
        region: the largest cylinder of the family. The bounds of its other coordinates are the same for all cylinders.
        margin, at_least, at_most, bounds, characteristic_length, most_boxes: as in `certify`, for each radius.
        tolerance: tolerance of the radius [m]; by default a thousandth of the region's radius.
        seconds: for all radii together. One radius gets half of the time that is left.

    Raises:
        InvalidRegion, InvalidValue: see `certify`; or the tolerance is not above 0, or finer than doubles.
    """
    tolerance = positive("tolerance", region.radius / 1000.0 if tolerance is None else tolerance)
    if tolerance < (finest := float(np.spacing(region.radius))):
        raise InvalidValue("tolerance", tolerance, f"at least {finest:.3g} m, the step between radii of this size")
    bound = robot.margin_named(margin).bound(at_least, at_most)
    started, boxes, complete, budget = time.perf_counter(), 0, True, Budget(seconds)
    best: list[Certificate] = []
    others = {name: pair for name, pair in region.intervals.items() if name not in ("x", "y")}
    left = np.empty((0, 2, len(robot.pose_names)))

    def proved(radius: Array | float) -> bool:
        """Whether the cylinder of a radius is proved. When the time is used up, nothing more is tried."""
        nonlocal boxes, left, complete
        if budget.spent:
            complete = False
            return False
        found = certify(
            robot,
            Cylinder(float(radius), **others),
            margin,
            at_least=at_least,
            at_most=at_most,
            bounds=bounds,
            characteristic_length=characteristic_length,
            most_boxes=most_boxes,
            seconds=budget.share(2).seconds,
        )
        boxes += found.boxes
        if found.status == "proved":
            best.append(found)
            return True
        left = found.left if found.status == "undecided" else left
        return False

    if not proved(region.radius):
        bisected(proved, 0.0, region.radius, tolerance)
    return CertifiedRegion(margin, bound, tuple(best[-1:]), boxes, left, complete, time.perf_counter() - started)
