"""Optimal geometry by exchange: solve on few poses, look everywhere, add the worst poses found, solve again.

An optimum from a fixed coarse sample collapses between its poses; here the sample grows at the poses where the last
answer was worst, until a dense search with descents agrees with the NLP. Only such an answer is returned.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from design.budget import Budget
from design.errors import SynthesisFailed
from design.nlp import NlpSolution, Problem, solve
from design.region import Region
from design.search import DENSE, WorstPoses, worst_poses
from kinematics import Mechanism, UnreachablePose
from kinematics.arguments import positive, whole

Array = np.ndarray
SECONDS = 600.0
_ATTEMPTS = 200  # geometries drawn for each wanted start
_DIGITS = 8  # of a variable, so that a file holds exactly what was checked


@dataclass(frozen=True)
class Round:
    """One exchange: what the NLP promised on its poses and what the dense search found."""

    poses: int
    promised: float
    found: float
    shortfall: float  # how far the worst requirement is below its bound; <= 0 when all hold
    iterations: int
    seconds: float

    def __str__(self) -> str:
        return (
            f"{self.poses} poses, promised {self.promised:.6g}, dense search found {self.found:.6g}, "
            f"requirements short by {max(self.shortfall, 0.0):.1e}"
        )


@dataclass(frozen=True)
class Candidate:
    """A geometry that was looked at densely, and that nothing says to be the best.

    Attributes:
        robot: the mechanism with this geometry.
        worst: worst poses by margin, as far as a dense search looked.
        objective: the worst value of the objective.
        shortfall: how far the worst requirement is below its bound; <= 0 when all hold.
    """

    robot: Mechanism
    worst: dict[str, WorstPoses]
    objective: float
    shortfall: float

    @property
    def rank(self) -> tuple[float, float]:
        """The larger the better: whether requirements hold, then the objective."""
        return -max(self.shortfall, 0.0), self.objective

    def __str__(self) -> str:
        short = f", requirements short by {self.shortfall:.3g}" if self.shortfall > 0.0 else ""
        return f"{self.objective:.6g}{short} with {self.robot.geometry}"


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
    seconds: float = SECONDS,
    progress: Progress = lambda _: None,
) -> Synthesis:
    """Maximise the worst objective over the region.

    Args:
        problem: variables, requirements and what the FVI is measured with.
        region: the workspace.
        seed, starts: the prototype and `starts - 1` random geometries start the first NLP; the best answer goes on.
        about: size of the dense grids.
        max_rounds: exchanges before giving up.
        tolerance: difference between the NLP's promise and the dense search at which they agree, relative to the
            objective's size.
        seconds: wall-clock time before giving up.
        progress: told a line of text at each step.

    Raises:
        SynthesisFailed: no start converged, the exchange did not settle, or the time was used up; with the best
            geometry seen.
        InvalidRegion, InvalidValue: the region is not the robot's, or a number means nothing.
    """
    tolerance, starts = positive("tolerance", tolerance), whole("starts", starts, 1)
    exchange = _Exchange(problem, region, about, Budget(seconds), progress)
    region.check(problem.robot.pose_names)
    _require_possible_sums(problem)
    before = worst_of(problem, problem.robot, region, about, exchange.budget.left)
    exchange.note(problem.robot, before)
    poses = region.spread(problem.robot.pose_names)
    firsts = _reaching_starts(problem, poses, seed, starts)
    sizes = problem.sizes(problem.robot_with(firsts[0]), poses)
    solution = exchange.best_of(poses, firsts, sizes)
    rounds: list[Round] = []
    for _ in range(whole("max_rounds", max_rounds, 1)):
        robot = problem.robot_with(_rounded(problem, solution.values))
        after = worst_of(problem, robot, region, about, exchange.budget.left)
        found = exchange.note(robot, after)
        rounds.append(_round(solution, found, len(poses)))
        progress(f"round {len(rounds)}: {rounds[-1]}")
        close = found.objective >= solution.objective - tolerance * max(abs(solution.objective), np.spacing(1.0))
        if close and found.shortfall <= 0.0 and all(worst.complete for worst in after.values()):
            return Synthesis(robot, before, after, rounds, solution.status, after[problem.objective].sampled)
        exchange.require_time(f"after {len(rounds)} rounds, the last one: {rounds[-1]}", solution)
        poses = np.concatenate([poses, *(_offenders(problem, solution, sizes, *item) for item in after.items())])
        solution = exchange.first_of(poses, [solution.values, *firsts], sizes)
    raise SynthesisFailed(f"the exchange did not settle; its last round: {rounds[-1]}", solution.status, exchange.seen)


@dataclass
class _Exchange:
    """What all rounds share, and the best geometry seen."""

    problem: Problem
    region: Region
    about: int
    budget: Budget
    progress: Progress
    seen: Candidate | None = field(default=None, init=False)

    def note(self, robot: Mechanism, worst: dict[str, WorstPoses]) -> Candidate:
        """A geometry that was looked at densely; the best one is kept."""
        short = max((r.at_least - worst[r.margin].value for r in self.problem.requirements), default=-np.inf)
        found = Candidate(robot, worst, worst[self.problem.objective].value, short)
        if np.isfinite(found.objective) and (self.seen is None or found.rank > self.seen.rank):
            self.seen = found
        return found

    def best_of(self, poses: Array, firsts: list[Array], sizes: Mapping[str, float]) -> NlpSolution:
        """The best converged solution of all starts; each may take its share of the time."""
        best: NlpSolution | None = None
        for k, first in enumerate(firsts, start=1):
            share = self.budget.share(len(firsts) - k + 2)
            solution = solve(self.problem, poses, first, sizes, share.left)
            self.progress(f"start {k} of {len(firsts)}: {solution.objective:.5g} ({solution.status})")
            if solution.converged and (best is None or solution.objective > best.objective):
                best = solution
            if self.budget.spent:
                break
        return best if best is not None else self._fail(poses, firsts, solution)

    def first_of(self, poses: Array, firsts: list[Array], sizes: Mapping[str, float]) -> NlpSolution:
        """The first converged solution; the last optimum may not reach poses that were added, then the others start."""
        for k, first in enumerate(firsts):
            solution = solve(self.problem, poses, first, sizes, self.budget.share(len(firsts) - k).left)
            if solution.converged:
                return solution
        return self._fail(poses, firsts, solution)

    def require_time(self, done: str, solution: NlpSolution) -> None:
        """Check the budget.

        Raises:
            SynthesisFailed: it is used up.
        """
        if self.budget.spent:
            raise SynthesisFailed(f"the budget of {self.budget} was used up {done}", solution.status, self.seen)

    def _fail(self, poses: Array, firsts: list[Array], last: NlpSolution) -> NlpSolution:
        """Raise what a solution that did not converge comes to, with its geometry where that is the best seen."""
        robot = self.problem.robot_with(_rounded(self.problem, last.values))
        if not self.budget.spent:
            self.note(robot, worst_of(self.problem, robot, self.region, self.about, self.budget.left))
        self.require_time(f"by the NLP over {len(poses)} poses", last)
        short = "; ".join(f"{name} falls short by {by:.3g} of its size" for name, by in last.violations.items())
        what = f"each of the NLP's {len(firsts)} starts over {len(poses)} poses did not converge"
        raise SynthesisFailed(f"{what}{': ' + short if short else ''}", last.status, self.seen)


def _require_possible_sums(problem: Problem) -> None:
    """Check that each sum can hold.

    Raises:
        SynthesisFailed: its variables' lower bounds alone are too much.
    """
    lowest = problem.robot.geometry.vector()
    lowest[problem.places()] = problem.bounds()[0]
    for limit in problem.sums:
        least = max(float(lowest[places].sum()) for places in problem.summed(limit))
        if least > limit.at_most:
            raise SynthesisFailed(
                f"{limit} cannot hold: with every variable at its lower bound it is {least:g}", "not started"
            )


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
        values = prototype if attempt == 0 else np.array(problem.from_unit(rng.random(len(low))))
        robot = problem.robot_with(values)
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


def _rounded(problem: Problem, values: Array) -> Array:
    """(k,) the variables with so many digits, inside their bounds."""
    low, high = problem.bounds()
    return np.clip([float(f"{value:.{_DIGITS}g}") for value in values], low, high)


def worst_of(
    problem: Problem, robot: Mechanism, region: Region, about: int = DENSE, seconds: float = np.inf
) -> dict[str, WorstPoses]:
    """Worst poses of the objective and of each requirement, by margin, from a grid of about that many poses.

    Args:
        seconds: for all of them; see `WorstPoses.complete`.
    """
    budget, found = Budget(max(seconds, 1e-9)), {}
    for k, margin in enumerate(problem.margins):
        found[margin] = worst_poses(
            robot,
            region,
            margin,
            bounds=problem.fvi_bounds,
            characteristic_length=problem.characteristic_length,
            about=about,
            seconds=budget.share(len(problem.margins) - k).seconds,
        )
    return found


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
    problem: Problem, solution: NlpSolution, sizes: Mapping[str, float], margin: str, worst: WorstPoses
) -> Array:
    """(k, n) poses at which the last answer does worse than it promised."""
    spare = problem.spare * sizes[margin]
    floors = [r.at_least + spare for r in problem.requirements if r.margin == margin]
    if margin == problem.objective:
        floors.append(solution.objective)
    return worst.poses[worst.values < max(floors)]
