"""Certificates: a margin keeps a bound at every pose of a region, not only at sampled ones.

    certify(robot, region, "fvi", at_least=1.0).status  ->  "proved", "refuted" or "undecided"

A proof relies on the margins' lemmas, IEEE 754 arithmetic, the accuracy that `kinematics.evaluation` assumes of sine,
cosine and arctangent, and CasADi's algebra, which builds the expressions and the Jacobians in them. The proved
statement is about real numbers. Geometry, region and bound are the exact values of their doubles. So are the constants
in the model, such as 2 pi, and products of two such constants, which CasADi rounds once. A region's boundary counts as
inside. Plain evaluation only chooses signs, scalings, cuts and counterexamples.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

import numpy as np

from design.budget import Budget
from design.certificates.box_tree import MOST_NODES
from design.certificates.branch_and_bound import Search, search
from design.certificates.lower_bounds import LowerBounds
from design.certificates.refutation import Refuter
from design.certificates.symmetry import Mirrors, mirrors_of
from design.claims import Statement
from design.regions import Region
from design.sampling import worst_poses
from kinematics import Array, Bound, FviBounds, Mechanism, Value, whole

Progress = Callable[[str], None]
MOST_BOXES = 4_000_000
EDITION = 2  # what a certificate claims besides its margin; edition 2 also claims that every limb can reach
SEED = 20_000  # poses of the grid that is first searched for a counterexample
_MOST_PER_COORDINATE = 200


@dataclass(frozen=True, eq=False)
class Certificate(Value):
    """A claim and its answer. A proof includes the boxes, so that anyone can check it again.

    Attributes:
        mechanism, digest, conditions: class name, SHA-256 of the geometry, SHA-256 of joint ranges and working mode.
        region, margin, bound: the claim.
        bounds, characteristic_length: what the FVI is measured with; the length is in metres.
        version, edition: the version of the program that made the certificate, and its `EDITION`.
        status: "proved", "refuted" or "undecided".
        counterexample: (n,) a pose where the margin breaks the bound by more than rounding, or out of a limb's reach.
        within_reach: whether every limb can reach the counterexample; True without one.
        boxes: the number of boxes that were bounded.
        codes: (nodes,) the tree of boxes by level; see `box_tree`. Empty unless proved.
        left: (k, 2, n) lower and upper bounds of the boxes that were not proved.
        mirrors: coordinates whose signs can change together without changing the margin. For each mirror only the side
            where its first coordinate is at least 0 was searched. See `symmetry`.
    """

    mechanism: str
    digest: str
    conditions: str
    region: Region
    margin: str
    bound: Bound
    bounds: FviBounds
    characteristic_length: float
    version: str
    edition: int
    status: str
    counterexample: Array | None
    within_reach: bool
    boxes: int
    codes: Array
    left: Array
    mirrors: Mirrors

    def statement(self, robot: Mechanism) -> Statement:
        """The certificate's statement about `robot`. Whether it was made for this robot is not checked here."""
        return Statement(robot, self.margin, self.bound, self.bounds, self.characteristic_length)

    def __str__(self) -> str:
        claim = f"{self.mechanism}: {self.margin} {self.bound.shown(6)} {self.status}"
        return f"{claim} with {self.boxes} boxes" if self.within_reach else f"{claim}: out of reach"


def certify(
    robot: Mechanism,
    region: Region,
    margin: str,
    *,
    at_least: float | None = None,
    at_most: float | None = None,
    bounds: FviBounds | None = None,
    characteristic_length: float | None = None,
    most_boxes: int = MOST_BOXES,
    seconds: float = math.inf,
    progress: Progress = lambda _: None,
) -> Certificate:
    """Prove or refute that a margin keeps a bound everywhere in a region.

    Args:
        robot: the mechanism with its geometry.
        region: all its poses count, including its boundary.
        margin: one of `robot.margins`.
        at_least, at_most: the bound, in the margin's unit; the one that the margin's `sense` asks for.
        bounds, characteristic_length: as in `Mechanism.margin`.
        most_boxes, seconds: after so many boxes, or so much time, the answer is "undecided", with the boxes left.
        progress: called with a line of text at each step.

    Raises:
        InvalidRegion: the region does not have the robot's coordinates.
        InvalidValue: see `Statement`; or `most_boxes` is below 1, or more than a certificate can hold.
    """
    bound = robot.margin_named(margin).bound(at_least, at_most)
    statement = Statement.of(robot, margin, bound, bounds, characteristic_length)
    region.check(robot.pose_names)
    return answer(statement, region, checked_boxes(most_boxes), Budget(seconds), progress)


def checked_boxes(most_boxes: object) -> int:
    """The number of boxes that are allowed, at most as many as a certificate can hold.

    Raises:
        InvalidValue: it is not such a number.
    """
    return whole("most_boxes", most_boxes, 1, MOST_NODES // 2)


def answer(statement: Statement, region: Region, most_boxes: int, budget: Budget, progress: Progress) -> Certificate:
    """Look for a counterexample where the margin is worst, then prove by boxes."""
    what = f"certify {statement.margin} {statement.bound}"
    progress(f"{what}: looking for a counterexample")
    refuter = Refuter(statement)
    refutation = refuter.refutation(region, suspects(statement, region, SEED, budget.share(4)))
    if refutation is not None:
        mirrors = mirrors_of(statement.robot, region, statement.margin)
        no_boxes = np.empty(0, dtype=np.int8), 0, np.empty((0, 2, len(refutation.pose)))
        return _certificate(statement, region, mirrors, Search(*no_boxes, refutation))
    lower = LowerBounds(statement, region)
    return answer_by_boxes(lower, refuter, region, most_boxes, budget, lambda done: progress(f"{what}: {done}"))


def answer_by_boxes(
    lower: LowerBounds, refuter: Refuter, region: Region, most_boxes: int, budget: Budget, progress: Progress
) -> Certificate:
    """Prove with boxes. The region may be a part of the region that the lower bounds were made for."""
    mirrors = mirrors_of(lower.statement.robot, region, lower.statement.margin)
    found = search(lower, refuter, region, mirrors, most_boxes, budget, progress)
    return _certificate(lower.statement, region, mirrors, found)


def suspects(statement: Statement, region: Region, about: int, budget: Budget) -> Array:
    """(k, n) poses where a grid and descents find the margin worst, the worst first."""
    measured = {"bounds": statement.bounds, "characteristic_length": statement.length}
    if region.dimension == 0:
        return region.from_unit(np.empty((1, 0)), statement.robot.pose_names)
    about = min(about, _MOST_PER_COORDINATE**region.dimension)
    asked: dict[str, Any] = measured | {"about": about, "seconds": budget.seconds}
    return worst_poses(statement.robot, region, statement.margin, **asked).poses


def _certificate(statement: Statement, region: Region, mirrors: Mirrors, found: Search) -> Certificate:
    refutation, proved = found.refutation, not len(found.left)
    return Certificate(
        mechanism=type(statement.robot).__name__,
        digest=statement.robot.geometry.digest,
        conditions=statement.robot.conditions_digest(statement.robot.margin_named(statement.margin).records),
        region=region,
        margin=statement.margin,
        bound=statement.bound,
        bounds=statement.bounds,
        characteristic_length=statement.length,
        version=version("linkwright"),
        edition=EDITION,
        status="refuted" if refutation else "proved" if proved else "undecided",
        counterexample=refutation.pose if refutation else None,
        within_reach=refutation is None or refutation.within_reach,
        boxes=found.boxes,
        codes=found.codes if proved and not refutation else np.empty(0, dtype=np.int8),
        left=found.left,
        mirrors=mirrors,
    )
