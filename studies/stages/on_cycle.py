"""The requirements on a cycle: the worst value of each one's margin there, and the place where it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from design import Problem
from kinematics import Array
from studies.building import problem_of
from studies.errors import Failed, RequirementFailed
from studies.stages.cycle_stage import Timing
from studies.study_file import Study
from trajectory import MemberPeak


@dataclass(frozen=True)
class WorstOnCycle:
    """The worst value of a margin on a cycle.

    Attributes:
        value: in the margin's unit; infinitely bad where a limb cannot reach.
        pose: where.
        when: the place on the path or the time, in words.
        part: the part of the robot that has it, such as "limb 1"; None if there is no single one.
    """

    value: float
    pose: tuple[float, ...]
    when: str
    part: str | None


def worst_on_cycle(problem: Problem, timing: Timing, grid: int) -> dict[str, WorstOnCycle]:
    """The worst value of each requirement's margin on the ways of a cycle, by margin.

    A safety factor of the members is also that of the weakest member in the motion, which has its own loads.
    """
    poses, places = _along(timing, grid)
    robot, found = timing.cycle.robot, {}
    measure = problem.fvi_bounds, problem.characteristic_length
    for requirement in problem.requirements:
        name, sense = requirement.margin, requirement.bound.sense
        values = robot.margin(name, poses, *measure)
        good = np.where(np.isnan(values), -np.inf, sense * values)
        k = int(good.argmin())
        part = robot.margin_place(name, poses[k], *measure)
        worst = WorstOnCycle(sense * float(good[k]), tuple(poses[k].tolist()), places[k], part)
        weakest = timing.weakest
        if robot.margins[name].of_members and weakest is not None and weakest.safety < worst.value:
            worst = _of_member(weakest)
        found[name] = worst
    return found


def _along(timing: Timing, grid: int) -> tuple[Array, list[str]]:
    """(k, n) the poses of the ways, and the place of each in words."""
    poses, places = [], []
    for way in timing.cycle.ways:
        at = np.linspace(0.0, way.length, grid + 1)
        poses.append(way.evaluate(at, 0)[0])
        where = "m along the path" if way is timing.cycle.path else "s after its piece starts"
        places += [f"{s:.4g} {where}" for s in at]
    return np.concatenate(poses), places


def _of_member(peak: MemberPeak) -> WorstOnCycle:
    part = f"{peak.member}, {peak.fails_by}"
    return WorstOnCycle(peak.safety, peak.safety_pose, f"{peak.safety_at:.4g} s after the cycle starts", part)


def failed_on_cycle(problem: Problem, found: Mapping[str, WorstOnCycle]) -> list[Failed]:
    """The requirements that fail on a cycle, each with its place."""
    return [
        Failed(f"{r.margin} on the cycle", r.bound, worst.value, worst.pose, part=worst.part, when=worst.when)
        for r in problem.requirements
        if (worst := found.get(r.margin)) is not None and not r.bound.room(worst.value) >= 0.0
    ]


def require_on_cycle(study: Study, timing: Timing) -> None:
    """Check the study's requirements on its cycle.

    Raises:
        RequirementFailed: with each one that fails there.
    """
    assert study.trajectory is not None
    problem = problem_of(study)
    if failed := failed_on_cycle(problem, worst_on_cycle(problem, timing, study.trajectory.grid)):
        raise RequirementFailed(failed)
