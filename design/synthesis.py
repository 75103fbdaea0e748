"""Optimal geometry by exchange: solve on few poses, look everywhere, add the worst poses found, solve again.

An optimum from a fixed coarse sample collapses between its poses; here the sample grows at the poses where the last
answer was worst, until a dense search with descents agrees with the NLP. Only such an answer is returned.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from design.errors import SynthesisFailed
from design.nlp import NlpSolution, Problem, solve
from design.region import Region
from design.search import DENSE, WorstPoses, worst_poses
from kinematics import Mechanism, UnreachablePose

Array = np.ndarray
_ATTEMPTS = 200  # geometries drawn for each wanted start


@dataclass(frozen=True)
class Round:
    """One exchange: what the NLP promised on its poses and what the dense search found."""

    poses: int
    promised: float
    found: float
    shortfall: float  # how far the worst requirement is below its bound; <= 0 when all hold
    iterations: int
    seconds: float

    def settled(self, tolerance: float) -> bool:
        """Whether the dense search keeps the promise and every requirement holds."""
        return self.found >= self.promised * (1.0 - tolerance) and self.shortfall <= 0.0

    def __str__(self) -> str:
        return (
            f"{self.poses} poses, promised {self.promised:.6f}, dense search found {self.found:.6f}, "
            f"requirements short by {max(self.shortfall, 0.0):.1e}"
        )


@dataclass(frozen=True)
class Synthesis:
    """An optimum that stood the dense search.

    Attributes:
        robot: the mechanism with the optimal geometry.
        before, after: worst poses of the objective and of each requirement, by margin: prototype and optimum.
        rounds: the exchanges.
        status: the solver's last word.
        sampled: poses of each dense grid.
    """

    robot: Mechanism
    before: dict[str, WorstPoses]
    after: dict[str, WorstPoses]
    rounds: list[Round]
    status: str
    sampled: int


Progress = Callable[[str], None]


def synthesise(
    problem: Problem,
    region: Region,
    *,
    seed: int = 0,
    starts: int = 3,
    about: int = DENSE,
    max_rounds: int = 20,
    tolerance: float = 1e-5,
    progress: Progress = lambda _: None,
) -> Synthesis:
    """Maximise the worst objective over the region.

    Args:
        problem: variables, requirements and what the FVI is measured with.
        region: the workspace.
        seed, starts: the prototype and `starts - 1` random geometries start the first NLP; the best answer goes on.
        about: size of the dense grids.
        max_rounds: exchanges before giving up.
        tolerance: relative difference between the NLP's promise and the dense search at which they agree.
        progress: told a line of text at each step.

    Raises:
        SynthesisFailed: no start converged, the exchange did not settle, or a requirement fails on the dense sample.
    """
    names = problem.robot.pose_names
    region.check(names)
    before = worst_of(problem, problem.robot, region, about)
    poses = region.spread(names)
    firsts = _reaching_starts(problem, poses, seed, starts)
    solution = _best(problem, poses, firsts, progress)
    rounds: list[Round] = []
    while len(rounds) < max_rounds:
        robot = _robot(problem, solution.values)
        after = worst_of(problem, robot, region, about)
        rounds.append(_round(problem, solution, after, len(poses)))
        progress(f"round {len(rounds)}: {rounds[-1]}")
        if rounds[-1].settled(tolerance):
            return Synthesis(robot, before, after, rounds, solution.status, after[problem.objective].sampled)
        poses = np.concatenate([poses, *(_offenders(problem, solution, *item) for item in after.items())])
        solution = _again(problem, poses, [solution.values, *firsts])
    raise SynthesisFailed(f"the exchange did not settle; its last round: {rounds[-1]}", solution.status)


def _again(problem: Problem, poses: Array, firsts: list[Array]) -> NlpSolution:
    """The first converged solution; the last optimum may not reach the poses that were added, then the others start."""
    for first in firsts:
        solution = solve(problem, poses, first)
        if solution.converged:
            return solution
    raise _not_converged(f"each of the NLP's {len(firsts)} starts over {len(poses)} poses", solution)


def _best(problem: Problem, poses: Array, firsts: list[Array], progress: Progress) -> NlpSolution:
    """The best converged solution of all starts."""
    best: NlpSolution | None = None
    for k, first in enumerate(firsts, start=1):
        solution = solve(problem, poses, first)
        progress(f"start {k} of {len(firsts)}: {solution.objective:.5f} ({solution.status})")
        if solution.converged and (best is None or solution.objective > best.objective):
            best = solution
    if best is None:
        raise _not_converged(f"each of the NLP's {len(firsts)} starts over {len(poses)} poses", solution)
    return best


def _not_converged(what: str, solution: NlpSolution) -> SynthesisFailed:
    short = "; ".join(f"{name} falls short by {by:.3g}" for name, by in solution.violations.items())
    return SynthesisFailed(f"{what} did not converge{': ' + short if short else ''}", solution.status)


def _reaching_starts(problem: Problem, poses: Array, seed: int, count: int) -> list[Array]:
    """Variables of geometries that reach every pose, the prototype's first; the others would start IPOPT on NaN.

    Raises:
        SynthesisFailed: none of many reaches them all; the one that comes nearest is described.
    """
    low, high = problem.bounds()
    rng = np.random.default_rng(seed)
    found: list[Array] = []
    nearest, shortest = problem.robot, -np.inf
    prototype = np.clip(problem.robot.geometry.vector()[problem.places()], low, high)
    for attempt in range(_ATTEMPTS * count):
        values = prototype if attempt == 0 else low + (high - low) * rng.random(len(low))
        robot = _robot(problem, values)
        margin = float(np.nan_to_num(robot.margin("reach", poses), nan=-np.inf).min())
        if margin > 0.0:
            found.append(values)
        elif margin > shortest:
            nearest, shortest = robot, margin
        if len(found) == count:
            break
    if not found:
        try:
            nearest.require_reachable(poses)
        except UnreachablePose as error:
            raise SynthesisFailed(
                f"none of {_ATTEMPTS * count} geometries within the bounds reaches the region; the nearest: {error}",
                "not started",
            ) from error
    return found


def _robot(problem: Problem, values: Array) -> Mechanism:
    """The mechanism with these variables, rounded to the micrometre so that a file holds exactly what was checked."""
    low, high = problem.bounds()
    vector = problem.geometry(np.clip(np.round(values, 6), low, high))
    return type(problem.robot)(problem.robot.Geometry.from_vector(vector), problem.robot.inertia, problem.robot.ranges)


def worst_of(problem: Problem, robot: Mechanism, region: Region, about: int = DENSE) -> dict[str, WorstPoses]:
    """Worst poses of the objective and of each requirement, by margin, from a grid of about that many poses."""
    margins = dict.fromkeys([problem.objective, *(r.margin for r in problem.requirements)])
    return {
        margin: worst_poses(
            robot,
            region,
            margin,
            bounds=problem.fvi_bounds,
            characteristic_length=problem.characteristic_length,
            about=about,
        )
        for margin in margins
    }


def _round(problem: Problem, solution: NlpSolution, after: dict[str, WorstPoses], poses: int) -> Round:
    shortfalls = [r.at_least - after[r.margin].value for r in problem.requirements]
    return Round(
        poses=poses,
        promised=solution.objective,
        found=after[problem.objective].value,
        shortfall=max(shortfalls, default=-np.inf),
        iterations=solution.iterations,
        seconds=solution.seconds,
    )


def _offenders(problem: Problem, solution: NlpSolution, margin: str, worst: WorstPoses) -> Array:
    """(k, n) poses at which the last answer does worse than it promised."""
    floors = [r.at_least + problem.spare for r in problem.requirements if r.margin == margin]
    if margin == problem.objective:
        floors.append(solution.objective)
    return worst.poses[worst.values < max(floors)]
