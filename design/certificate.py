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

from collections.abc import Callable
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
from kinematics.shown import rounded_down

Array = np.ndarray
Progress = Callable[[str], None]
MOST_BOXES = 4_000_000
SEED = 20_000  # poses of the grid that looks for a counterexample first
_MOST_PER_COORDINATE = 200
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
        return (
            f"{self.mechanism}: {self.margin} >= {rounded_down(self.at_least, 6)} {self.status} with {self.boxes} boxes"
        )


def certify(
    robot: Mechanism,
    region: Region,
    margin: str,
    *,
    at_least: float,
    bounds: FviBounds | None = None,
    characteristic_length: float | None = None,
    most_boxes: int = MOST_BOXES,
    progress: Progress = lambda _: None,
) -> Certificate:
    """Prove or refute that a margin is at least a bound everywhere in a region.

    Args:
        robot: the mechanism with its geometry.
        region: continuous in all coordinates, its boundary included.
        margin: one of `robot.margins`.
        at_least: the bound, in the margin's unit.
        bounds, characteristic_length: as in `Mechanism.margin`.
        most_boxes: after so many the answer is "undecided".
        progress: told a line of text at each step.

    Raises:
        InvalidRegion: the region does not speak of the robot's coordinates.
        InvalidValue: an unknown margin, a bound that is not finite, or no box allowed.
    """
    _check(robot, region, margin, at_least, most_boxes)
    fvi_bounds = bounds or robot.fvi_bounds
    length = robot.characteristic_length if characteristic_length is None else float(characteristic_length)
    at_least = float(at_least)
    mirrors = mirrors_of(robot, region, margin)
    found = _decide(robot, region, mirrors, margin, at_least, fvi_bounds, length, most_boxes, progress)
    return answer(robot, region, mirrors, margin, at_least, fvi_bounds, length, found)


def answer(
    robot: Mechanism,
    region: Region,
    mirrors: Mirrors,
    margin: str,
    at_least: float,
    bounds: FviBounds,
    length: float,
    found: Search,
) -> Certificate:
    """What a search over a region came to, with all that it was asked."""
    refuted, proved = found.counterexample is not None, not len(found.left)
    return Certificate(
        mechanism=type(robot).__name__,
        digest=robot.geometry.digest,
        ranges=robot.ranges.digest,
        region=region,
        margin=margin,
        at_least=at_least,
        bounds=bounds,
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
    if most_boxes < 1:
        raise InvalidValue("most_boxes", most_boxes, "at least 1")
    if margin not in robot.margins:
        raise InvalidValue(f"{type(robot).__name__} margin", margin, f"one of {', '.join(robot.margins)}")
    if not np.isfinite(at_least):
        raise InvalidValue(f"at_least of {margin}", at_least, "a finite number, in the margin's unit")


def _decide(
    robot: Mechanism,
    region: Region,
    mirrors: Mirrors,
    margin: str,
    at_least: float,
    bounds: FviBounds,
    length: float,
    most_boxes: int,
    progress: Progress,
) -> Search:
    """Look for a counterexample where the margin is lowest, then prove by boxes."""
    names = robot.pose_names

    def failing(poses: Array) -> Array | None:
        inside = poses[region.contains(poses, names)]
        return first_failing(robot, margin, inside, at_least, bounds, length)

    what = f"certify {margin} >= {at_least:g}"
    progress(f"{what}: looking for a counterexample")
    counterexample = failing(suspects(robot, region, margin, bounds, length, SEED))
    if counterexample is not None:
        return Search(np.empty(0, dtype=np.int8), 0, np.empty((0, 2, len(names))), counterexample)
    lower = LowerBounds(robot, region, margin, at_least, bounds, length)
    return search(lower, region, mirrors, names, failing, most_boxes, lambda done: progress(f"{what}: {done}"))


def suspects(robot: Mechanism, region: Region, margin: str, bounds: FviBounds, length: float, about: int) -> Array:
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
