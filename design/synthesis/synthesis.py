"""Optimal geometry by exchange: solve on few poses, search everywhere, add the worst poses found, solve again.

An optimum for a fixed coarse sample can be bad between its poses. So the poses where the last answer was worst are
added, until a dense search with descents agrees with the nonlinear program (NLP). Only such an answer is returned.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from design.budget import Budget
from design.regions import Region
from design.sampling import DENSE, WorstPoses
from design.synthesis.exchange import Candidate, Exchange, Progress, Round
from design.synthesis.nlp import NlpSolution, Problem
from design.synthesis.random_starts import STARTS, reaching_starts, require_possible_sums
from kinematics import Array, Mechanism, positive, whole

SECONDS = 600.0


@dataclass(frozen=True)
class Synthesis:
    """An optimum that the dense search confirmed.

    Attributes:
        robot: the mechanism with the optimal geometry.
        before, after: worst poses of the objective and of each requirement, by margin, of prototype and optimum.
        rounds: the rounds of the exchange.
        status: the solver's last status.
        sampled: number of poses of each dense grid.
    """

    robot: Mechanism
    before: dict[str, WorstPoses]
    after: dict[str, WorstPoses]
    rounds: list[Round]
    status: str
    sampled: int


def synthesise(
    problem: Problem,
    region: Region,
    *,
    seed: int = 0,
    starts: int = STARTS,
    about: int = DENSE,
    max_rounds: int = 20,
    tolerance: float = 1e-5,
    seconds: float = SECONDS,
    progress: Progress = lambda _: None,
) -> Synthesis:
    """Make the worst value of the objective over the region as good as possible.

    Args:
        problem: the variables, the requirements and what the FVI is measured with.
        region: the workspace.
        seed, starts: the first NLP starts from the prototype and from `starts - 1` random geometries; the best answer
            is used.
        about: approximate number of poses of the dense grids.
        max_rounds: the most rounds.
        tolerance: the NLP and the dense search agree if they differ by less than this, relative to the objective's
            size.
        seconds: the most wall-clock time [s].
        progress: called with a line of text at each step.

    Raises:
        SynthesisFailed: no start converged, the rounds did not settle, or the time ended; it holds the best geometry
            seen.
        InvalidRegion, InvalidValue: the region does not fit the robot, or a number is impossible.
    """
    tolerance, starts = positive("tolerance", tolerance), whole("starts", starts, 1)
    rounds = whole("max_rounds", max_rounds, 1)
    exchange = Exchange(problem, region, about, Budget(seconds), progress)
    region.check(problem.robot.pose_names)
    require_possible_sums(problem)
    before = exchange.look(problem.robot)
    if problem.allows(problem.robot):
        exchange.note(problem.robot, before)
    poses = region.spread(problem.robot.pose_names)
    firsts = reaching_starts(problem, poses, seed, starts)
    return _exchanged(exchange, before, poses, firsts, rounds, tolerance)


def _exchanged(
    exchange: Exchange,
    before: dict[str, WorstPoses],
    poses: Array,
    firsts: list[Array],
    most_rounds: int,
    tolerance: float,
) -> Synthesis:
    """All rounds; the first one uses the poses (p, n)."""
    problem = exchange.problem
    sizes = problem.sizes(problem.robot_with(firsts[0]), poses)
    solution = exchange.best_of(poses, firsts, sizes)
    rounds: list[Round] = []
    while len(rounds) < most_rounds:
        robot = exchange.robot_of(solution)
        after = exchange.look(robot)
        found = exchange.note(robot, after)
        rounds.append(_round(solution, found, len(poses)))
        exchange.progress(f"round {len(rounds)}: {rounds[-1]}")
        slack = tolerance * abs(solution.objective)
        settled = found.good >= problem.good(solution.objective) - slack and found.shortfall <= 0.0
        better = exchange.better_than(found, slack)
        if settled and better is None and all(worst.complete for worst in after.values()):
            return Synthesis(robot, before, after, rounds, solution.status, after[problem.objective].sampled)
        exchange.require_time(f"after {len(rounds)} rounds, the last one: {rounds[-1]}", solution)
        poses = np.concatenate([poses, *(_offenders(problem, solution, sizes, slack, *item) for item in after.items())])
        nearest = better.robot.geometry.vector()[problem.places()] if settled and better else solution.values
        solution = exchange.first_of(poses, [nearest, *firsts], sizes)
    raise exchange.failed(f"the exchange did not settle; its last round: {rounds[-1]}", solution)


def _round(solution: NlpSolution, found: Candidate, poses: int) -> Round:
    return Round(
        poses=poses,
        promised=solution.objective,
        found=found.objective,
        shortfall=found.shortfall,
        iterations=solution.iterations,
        seconds=solution.seconds,
    )


def _offenders(
    problem: Problem, solution: NlpSolution, sizes: Mapping[str, float], slack: float, margin: str, worst: WorstPoses
) -> Array:
    """(k, n) poses where the last answer is worse than promised; for the objective by more than `slack`.

    If the objective is as good as promised, hundreds of its worst poses are within the slack. They would only make the
    next NLP slow.
    """
    sense, spare = problem.robot.margin_named(margin).sense, problem.spare * sizes[margin]
    floors = [sense * r.bound.value + spare for r in problem.requirements if r.margin == margin]
    if margin == problem.objective:
        floors.append(problem.good(solution.objective) - slack)
    return worst.poses[sense * worst.values < max(floors)]
