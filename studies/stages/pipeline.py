"""The stages of a study; each takes data and returns data. Nothing here writes a file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from design import Certificate, Problem, Region, Synthesis, WorstPoses, active_sets, synthesise, worst_of
from kinematics import LinkwrightError, LoadsFromRest, Mechanism
from studies.building import home_of, problem_of, region_of
from studies.errors import Failed, RequirementFailed
from studies.stages.cycle_stage import Timing, time_cycle
from studies.stages.on_cycle import WorstOnCycle, failed_on_cycle, worst_on_cycle
from studies.stages.proofs import Proof, Question, prove_all
from studies.stages.timed_stage import Lasting, Progress, stage
from studies.study_file import Study

GIVEN = "geometry given by the study"


@dataclass(frozen=True)
class Outcome:
    """All that a study's report shows.

    Attributes:
        study, problem, region: what the study asks.
        robot: the robot with its final geometry: the optimum, or the study's own.
        synthesis: how the geometry was found; None if it was given, or found by an earlier run.
        solver_status: the solver's last status, or a note that the geometry was given.
        worst: the worst poses, by margin.
        prototype: the same for the study's own geometry; empty if the robot has that geometry.
        on_cycle: the worst value of each requirement's margin on the cycle; empty without a cycle.
        timing: the timed cycle; None if the study asks for none.
        prototype_timing: the cycle of the study's own geometry, to compare with; None if there is none.
        unasked, unasked_before: as `worst` and `prototype`, of the margins that the study did not ask about.
        loads: the largest loads of the members over the region, from rest; None before that stage.
        proofs: the answers to the claims; empty before that stage.
    """

    study: Study
    problem: Problem
    region: Region
    robot: Mechanism
    synthesis: Synthesis | None
    solver_status: str
    worst: dict[str, WorstPoses]
    prototype: dict[str, WorstPoses] | None
    on_cycle: dict[str, WorstOnCycle] = field(default_factory=dict)
    timing: Timing | None = None
    prototype_timing: Timing | None = None
    unasked: dict[str, WorstPoses] = field(default_factory=dict)
    unasked_before: dict[str, WorstPoses] | None = None
    loads: LoadsFromRest | None = None
    proofs: tuple[Proof, ...] = ()

    @property
    def before(self) -> str:
        """Name of the study's own geometry: "prototype" if it is the mechanism's prototype, else "given"."""
        return "given" if self.study.geometry else "prototype"

    @property
    def question(self) -> Question:
        """What should be proved of this robot."""
        return Question(self.study, self.problem, self.region, self.robot)

    def part(self, margin: str) -> str | None:
        """The part of the robot that has the worst value of a margin, such as "limb 1"."""
        return self.question.part(margin, (self.worst | self.unasked)[margin].pose)

    @property
    def active(self) -> list[str]:
        """The constraints that limit the optimum; empty if nothing was optimised."""
        if self.study.optimise is None:
            return []
        return active_sets(self.problem, self.robot, self.worst)

    def cycle_figures(self) -> dict[str, Any]:
        """The cycle's figures as plain data; empty without a cycle."""
        if self.timing is None:
            return {}
        return {
            **self.timing.figures(),
            "worst_on_the_path": {name: worst.value for name, worst in self.on_cycle.items()},
        }

    def require_all(self) -> None:
        """Check every requirement, over the region and on the cycle, and that no claim is refuted.

        Raises:
            RequirementFailed: it holds each requirement that fails.
        """
        failed = []
        for requirement in self.problem.requirements:
            worst = self.worst[requirement.margin]
            bound = requirement.bound
            if not bound.room(worst.value) >= 0.0:
                name, at, part = requirement.margin, tuple(worst.pose.tolist()), self.part(requirement.margin)
                failed.append(Failed(name, bound, worst.value, at, part=part))
        failed += failed_on_cycle(self.problem, self.on_cycle)
        for proof in self.proofs:
            if (pose := proof.certificate.counterexample) is not None:
                name, bound = proof.certificate.margin, proof.certificate.bound
                failed.append(Failed(name, bound, proof.sampled, tuple(pose.tolist()), part=proof.part))
        if failed:
            raise RequirementFailed(failed)


def optimise(study: Study, progress: Progress) -> Synthesis:
    """Run the study's synthesis. An error names the study's table `[optimise]`."""
    return synthesise(
        problem_of(study),
        region_of(study),
        seed=study.optimise.seed if study.optimise else 0,
        starts=study.optimise.starts if study.optimise else 1,
        about=study.dense_sample,
        progress=progress,
        seconds=study.budget.optimise if study.optimise else math.inf,
    )


def _tell_intersection(robot: Mechanism, progress: Progress) -> None:
    """Tell if bodies of the study's own geometry intersect at home: which two, and how deep."""
    if "clearance" in robot.margins and (room := float(robot.margin("clearance", robot.home))) < 0.0:
        pair = robot.margin_place("clearance", robot.home)
        progress(f"the study's own geometry intersects itself at home: {pair}, {-room:.3g} m deep")


def designed(study: Study, robot: Mechanism | None, progress: Progress, solver_status: str = GIVEN) -> Outcome:
    """The geometry and its worst poses. If a robot is given, such as a known optimum, nothing is optimised.

    Args:
        solver_status: the solver's last status for the given robot.
    """
    problem, region = problem_of(study), region_of(study)
    _tell_intersection(problem.robot, progress)
    if study.home is not None and study.optimise is None:
        home_of(problem.robot)
    if robot is None and study.optimise is not None:
        with stage("optimise", progress, study.budget.optimise):
            found = optimise(study, progress)
        return Outcome(study, problem, region, found.robot, found, found.status, found.after, found.before)
    robot = robot or problem.robot
    with stage("worst poses", progress):
        worst = worst_of(problem, robot, region, study.dense_sample)
        before = None
        if robot.geometry != problem.robot.geometry:
            before = worst_of(problem, problem.robot, region, study.dense_sample)
    return Outcome(study, problem, region, robot, None, solver_status, worst, before)


def with_cycle(outcome: Outcome, progress: Progress, compare: bool = True) -> Outcome:
    """The outcome with the study's cycle, if the study asks for one.

    Args:
        compare: also time the cycle on the study's own geometry, if the robot has another.

    Raises:
        RequirementFailed: the cycle was refused, and requirements fail over the region too.
        LinkwrightError: the cycle was refused.
    """
    study, prototype = outcome.study, None
    if study.trajectory is None:
        return outcome
    try:
        with stage("cycle", progress):
            timing = time_cycle(study, outcome.robot)
    except LinkwrightError as error:
        try:
            outcome.require_all()
        except RequirementFailed:  # it comes first: the cycle may have failed for the same reason
            progress(Lasting(f"the cycle was refused: {error}"))
            raise
        raise
    on_cycle = worst_on_cycle(outcome.problem, timing, study.trajectory.grid)
    if weakness := timing.weakness():
        progress(Lasting(weakness))
    if outcome.prototype is not None and compare:
        try:
            with stage("cycle of the study's own geometry", progress):
                prototype = time_cycle(study, outcome.problem.robot)
        except LinkwrightError as error:  # this cycle is only for comparison, so the run goes on without it
            progress(Lasting(f"the study's own geometry has no cycle for comparison: {error}"))
    return replace(outcome, on_cycle=on_cycle, timing=timing, prototype_timing=prototype)


def run(study: Study, robot: Mechanism | None, progress: Progress, compare_cycles: bool = True) -> Outcome:
    """Geometry and cycle. If a robot is given, its geometry is kept and nothing is optimised."""
    return with_cycle(designed(study, robot, progress), progress, compare_cycles)


def certified(outcome: Outcome, known: Mapping[str, Certificate], progress: Progress) -> Outcome:
    """The outcome with the study's proofs. A known certificate that proves a claim is only replayed.

    Raises:
        RequirementFailed: the dense search or a proof finds a pose where a requirement fails.
    """
    outcome.require_all()
    with stage("prove", progress, outcome.study.budget.prove):
        proofs = prove_all(outcome.question, outcome.worst, known, progress)
    found = replace(outcome, proofs=proofs)
    found.require_all()
    required = {requirement.margin for requirement in outcome.problem.requirements}
    if missing := [p.claim for p in proofs if p.certificate.margin in required and p.certificate.status != "proved"]:
        progress(Lasting(f"not proved, only sampled: {', '.join(missing)}"))
    return found
