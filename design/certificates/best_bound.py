"""A certified worst case: the strongest bound of a margin that is proved, to a tolerance."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from design.budget import Budget
from design.certificates.certificate import MOST_BOXES, SEED, Certificate, Progress, answer, checked_boxes, suspects
from design.claims import Statement
from design.regions import Region
from kinematics import Bound, FviBounds, Mechanism, positive

_MOST_TRIES = 12  # bounds that are tried, including the refuted ones
_COARSEST = 13  # most doublings of the tolerance
_SHARES = 4  # of the boxes: one try may use as many


@dataclass(frozen=True)
class BestBound:
    """A certified worst case.

    Attributes:
        certificate: a proved certificate with the bound.
        sampled: the worst value that a search found. The true worst value is between the two.
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
    seconds: float = math.inf,
    progress: Progress = lambda _: None,
) -> BestBound | None:
    """The strongest bound that is proved, to a tolerance in the margin's unit; None if no bound is proved.

    It is the largest one of a margin that is better larger, the smallest one of a margin that is better smaller. The
    first try is the worst sampled value, eased by the tolerance. If it is refuted, the value of the counterexample
    replaces the worst one. If it is undecided, the search finds the smallest k for which a distance of 2^k tolerances
    is proved, from the largest k down, as a wide distance is proved fast. So compare `sampled` with the bound. For a
    positive lower bound none of 0 or below is tried, as it says nothing, unless the tolerance itself requires it.

    Args:
        most_boxes, seconds: for all tries together. One try gets a quarter of the boxes and half of the time left,
            the first one a quarter of it.
        robot, region, margin, bounds, characteristic_length, progress: as in `certify`.
    """
    tolerance, budget = positive("tolerance", tolerance), Budget(seconds)
    weakest = Bound.weakest(robot.margin_named(margin).sense)  # the bound is still unknown
    statement = Statement.of(robot, margin, weakest, bounds, characteristic_length)
    region.check(robot.pose_names)
    share = max(1, checked_boxes(most_boxes) // _SHARES)
    sampled = float(statement.value(suspects(statement, region, 10 * SEED, budget.share(_SHARES))[0]))
    best: Certificate | None = None
    undecided, proved, doublings = -1, _coarsest(weakest.sense * sampled, tolerance) + 1, 0
    for _ in range(_MOST_TRIES):
        if not np.isfinite(sampled) or undecided + 1 >= proved or budget.spent:
            break
        attempt = replace(statement, bound=replace(weakest, value=sampled).eased(math.ldexp(tolerance, doublings)))
        certificate = answer(attempt, region, share, budget.share(2 if undecided >= 0 else 4), progress)
        if certificate.counterexample is not None:
            sampled = float(statement.value(certificate.counterexample))
            continue
        if certificate.status == "proved":
            best, proved = certificate, doublings
        else:
            undecided = doublings
        doublings = proved - 1
    return BestBound(best, sampled) if best else None


def _coarsest(sampled: float, tolerance: float) -> int:
    """How often the tolerance may be doubled while the bound of a positive margin stays positive."""
    room = sampled / tolerance if sampled > 0.0 else math.inf
    return _COARSEST if room > 2.0**_COARSEST else max(0, math.ceil(math.log2(room)) - 1)
