"""What a study has proved over its region, beyond what a dense sample finds."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from design import Budget, Certificate, Problem, Region, WorstPoses, best_bound, certify, replay, worst_poses
from kinematics import InvalidValue, LinkwrightError, Mechanism, rounded_down
from studies.building import problem_of, region_of
from studies.stages.timed_stage import Progress
from studies.study_file import Study

_FEW = 4  # boxes: enough to run every kernel of a proof once


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
        """All that the study claims."""
        return claims_of(self.study, self.problem)

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
            if margin == "reach" and at_least < 0.0:
                raise InvalidValue("--at-least", at_least, "0 m or more for reach: every claim claims reach itself")
            return (Claim(margin, at_least, best=False),)
        return (_claim(self.problem, margin),)

    def worst(self, margin: str) -> WorstPoses:
        """What a dense search finds."""
        return worst_poses(self.robot, self.region, margin, about=self.study.dense_sample, **self.measure)

    def prove(
        self,
        claim: Claim,
        worst: WorstPoses | None,
        known: Certificate | None,
        progress: Progress,
        seconds: float = math.inf,
    ) -> Proof:
        """Answer a claim; one that is not decided in its time stays undecided.

        Args:
            worst: what a dense search found; None to search now.
            known: a certificate that is replayed instead of a search for another where it proves the claim.
            progress: told a line of text at each step.
            seconds: that the proof may take.
        """
        if worst is None:
            progress(f"worst poses of {claim.margin}")
            worst = self.worst(claim.margin)
        started = time.perf_counter()
        if known is not None and self._stands(known, claim):
            certificate = known
        else:
            certificate = self._certificate(claim, worst.value, progress, seconds)
        seconds, sampled = time.perf_counter() - started, worst.value
        if certificate.counterexample is not None:
            found = float(self.robot.margin(claim.margin, certificate.counterexample, *self.measure.values()))
            sampled = -math.inf if math.isnan(found) else min(found, sampled)
        proof = Proof(certificate, sampled, seconds)
        progress(f"{certificate.status} {proof.claim}: {certificate.boxes} boxes, {seconds:.1f} s")
        return proof

    def compile(self, claim: Claim) -> None:
        """Bound a few boxes, so that the kernels of a proof are compiled, or read from the disk."""
        certify(self.robot, self.region, claim.margin, at_least=claim.at_least or 0.0, most_boxes=_FEW, **self.measure)

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

    def _certificate(self, claim: Claim, worst: float, progress: Progress, seconds: float) -> Certificate:
        """A required bound within the tolerance of the worst case is the best, too; 0 is tried where none is proved.

        The best bound has half of the time where it may have to be followed by the required one.
        """
        asked, budget = self.study.certify, Budget(seconds)
        search: dict[str, Any] = self.measure | {"most_boxes": asked.most_boxes, "progress": progress}
        required, tolerance = claim.at_least, asked.tolerance * abs(worst)
        near = required is not None and worst - required <= tolerance
        if claim.best and not near and 0.0 < tolerance < math.inf:
            share = budget.share(1 if required is None else 2).seconds
            best = best_bound(self.robot, self.region, claim.margin, tolerance, seconds=share, **search)
            if best is not None and (required is None or best.certificate.at_least >= required):
                return best.certificate
        left = budget.share(1).seconds
        return certify(self.robot, self.region, claim.margin, at_least=required or 0.0, seconds=left, **search)


def claims_of(study: Study, problem: Problem) -> tuple[Claim, ...]:
    """The margins that the study names; else each required one, and the objective at its best."""
    margins = study.certify.margins
    if margins is None:
        margins = tuple(dict.fromkeys([*(r.margin for r in problem.requirements), problem.objective]))
    return tuple(_claim(problem, margin) for margin in dict.fromkeys(margins))


def _claim(problem: Problem, margin: str) -> Claim:
    bounds = [r.at_least for r in problem.requirements if r.margin == margin]
    return Claim(margin, max(bounds, default=None), best=not bounds or margin == problem.objective)


def question_of(study: Study, robot: Mechanism) -> Question:
    """What a study asks to be proved of a robot."""
    return Question(study, problem_of(study), region_of(study), robot)


def prove_all(
    question: Question, worst: Mapping[str, WorstPoses], known: Mapping[str, Certificate], progress: Progress
) -> tuple[Proof, ...]:
    """Every claim of the study; `worst` and `known` by margin, as far as there are any.

    What the budget has left is shared by the claims that are left.
    """
    return prove_claims(question, question.claims(), worst, known, progress)


def prove_claims(
    question: Question,
    claims: Sequence[Claim],
    worst: Mapping[str, WorstPoses],
    known: Mapping[str, Certificate],
    progress: Progress,
) -> tuple[Proof, ...]:
    """As `prove_all`, of these claims; the budget starts when the kernels are compiled, on a machine that is new."""
    if claims:
        question.compile(claims[0])
    budget = Budget(question.study.budget.prove)
    proofs = []
    for k, claim in enumerate(claims):
        seconds = budget.share(len(claims) - k).seconds
        proofs.append(question.prove(claim, worst.get(claim.margin), known.get(claim.margin), progress, seconds))
    return tuple(proofs)
