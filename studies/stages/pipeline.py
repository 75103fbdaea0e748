"""The stages of a study, each from data to data; nothing here writes a file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from design import Certificate, Problem, Region, Synthesis, WorstPoses, active_sets, synthesise, worst_of
from kinematics import LinkwrightError, Mechanism
from studies.building import problem_of, region_of
from studies.errors import Failed, RequirementFailed
from studies.stages.cycle_stage import Timing, margins_on, time_cycle
from studies.stages.proofs import Proof, Question, prove_all
from studies.stages.timed_stage import Lasting, Progress, stage
from studies.study_file import Study

GIVEN = "geometry given by the study"


@dataclass(frozen=True)
class Outcome:
    """All that a study's report shows.

    Attributes:
        study, problem, region: what was asked.
        robot: the geometry that stands at the end: the optimum, or the study's own.
        synthesis: how it was found; None where the geometry was given, or found by an earlier run.
        solver_status: the solver's last word on the geometry, or that it was given.
        worst: the worst pose of each margin, by its name.
        prototype: the same for the study's own geometry, where the robot has another.
        on_cycle: the worst value of each requirement's margin on the cycle; empty without one.
        timing: the cycle; None where the study asks for none.
        prototype_timing: the cycle of the study's own geometry, to compare with; None without one.
        proofs: what was tried to prove of every pose; empty before that stage.
    """

    study: Study
    problem: Problem
    region: Region
    robot: Mechanism
    synthesis: Synthesis | None
    solver_status: str
    worst: dict[str, WorstPoses]
    prototype: dict[str, WorstPoses] | None
    on_cycle: dict[str, float] = field(default_factory=dict)
    timing: Timing | None = None
    prototype_timing: Timing | None = None
    proofs: tuple[Proof, ...] = ()

    @property
    def before(self) -> str:
        """What the study's own geometry is called: the mechanism's prototype, or given where the study changes that."""
        return "given" if self.study.geometry else "prototype"

    @property
    def question(self) -> Question:
        """What is to be proved, of this robot."""
        return Question(self.study, self.problem, self.region, self.robot)

    @property
    def active(self) -> list[str]:
        """What holds the optimum back; empty where nothing was optimised."""
        if self.study.optimise is None:
            return []
        return active_sets(self.problem, self.robot, self.worst)

    def cycle_figures(self) -> dict[str, Any]:
        """What the cycle claims, as plain data; empty without one."""
        if self.timing is None:
            return {}
        return {**self.timing.figures(), "worst_on_the_path": self.on_cycle}

    def require_all(self) -> None:
        """Check every requirement, over the region and on the cycle, and that no claim is refuted.

        Raises:
            RequirementFailed: with each one that fails.
        """
        failed = []
        for requirement in self.problem.requirements:
            worst = self.worst[requirement.margin]
            if not worst.value >= requirement.at_least:
                failed.append(Failed(requirement.margin, requirement.at_least, worst.value, tuple(worst.pose.tolist())))
            on_path = self.on_cycle.get(requirement.margin, math.inf)
            if not on_path >= requirement.at_least:
                failed.append(Failed(f"{requirement.margin} on the cycle", requirement.at_least, on_path, ()))
        for proof in self.proofs:
            if (pose := proof.certificate.counterexample) is not None:
                name, bound = proof.certificate.margin, proof.certificate.at_least
                failed.append(Failed(name, bound, proof.sampled, tuple(pose.tolist())))
        if failed:
            raise RequirementFailed(failed)


def optimise(study: Study, progress: Progress) -> Synthesis:
    """The study's synthesis; what it raises, with the study's `[optimise]` table."""
    return synthesise(
        problem_of(study),
        region_of(study),
        seed=study.optimise.seed if study.optimise else 0,
        starts=study.optimise.starts if study.optimise else 1,
        about=study.dense_sample,
        progress=progress,
        seconds=study.budget.optimise if study.optimise else math.inf,
    )


def designed(study: Study, robot: Mechanism | None, progress: Progress, solver_status: str = GIVEN) -> Outcome:
    """The geometry and its worst poses; with a robot given (an optimum that is known), nothing is optimised.

    Args:
        solver_status: the solver's last word on the robot that is given.
    """
    problem, region = problem_of(study), region_of(study)
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
    """The outcome with the study's cycle, where it asks for one.

    Args:
        compare: time it on the study's own geometry too, where the robot has another.
    """
    study, prototype = outcome.study, None
    if study.trajectory is None:
        return outcome
    with stage("cycle", progress):
        timing = time_cycle(study, outcome.robot)
    on_cycle = margins_on(outcome.problem, outcome.robot, timing.cycle.ways, study.trajectory.grid)
    if outcome.prototype is not None and compare:
        try:
            with stage("cycle of the study's own geometry", progress):
                prototype = time_cycle(study, outcome.problem.robot)
        except LinkwrightError as error:  # it is there to compare with, and need not be able to
            progress(Lasting(f"the study's own geometry has no cycle to compare with: {error}"))
    return replace(outcome, on_cycle=on_cycle, timing=timing, prototype_timing=prototype)


def run(study: Study, robot: Mechanism | None, progress: Progress, compare_cycles: bool = True) -> Outcome:
    """Geometry and cycle; with a robot given, its geometry stands and nothing is optimised."""
    return with_cycle(designed(study, robot, progress), progress, compare_cycles)


def certified(outcome: Outcome, known: Mapping[str, Certificate], progress: Progress) -> Outcome:
    """The outcome with the study's proofs; certificates that are known and prove a claim are only replayed.

    Raises:
        RequirementFailed: the dense search or a proof's search finds a requirement broken.
    """
    outcome.require_all()
    with stage("prove", progress, outcome.study.budget.prove):
        proofs = prove_all(outcome.question, outcome.worst, known, progress)
    found = replace(outcome, proofs=proofs)
    found.require_all()
    return found
