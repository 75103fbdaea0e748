"""The stages of a study, each from data to data; nothing here writes a file."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from design import Certificate
from design.nlp import Problem, active_sets
from design.region import Region
from design.search import WorstPoses
from design.synthesis import Synthesis, synthesise, worst_of
from kinematics import InvalidValue, LinkwrightError, Mechanism
from studies import setup
from studies.certify import Proof, Question, prove_all
from studies.errors import ApproachFailed, Failed, RequirementFailed
from studies.inside import leaving
from studies.schema import Study
from studies.stages import Lasting, Progress, stage
from trajectory import Cycle, Limits, Move, Path, Setpoints, cycle_setpoints, lower_bound, there_and_back
from trajectory.path_certificate import Way

_MOST_SETPOINTS = 1_000_000
GIVEN = "geometry given by the study"


@dataclass(frozen=True)
class Timing:
    """A cycle, its set-points, and the way to its start.

    Attributes:
        cycle: both ways, timed and verified.
        setpoints: of the cycle, stretched to whole periods and verified again.
        approach: from home; None where the study asks for none.
        lower_bound: no motion on the path itself takes less for the way there, even without a limit of jerk [s].
        seconds: wall-clock time of timing and verification.
    """

    cycle: Cycle
    setpoints: Setpoints
    approach: Move | None
    lower_bound: float
    seconds: float

    @property
    def half_cycle(self) -> float:
        """The way there, before the stretch to whole periods [s]."""
        return self.cycle.half

    @property
    def half_cycle_name(self) -> str:
        """Of `half_cycle` among the figures: "closed_cycle" where the way ends where it starts and none leads back."""
        return "half_cycle" if self.cycle.back else "closed_cycle"

    def figures(self) -> dict[str, Any]:
        """What the timing claims, as plain data."""
        there = [piece.timed for piece in self.cycle.there]
        return {
            "law": there[0].motion.name,
            self.half_cycle_name: self.half_cycle,
            "lower_bound": self.lower_bound,
            "cycle_on_the_bus": float(self.setpoints.time[-1]),
            "repair_factor": max(timed.factor for timed in there),
            "peak_over_limit": {
                name: max(piece.timed.verification.peak_over_limit[name] for piece in self.cycle.pieces)
                for name in there[0].verification.peak_over_limit
            },
            "worst_rms_over_peak_torque": max(float(timed.verification.rms_over_peak.max()) for timed in there),
            **({"limits_not_kept": list(self.cycle.not_kept)} if self.cycle.not_kept else {}),
        }


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
        setup.problem_of(study),
        setup.region_of(study),
        seed=study.optimise.seed if study.optimise else 0,
        starts=study.optimise.starts if study.optimise else 1,
        about=study.dense_sample,
        progress=progress,
        seconds=study.budget.optimise if study.optimise else math.inf,
    )


def margins_on(problem: Problem, robot: Mechanism, ways: Sequence[Way], grid: int) -> dict[str, float]:
    """The worst value of each requirement's margin on what a cycle travels; NaN counts as -inf."""
    poses = np.concatenate([way.evaluate(np.linspace(0.0, way.length, grid + 1), 0)[0] for way in ways])
    found = {}
    for requirement in problem.requirements:
        values = robot.margin(requirement.margin, poses, problem.fvi_bounds, problem.characteristic_length)
        found[requirement.margin] = float(np.where(np.isnan(values), -np.inf, values).min())
    return found


def require_on_cycle(study: Study, cycle: Cycle) -> None:
    """Check the study's requirements on its cycle.

    Raises:
        RequirementFailed: with each one that fails there.
    """
    assert study.trajectory is not None
    problem = setup.problem_of(study)
    found = margins_on(problem, cycle.robot, cycle.ways, study.trajectory.grid)
    failed = [
        Failed(f"{r.margin} on the cycle", r.at_least, found[r.margin], ())
        for r in problem.requirements
        if not found[r.margin] >= r.at_least
    ]
    if failed:
        raise RequirementFailed(failed)


def time_cycle(study: Study, robot: Mechanism) -> Timing:
    """Time, verify and sample the study's cycle on a robot.

    Raises:
        RequirementFailed: the cycle leaves the study's region; and what the timing law and the verification raise.
    """
    asked = study.trajectory
    assert asked is not None
    started = time.perf_counter()
    path, limits, payload = setup.path_of(asked, robot.pose_names), setup.limits_of(asked.limits), asked.payload
    approach = _approach(study, robot, path, limits)
    timing, cannot_keep = setup.timing_of(study)
    cycle = there_and_back(robot, path, limits, payload, timing, asked.payload_back, cannot_keep)
    _require_inside(setup.region_of(study), cycle)
    seconds = time.perf_counter() - started
    _require_few(sum(piece.duration for piece in cycle.pieces), asked.period)
    points = cycle_setpoints(cycle, asked.period, robot.actuator_units)
    bound = sum(lower_bound(robot, piece.path, limits, payload) for piece in cycle.there)
    return Timing(cycle, points, approach, bound, seconds)


def _approach(study: Study, robot: Mechanism, path: Path, limits: Limits) -> Move | None:
    """The move from home to the path's start, before hours of work go into what it leads to; None where none is asked.

    Raises:
        ApproachFailed: it cannot be, and why.
        HomeOutOfReach, UnreachablePose: of home, of the path's start.
    """
    from trajectory.moves import plan_move

    asked = study.trajectory
    assert asked is not None
    if asked.approach is None:
        return None
    (start,) = path.evaluate(np.array(0.0), 0)
    robot.require_reachable(start)
    home = setup.home_of(robot)
    gentle = setup.approach_limits(asked.approach, limits, len(robot.joint_names))
    try:
        return plan_move(robot, home, start, gentle, asked.payload, asked.period, robot.actuator_units)
    except LinkwrightError as error:
        raise ApproachFailed(tuple(home.tolist()), tuple(start.tolist()), error) from error


def _require_few(duration: float, period: float) -> None:
    """Check that a cycle has not more set-points than a drive and a memory can hold.

    Raises:
        InvalidValue: of the period.
    """
    if not duration <= _MOST_SETPOINTS * period:
        expected = f"one that cuts the cycle of {duration:.3g} s into at most {_MOST_SETPOINTS:,} set-points"
        raise InvalidValue("Trajectory period", period, expected)


def _require_inside(region: Region, cycle: Cycle) -> None:
    out = [found for way in cycle.ways if (found := leaving(region, way, cycle.robot.pose_names))]
    if out:
        room = "room to the region's boundary on the cycle [m or rad]"
        raise RequirementFailed([Failed(room, 0.0, found.room, tuple(found.pose.tolist())) for found in out])


def designed(study: Study, robot: Mechanism | None, progress: Progress, solver_status: str = GIVEN) -> Outcome:
    """The geometry and its worst poses; with a robot given (an optimum that is known), nothing is optimised.

    Args:
        solver_status: the solver's last word on the robot that is given.
    """
    problem, region = setup.problem_of(study), setup.region_of(study)
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
