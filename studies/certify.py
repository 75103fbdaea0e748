"""What a study has proved over its region, beyond what a dense sample finds."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from design import Certificate, Region, best_bound, certify, replay, worst_poses
from design.budget import Budget
from design.exchange import Progress
from design.nlp import Problem
from design.search import WorstPoses
from kinematics import Mechanism
from kinematics.errors import InvalidValue, LinkwrightError
from kinematics.shown import rounded_down
from studies import setup
from studies.schema import Study


@dataclass(frozen=True)
class Claim:
    """`margin` is `at_least` this everywhere; with `best`, the best bound that can be proved, no lower than this."""

    margin: str
    at_least: float | None
    best: bool


@dataclass(frozen=True)
class Proof:
    """The answer to one claim.

    Attributes:
        certificate: the claim, its answer and the boxes behind it.
        sampled: the lowest value that a search found; the true worst lies between it and what is proved.
        seconds: wall-clock time that the answer took.
    """

    certificate: Certificate
    sampled: float
    seconds: float

    @property
    def claim(self) -> str:
        """In words."""
        return f"{self.certificate.margin} >= {rounded_down(self.certificate.at_least, 7)}"

    @property
    def gap(self) -> float:
        """How far the lowest sampled value is above the bound, in the margin's unit; negative where refuted."""
        return self.sampled - self.certificate.at_least


@dataclass(frozen=True)
class Question:
    """What all claims of a study share."""

    study: Study
    problem: Problem
    region: Region
    robot: Mechanism

    @property
    def measure(self) -> dict[str, Any]:
        """What the FVI is measured with, as arguments."""
        return {"bounds": self.problem.fvi_bounds, "characteristic_length": self.problem.characteristic_length}

    def claims(self) -> tuple[Claim, ...]:
        """The margins that the study names; else each required one, and the objective at its best."""
        margins = self.study.certify.margins
        if margins is None:
            margins = tuple(dict.fromkeys([*(r.margin for r in self.problem.requirements), self.problem.objective]))
        return tuple(self._claim(margin) for margin in margins)

    def _claim(self, margin: str) -> Claim:
        bounds = [r.at_least for r in self.problem.requirements if r.margin == margin]
        return Claim(margin, max(bounds, default=None), best=not bounds or margin == self.problem.objective)

    def only(self, margin: str | None, at_least: float | None) -> tuple[Claim, ...]:
        """The study's claims, or the one that is asked instead.

        Raises:
            InvalidValue: the mechanism has no such margin, or the bound is for none.
        """
        if margin is None:
            if at_least is not None:
                raise InvalidValue("--at-least", at_least, "--margin NAME beside it")
            return self.claims()
        if margin not in self.robot.margins:
            raise InvalidValue("--margin", margin, f"one of {', '.join(self.robot.margins)}")
        if at_least is not None:
            if not math.isfinite(at_least):
                raise InvalidValue("--at-least", at_least, "a finite number")
            return (Claim(margin, at_least, best=False),)
        return (self._claim(margin),)

    def worst(self, margin: str, seconds: float = math.inf) -> WorstPoses:
        """What a dense search finds in so much time."""
        asked: dict[str, Any] = {"about": self.study.dense_sample, "seconds": seconds}
        return worst_poses(self.robot, self.region, margin, **asked, **self.measure)

    def prove(
        self,
        claim: Claim,
        worst: WorstPoses | None,
        known: Certificate | None,
        progress: Progress,
        seconds: float = math.inf,
    ) -> Proof:
        """Answer a claim.

        Args:
            worst: what a dense search found; None to search now.
            known: a certificate that is replayed instead of a search for another where it proves the claim.
            progress: told a line of text at each step.
            seconds: for the searches; a proof that runs out of them is "undecided", with the boxes left.
        """
        budget = Budget(seconds)
        if worst is None:
            progress(f"worst poses of {claim.margin}")
            worst = self.worst(claim.margin, budget.share(4).seconds)
        started = time.perf_counter()
        if known is not None and self._stands(known, claim):
            certificate = known
        else:
            certificate = self._certificate(claim, worst.value, progress, budget)
        seconds, sampled = time.perf_counter() - started, worst.value
        if certificate.counterexample is not None:
            found = float(self.robot.margin(claim.margin, certificate.counterexample, *self.measure.values()))
            sampled = -math.inf if math.isnan(found) else min(found, sampled)
        proof = Proof(certificate, sampled, seconds)
        progress(f"{certificate.status} {proof.claim}: {certificate.boxes} boxes, {seconds:.1f} s")
        return proof

    def replay(self, certificate: Certificate, claim: Claim) -> int:
        """How many boxes a certificate's replay bounds; what it raises, where it was made for anything else."""
        asked: dict[str, Any] = {"region": self.region, "margin": claim.margin, "at_least": claim.at_least}
        return replay(certificate, self.robot, **asked, **self.measure)

    def _stands(self, known: Certificate, claim: Claim) -> bool:
        try:
            self.replay(known, claim)
        except LinkwrightError:
            return False
        return known.status == "proved"

    def _certificate(self, claim: Claim, worst: float, progress: Progress, budget: Budget) -> Certificate:
        """A required bound within the tolerance of the worst case is the best, too; 0 is tried where none is proved."""
        asked = self.study.certify
        search: dict[str, Any] = self.measure | {"most_boxes": asked.most_boxes, "progress": progress}
        required, tolerance = claim.at_least, asked.tolerance * abs(worst)
        near = required is not None and worst - required <= tolerance
        if claim.best and not near and 0.0 < tolerance < math.inf:
            share = budget.share(2).seconds
            best = best_bound(self.robot, self.region, claim.margin, tolerance, seconds=share, **search)
            if best is not None and (required is None or best.certificate.at_least >= required):
                return best.certificate
        left = budget.share(1).seconds
        return certify(self.robot, self.region, claim.margin, at_least=required or 0.0, seconds=left, **search)


def question_of(study: Study, robot: Mechanism) -> Question:
    """What a study asks to be proved of a robot."""
    return Question(study, setup.problem_of(study), setup.region_of(study), robot)


def prove_all(
    question: Question,
    worst: Mapping[str, WorstPoses],
    known: Mapping[str, Certificate],
    progress: Progress,
    seconds: float = math.inf,
) -> tuple[Proof, ...]:
    """Every claim of the study.

    Args:
        worst, known: by margin, as far as there are any; see `Question.prove`.
        progress: told a line of text at each step.
        seconds: for all; each claim gets an equal share of what is left.
    """
    budget, claims, proofs = Budget(seconds), question.claims(), []
    for k, claim in enumerate(claims):
        share = budget.share(len(claims) - k).seconds
        proofs.append(question.prove(claim, worst.get(claim.margin), known.get(claim.margin), progress, share))
    return tuple(proofs)
