"""The proofs of a study's claims at every pose of its region, not only at the poses of a sample."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from design import Budget, Certificate, Problem, Region, WorstPoses, best_bound, certify, replay, worst_poses
from kinematics import Array, Bound, InvalidValue, LinkwrightError, Mechanism
from studies.building import problem_of, region_of
from studies.stages.bound_option import bound_option
from studies.stages.timed_stage import Progress
from studies.study_file import Study

_POSITIVE = 1e-12  # in a margin's unit: a bound above 0 that every usable robot keeps
_FEW = 4  # boxes; enough to run every compiled function of a proof once


@dataclass(frozen=True)
class Claim:
    """The margin keeps `required` everywhere. With `best`, also find the best bound that can be proved."""

    margin: str
    required: Bound | None
    best: bool


@dataclass(frozen=True)
class Proof:
    """The answer to one claim.

    Attributes:
        certificate: the claim, its answer and the boxes behind it.
        sampled: the worst value that a search found; the true worst value is between the proved bound and this.
        seconds: wall-clock time that the answer took.
        part: the part of the robot that has the lowest value, such as "limb 1"; None if there is no single one.
    """

    certificate: Certificate
    sampled: float
    seconds: float
    part: str | None

    @property
    def claim(self) -> str:
        """The claim in words."""
        return f"{self.certificate.margin} {self.certificate.bound.shown(7)}"

    @property
    def gap(self) -> float:
        """By how much the worst sampled value keeps the bound, in the margin's unit; negative if it is refuted."""
        return float(self.certificate.bound.room(self.sampled))


@dataclass(frozen=True)
class Question:
    """The data that all claims of a study share."""

    study: Study
    problem: Problem
    region: Region
    robot: Mechanism

    @property
    def measure(self) -> dict[str, Any]:
        """The arguments that the FVI is measured with."""
        return {"bounds": self.problem.fvi_bounds, "characteristic_length": self.problem.characteristic_length}

    def claims(self) -> tuple[Claim, ...]:
        """All claims of the study."""
        return claims_of(self.study, self.problem)

    def only(self, margin: str | None, at_least: float | None, at_most: float | None = None) -> tuple[Claim, ...]:
        """The study's claims, or only the one about `margin`.

        Raises:
            InvalidValue: the mechanism has no such margin, the bound has no margin, or the bound is impossible.
            InvalidOption: the bound is not finite, or the wrong option for the margin.
        """
        if margin is None:
            for option, value in (("--at-least", at_least), ("--at-most", at_most)):
                if value is not None:
                    raise InvalidValue(option, value, "--margin NAME with it")
            return self.claims()
        if margin not in self.robot.margins:
            raise InvalidValue("--margin", margin, f"one of {', '.join(self.robot.margins)}")
        bound = bound_option(self.robot.margins[margin], at_least, at_most)
        if bound is None:
            return (_claim(self.problem, margin),)
        if margin == "reach" and bound.value < 0.0:
            raise InvalidValue(
                "--at-least", bound.value, "0 m or more for reach, as every claim includes that the pose is in reach"
            )
        return (Claim(margin, bound, best=False),)

    def worst(self, margin: str) -> WorstPoses:
        """The worst poses that a dense search finds."""
        return worst_poses(self.robot, self.region, margin, about=self.study.dense_sample, **self.measure)

    def part(self, margin: str, pose: Array) -> str | None:
        """The part of the robot that has the lowest value of a margin at a pose (n,), such as "limb 1"."""
        return self.robot.margin_place(margin, pose, *self.measure.values())

    def prove(
        self,
        claim: Claim,
        worst: WorstPoses | None,
        known: Certificate | None,
        progress: Progress,
        seconds: float = math.inf,
    ) -> Proof:
        """Answer a claim. If the time ends before a decision, the claim is undecided.

        Args:
            worst: the worst poses that a dense search found; None to search now.
            known: a certificate. If it proves the claim it is replayed, and no other is searched for.
            progress: called with a line of text at each step.
            seconds: time that the proof may take [s].
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
            sense = certificate.bound.sense
            found = float(self.robot.margin(claim.margin, certificate.counterexample, *self.measure.values()))
            sampled = -sense * math.inf if math.isnan(found) else sense * min(sense * found, sense * sampled)
        pose = worst.pose if certificate.counterexample is None else certificate.counterexample
        proof = Proof(certificate, sampled, seconds, self.part(claim.margin, pose))
        progress(f"{certificate.status} {proof.claim}: {certificate.boxes} boxes, {seconds:.1f} s")
        return proof

    def compile(self, claim: Claim) -> None:
        """Bound a few boxes, so that the functions of a proof are compiled, or read from the disk."""
        bound = self.required(claim)
        if claim.required is None and bound.value == 0.0:
            bound = replace(bound, value=_POSITIVE)  # as those that the search for the best bound tries
        asked: dict[str, Any] = {bound.word: bound.value}
        certify(self.robot, self.region, claim.margin, **asked, most_boxes=_FEW, **self.measure)

    def replay(self, certificate: Certificate, claim: Claim) -> int:
        """The number of boxes that a certificate's replay bounds. Another claim's certificate raises an error."""
        asked: dict[str, Any] = {"region": self.region, "margin": claim.margin}
        bound = self.bound_of(claim) if claim.required else {}
        return replay(certificate, self.robot, **asked, **bound, **self.measure)

    def required(self, claim: Claim) -> Bound:
        """The required bound of a claim, else the weakest one."""
        return claim.required or Bound.weakest(self.robot.margins[claim.margin].sense)

    def bound_of(self, claim: Claim) -> dict[str, Any]:
        """The same as an argument of `certify`."""
        bound = self.required(claim)
        return {bound.word: bound.value}

    def _stands(self, known: Certificate, claim: Claim) -> bool:
        try:
            self.replay(known, claim)
        except LinkwrightError:
            return False
        return known.status == "proved"

    def _certificate(self, claim: Claim, worst: float, progress: Progress, seconds: float) -> Certificate:
        """Search for a certificate of the claim.

        A proved required bound within the tolerance of the worst value also counts as the best. If no best bound is
        proved, the weakest bound is tried. The search for a best bound gets half of the time if the required bound may
        still follow.
        """
        asked, budget = self.study.certify, Budget(seconds)
        search: dict[str, Any] = self.measure | {"most_boxes": asked.most_boxes, "progress": progress}
        required, tolerance = claim.required, asked.tolerance * abs(worst)
        near = required is not None and required.room(worst) <= tolerance
        if claim.best and not near and 0.0 < tolerance < math.inf:
            share = budget.share(1 if required is None else 2).seconds
            best = best_bound(self.robot, self.region, claim.margin, tolerance, seconds=share, **search)
            if best is not None and (required is None or required.room(best.certificate.bound.value) >= 0.0):
                return best.certificate
        left = budget.share(1).seconds
        return certify(self.robot, self.region, claim.margin, **self.bound_of(claim), seconds=left, **search)


def claims_of(study: Study, problem: Problem) -> tuple[Claim, ...]:
    """Claims of the margins that the study names; by default each requirement, and the best bound of the objective."""
    margins = study.certify.margins
    if margins is None:
        margins = tuple(dict.fromkeys([*(r.margin for r in problem.requirements), problem.objective]))
    return tuple(_claim(problem, margin) for margin in dict.fromkeys(margins))


def _claim(problem: Problem, margin: str) -> Claim:
    bounds = [r.bound for r in problem.requirements if r.margin == margin]
    strictest = max(bounds, key=lambda bound: bound.sense * bound.value, default=None)
    return Claim(margin, strictest, best=not bounds or margin == problem.objective)


def question_of(study: Study, robot: Mechanism) -> Question:
    """The question that a study asks about a robot."""
    return Question(study, problem_of(study), region_of(study), robot)


def prove_all(
    question: Question, worst: Mapping[str, WorstPoses], known: Mapping[str, Certificate], progress: Progress
) -> tuple[Proof, ...]:
    """Answer every claim of the study; `worst` and `known` are by margin and may lack some.

    The claims that are left share the time that is left of the budget.
    """
    return prove_claims(question, question.claims(), worst, known, progress)


def prove_claims(
    question: Question,
    claims: Sequence[Claim],
    worst: Mapping[str, WorstPoses],
    known: Mapping[str, Certificate],
    progress: Progress,
) -> tuple[Proof, ...]:
    """Answer these claims as in `prove_all`. The budget starts only when the functions of a proof are compiled."""
    if claims:
        question.compile(claims[0])
    budget = Budget(question.study.budget.prove)
    proofs = []
    for k, claim in enumerate(claims):
        seconds = budget.share(len(claims) - k).seconds
        proofs.append(question.prove(claim, worst.get(claim.margin), known.get(claim.margin), progress, seconds))
    return tuple(proofs)
