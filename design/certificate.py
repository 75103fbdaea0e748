"""Certificates: a margin is at least a bound at every pose of a region, not only at sampled ones.

    certify(robot, region, "fvi", at_least=1.0).status  ->  "proved", "refuted" or "undecided"

What a proof rests on, beside the lemmas of `claims` and the mean-value theorem: IEEE 754 arithmetic, the accuracy that
`kinematics.interval` assumes of the sine, cosine and arctangent, and CasADi's algebra, which builds the expressions and
their derivatives. What is proved is a statement about real numbers: geometry, region and bound are the exact values of
their doubles, and so are the constants written into the model (2 pi among them, and products of two such constants,
which CasADi rounds once). A region's boundary counts as inside. Plain evaluation only chooses signs, scalings, cuts and
counterexamples.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.metadata import version

import numpy as np

from design.branch_and_bound import Search, search
from design.lower_bounds import LowerBounds
from design.region import Region
from design.search import worst_poses
from design.symmetry import Mirrors, mirrors_of
from kinematics import FviBounds, Mechanism
from kinematics.errors import InvalidValue

Array = np.ndarray
MOST_BOXES = 4_000_000
_SEED = 20_000  # poses of the grid that looks for a counterexample first
_MOST_PER_COORDINATE = 200
_MOST_TRIES = 12  # of bounds
_ROUNDING = 1e-12  # by how much plain arithmetic must miss the bound before it refutes, relative to 1 or the bound


@dataclass(frozen=True)
class Certificate:
    """A claim, the answer, and for a proof the boxes that anyone can check again.

    Attributes:
        mechanism, digest, ranges: class name, SHA-256 of the geometry and of the joints' ranges.
        region, margin, at_least: the claim.
        bounds, characteristic_length: what the FVI is measured with; length in metres.
        version: of the program that made it.
        status: "proved", "refuted" or "undecided".
        counterexample: (n,) a pose where plain arithmetic finds the margin below the bound or a limb that cannot reach.
        boxes: how many boxes were bounded.
        codes: (nodes,) the tree of boxes by level; see `design.tree`. Empty unless proved.
        left: (k, 2, n) lower and upper bounds of the boxes that were not proved.
        mirrors: coordinates whose signs change together without changing the margin; of each only the side where its
            first one is at least 0 was looked at. See `design.symmetry`.
    """

    mechanism: str
    digest: str
    ranges: str
    region: Region
    margin: str
    at_least: float
    bounds: FviBounds
    characteristic_length: float
    version: str
    status: str
    counterexample: Array | None
    boxes: int
    codes: Array
    left: Array
    mirrors: Mirrors

    def __str__(self) -> str:
        return f"{self.mechanism}: {self.margin} >= {self.at_least:g} {self.status} with {self.boxes} boxes"


def certify(
    robot: Mechanism,
    region: Region,
    margin: str,
    *,
    at_least: float,
    bounds: FviBounds | None = None,
    characteristic_length: float | None = None,
    most_boxes: int = MOST_BOXES,
) -> Certificate:
    """Prove or refute that a margin is at least a bound everywhere in a region.

    Args:
        robot: the mechanism with its geometry.
        region: continuous in all coordinates, its boundary included.
        margin: one of `robot.margins`.
        at_least: the bound, in the margin's unit.
        bounds, characteristic_length: as in `Mechanism.margin`.
        most_boxes: after so many the answer is "undecided".

    Raises:
        InvalidRegion: the region does not speak of the robot's coordinates.
        InvalidValue: an unknown margin, a bound that is not finite, or no box allowed.
    """
    _check(robot, region, margin, at_least, most_boxes)
    fvi_bounds = bounds or robot.fvi_bounds
    length = robot.characteristic_length if characteristic_length is None else float(characteristic_length)
    at_least = float(at_least)
    mirrors = mirrors_of(robot, region, margin)
    found = _decide(robot, region, mirrors, margin, at_least, fvi_bounds, length, most_boxes)
    refuted, proved = found.counterexample is not None, not len(found.left)
    return Certificate(
        mechanism=type(robot).__name__,
        digest=robot.geometry.digest,
        ranges=robot.ranges.digest,
        region=region,
        margin=margin,
        at_least=at_least,
        bounds=fvi_bounds,
        characteristic_length=length,
        version=version("linkwright"),
        status="refuted" if refuted else "proved" if proved else "undecided",
        counterexample=found.counterexample,
        boxes=found.boxes,
        codes=found.codes if proved and not refuted else np.empty(0, dtype=np.int8),
        left=found.left,
        mirrors=mirrors,
    )


def _check(robot: Mechanism, region: Region, margin: str, at_least: float, most_boxes: int) -> None:
    region.check(robot.pose_names)
    if not np.isfinite(at_least):
        raise InvalidValue("at_least", at_least, "a finite number")
    if most_boxes < 1:
        raise InvalidValue("most_boxes", most_boxes, "at least 1")
    if margin not in robot.margins:
        raise InvalidValue(f"{type(robot).__name__} margin", margin, f"one of {', '.join(robot.margins)}")


def _decide(
    robot: Mechanism,
    region: Region,
    mirrors: Mirrors,
    margin: str,
    at_least: float,
    bounds: FviBounds,
    length: float,
    most_boxes: int,
) -> Search:
    """Look for a counterexample where the margin is lowest, then prove by boxes."""
    names = robot.pose_names

    def failing(poses: Array) -> Array | None:
        inside = poses[region.contains(poses, names)]
        return first_failing(robot, margin, inside, at_least, bounds, length)

    counterexample = failing(_suspects(robot, region, margin, bounds, length, _SEED))
    if counterexample is not None:
        return Search(np.empty(0, dtype=np.int8), 0, np.empty((0, 2, len(names))), counterexample)
    lower = LowerBounds(robot, region, margin, at_least, bounds, length)
    return search(lower, region, mirrors, names, failing, most_boxes)


def _suspects(robot: Mechanism, region: Region, margin: str, bounds: FviBounds, length: float, about: int) -> Array:
    """(k, n) poses where the margin is lowest as far as a grid and descents tell, the lowest first."""
    if region.dimension == 0:
        return region.from_unit(np.empty((1, 0)), robot.pose_names)
    about = min(about, _MOST_PER_COORDINATE**region.dimension)
    return worst_poses(robot, region, margin, bounds=bounds, characteristic_length=length, about=about).poses


def first_failing(
    robot: Mechanism, margin: str, poses: Array, at_least: float, bounds: FviBounds, length: float
) -> Array | None:
    """A pose (n,) of (k, n) where the margin, in plain arithmetic, is below the bound or has no value; else None."""
    if not len(poses):
        return None
    values = robot.margin(margin, poses, bounds, length)
    below = ~(values >= at_least - _ROUNDING * max(1.0, abs(at_least)))
    return poses[int(np.where(below, np.nan_to_num(values, nan=-np.inf), np.inf).argmin())] if below.any() else None


@dataclass(frozen=True)
class BestBound:
    """A certified worst case.

    Attributes:
        certificate: proved; its `at_least` is the bound.
        sampled: the lowest value that a search found, so the true worst lies between the two.
    """

    certificate: Certificate
    sampled: float


def best_bound(
    robot: Mechanism,
    region: Region,
    margin: str,
    tolerance: float,
    *,
    bounds: FviBounds | None = None,
    characteristic_length: float | None = None,
    most_boxes: int = MOST_BOXES,
) -> BestBound | None:
    """The largest bound that is proved, to a tolerance in the margin's unit; None where nothing is proved.

    The first try is the lowest sampled value less the tolerance. Where that is refuted the counterexample's value takes
    its place; where it stays undecided the tolerance is doubled, so compare `sampled` with what was proved.
    """
    if not (np.isfinite(tolerance) and tolerance > 0.0):
        raise InvalidValue("tolerance", tolerance, "a finite number > 0")
    fvi_bounds = bounds or robot.fvi_bounds
    length = robot.characteristic_length if characteristic_length is None else float(characteristic_length)
    region.check(robot.pose_names)

    def value(pose: Array) -> float:
        return float(robot.margin(margin, pose, fvi_bounds, length))

    sampled = value(_suspects(robot, region, margin, fvi_bounds, length, 10 * _SEED)[0])
    step = float(tolerance)
    for _ in range(_MOST_TRIES):
        if not np.isfinite(sampled):
            return None
        certificate = certify(
            robot,
            region,
            margin,
            at_least=sampled - step,
            bounds=fvi_bounds,
            characteristic_length=length,
            most_boxes=most_boxes,
        )
        if certificate.status == "proved":
            return BestBound(certificate, sampled)
        if certificate.counterexample is not None:
            sampled = value(certificate.counterexample)
        else:
            step *= 2.0
    return None
