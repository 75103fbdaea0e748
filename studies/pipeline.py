"""The stages of a study, each from data to data; nothing here writes a file."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import partial
from typing import Any

from design.nlp import Problem
from design.region import Region
from design.search import WorstPoses
from design.synthesis import Progress, Synthesis, synthesise, worst_of
from kinematics import Mechanism
from studies import schema, setup
from studies.schema import Study
from trajectory import Approach, Cycle, Setpoints, cycle_setpoints, there_and_back


@dataclass(frozen=True)
class Timing:
    """A cycle, its set-points, and the way to its start.

    Attributes:
        cycle: both ways, timed and verified.
        setpoints: of the cycle, stretched to whole periods and verified again.
        approach: from home; None where the study asks for none.
        seconds: wall-clock time of timing and verification.
    """

    cycle: Cycle
    setpoints: Setpoints
    approach: Approach | None
    seconds: float

    @property
    def half_cycle(self) -> float:
        """The way there, before the stretch to whole periods [s]."""
        return self.cycle.pieces[0].timed.law.duration

    def figures(self) -> dict[str, Any]:
        """What the timing claims, as plain data."""
        there = self.cycle.pieces[0].timed
        return {
            "law": there.law.name,
            "half_cycle": there.law.duration,
            "cycle_on_the_bus": float(self.setpoints.time[-1]),
            "repair_factor": there.factor,
            "peak_over_limit": {
                name: max(piece.timed.verification.peak_over_limit[name] for piece in self.cycle.pieces)
                for name in there.verification.peak_over_limit
            },
            "worst_rms_over_peak_torque": float(there.verification.rms_over_peak.max()),
        }


@dataclass(frozen=True)
class Outcome:
    """All that a study's report shows.

    Attributes:
        study, problem, region: what was asked.
        robot: the geometry that stands at the end: the optimum, or the study's own.
        synthesis: how it was found; None where the geometry was given.
        worst: the worst pose of each margin, by its name.
        prototype: the same for the prototype, where a synthesis changed it.
        timing: the cycle; None where the study asks for none.
        prototype_timing: the prototype's cycle, to compare with.
    """

    study: Study
    problem: Problem
    region: Region
    robot: Mechanism
    synthesis: Synthesis | None
    worst: dict[str, WorstPoses]
    prototype: dict[str, WorstPoses] | None
    timing: Timing | None
    prototype_timing: Timing | None


def optimise(study: Study, progress: Progress) -> Synthesis:
    """The study's synthesis; what it raises, with the study's `[optimise]` table."""
    return synthesise(
        setup.problem_of(study),
        setup.region_of(study),
        seed=study.optimise.seed if study.optimise else 0,
        starts=study.optimise.starts if study.optimise else 1,
        about=study.dense_sample,
        progress=progress,
    )


def time_cycle(asked: schema.Trajectory, robot: Mechanism) -> Timing:
    """Time, verify and sample the study's cycle on a robot."""
    from trajectory.approach import plan_approach
    from trajectory.toppra_law import time_optimal

    started = time.perf_counter()
    path, limits, payload = setup.cycle_of(asked.cycle), setup.limits_of(asked.limits), asked.cycle.payload

    cycle = there_and_back(robot, path, limits, payload, partial(time_optimal, intervals=asked.grid))
    seconds = time.perf_counter() - started
    points = cycle_setpoints(cycle, asked.period, robot.actuator_units)
    approach = None
    if asked.approach is not None:
        approach = plan_approach(
            robot, points.pose[0], setup.limits_of(asked.approach), payload, asked.period, robot.actuator_units
        )
    return Timing(cycle, points, approach, seconds)


def run(study: Study, robot: Mechanism | None, progress: Progress, compare_cycles: bool = True) -> Outcome:
    """All stages; with a robot given (a committed optimum), its geometry stands and nothing is optimised.

    `compare_cycles` times the prototype's cycle too.
    """
    problem, region = setup.problem_of(study), setup.region_of(study)
    synthesis: Synthesis | None = None
    before: dict[str, WorstPoses] | None = None
    if robot is None and study.optimise is not None:
        synthesis = optimise(study, progress)
        robot, worst, before = synthesis.robot, synthesis.after, synthesis.before
    else:
        robot = robot or problem.robot
        progress("worst poses")
        worst = worst_of(problem, robot, region, study.dense_sample)
        if robot.geometry != problem.robot.geometry:
            before = worst_of(problem, problem.robot, region, study.dense_sample)
    timing = prototype_timing = None
    if study.trajectory is not None:
        progress("cycle")
        timing = time_cycle(study.trajectory, robot)
        if before is not None and compare_cycles:
            prototype_timing = time_cycle(study.trajectory, problem.robot)
    return Outcome(study, problem, region, robot, synthesis, worst, before, timing, prototype_timing)
