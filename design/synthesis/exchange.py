"""The rounds of a synthesis: a nonlinear program (NLP) over few poses, a dense search for worse poses, and the best
geometry seen.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from design.budget import Budget
from design.regions import Region
from design.sampling import DENSE, WorstPoses, worst_poses
from design.synthesis.errors import SynthesisFailed
from design.synthesis.nlp import NlpSolution, Problem, solve
from kinematics import Array, InvalidGeometry, Mechanism

Progress = Callable[[str], None]
_OF_THE_WAY = 0.9  # share of the linear estimate that is used, as the margins are not linear
_DIGITS = 8  # digits of a variable, so that a file holds exactly the number that was checked


@dataclass(frozen=True)
class Round:
    """One round: the objective that the NLP promised on its poses, and the one that the dense search found."""

    poses: int
    promised: float
    found: float
    shortfall: float  # by how much the worst requirement breaks its bound; <= 0 if all hold
    iterations: int
    seconds: float

    def __str__(self) -> str:
        return (
            f"{self.poses} poses, promised {self.promised:.6g}, dense search found {self.found:.6g}, "
            f"requirements short by {max(self.shortfall, 0.0):.1e}"
        )


@dataclass(frozen=True)
class Candidate:
    """A geometry with a dense search. It is not known to be the best.

    Attributes:
        robot: the mechanism with this geometry.
        worst: worst poses by margin, as far as the dense search went.
        objective: the worst value of the objective.
        good: the same, negative if a smaller one is better.
        shortfall: by how much the worst requirement breaks its bound; <= 0 if all hold.
        problem: what was asked.
    """

    robot: Mechanism
    worst: dict[str, WorstPoses]
    objective: float
    good: float
    shortfall: float
    problem: Problem

    @property
    def rank(self) -> tuple[float, float]:
        """A larger rank is better: first whether requirements hold, then the objective."""
        return -max(self.shortfall, 0.0), self.good

    def __str__(self) -> str:
        kept = "it keeps every requirement, but the solver did not confirm it as an optimum"
        lines = self._missed() or [kept]
        own = self.robot.geometry.as_dict()
        fields = dict.fromkeys(v.field for v in self.problem.variables)
        lines += [f"{name} = {own[name]}" for name in fields]
        return "\n  ".join([f"{self.problem.objective} {self.objective:.6g}", *lines])

    def _missed(self) -> list[str]:
        """Each requirement that this geometry misses, with the pose where it is worst."""
        lines = []
        for r in self.problem.requirements:
            worst, unit = self.worst[r.margin], self.robot.margins[r.margin].unit
            if not r.bound.room(worst.value) >= 0.0:
                pose = ", ".join(f"{round(v, 6) + 0.0:.4g}" for v in worst.pose.tolist())
                wanted = f"{r.bound.word.replace('_', ' ')} {r.bound.value:g}"
                shown = f"{worst.value:.6g} {unit}".strip()
                lines.append(f"it misses {r.margin}: found {shown} at pose ({pose}); expected {wanted} {unit}".strip())
        return lines


@dataclass
class Exchange:
    """The data that all rounds share, and the best geometry seen.

    Attributes:
        seen: the best geometry with a dense search; at first the prototype, if the bounds and sums allow it.
        last: the latest geometry that broke a requirement.
        looked: the longest dense search [s]. The solver leaves time for two of them, so that there is a best geometry
            to report if it is stopped.
    """

    problem: Problem
    region: Region
    about: int
    budget: Budget
    progress: Progress
    seen: Candidate | None = field(default=None, init=False)
    last: Candidate | None = field(default=None, init=False)
    looked: float = field(default=0.0, init=False)

    def look(self, robot: Mechanism) -> dict[str, WorstPoses]:
        """The robot's worst poses by margin, as far as the time allows."""
        started = time.perf_counter()
        worst = worst_of(self.problem, robot, self.region, self.about, self.budget.left)
        self.looked = max(self.looked, time.perf_counter() - started)
        return worst

    def note(self, robot: Mechanism, worst: dict[str, WorstPoses]) -> Candidate:
        """The candidate of a geometry with a dense search. The best one is kept."""
        short = max((-r.bound.room(worst[r.margin].value) for r in self.problem.requirements), default=-np.inf)
        objective = worst[self.problem.objective].value
        found = Candidate(robot, worst, objective, self.problem.good(objective), short, self.problem)
        if np.isfinite(found.objective) and (self.seen is None or found.rank > self.seen.rank):
            self.seen = found
        self.last = found if found.shortfall > 0.0 else self.last
        return found

    def better_than(self, found: Candidate, slack: float) -> Candidate | None:
        """The best geometry seen, if it is better than `found`; the NLP should also start from there. Else None."""
        best = self.seen
        beats = best is not None and best.shortfall <= 0.0 and best.good > found.good + slack
        return best if beats else None

    def robot_of(self, solution: NlpSolution) -> Mechanism:
        """The robot of a solution, its variables rounded.

        Raises:
            SynthesisFailed: the mechanism refuses this geometry.
        """
        try:
            return self.problem.robot_with(rounded(self.problem, solution.values))
        except InvalidGeometry as error:
            what = f"the NLP returned an impossible geometry within the variables' bounds: {error}"
            raise SynthesisFailed(what, solution.status, self.seen) from error

    def best_of(self, poses: Array, firsts: list[Array], sizes: Mapping[str, float]) -> NlpSolution:
        """The best converged solution of all starts. Each start may take half of the time that is left.

        After one start has converged, the starts together leave half of all the time for the later rounds.
        """
        best: NlpSolution | None = None
        half, tried, good = self.budget.share(2), [], self.problem.good
        for k, first in enumerate(firsts, start=1):
            share = half.share(len(firsts) - k + 1) if best else self.budget.share(2)
            solution = solve(self.problem, poses, first, sizes, share.left)
            self.progress(f"start {k} of {len(firsts)}: {solution.objective:.5g} ({solution.status})")
            tried.append(solution)
            if solution.converged and (best is None or good(solution.objective) > good(best.objective)):
                best = solution
            if self.budget.spent or (best and half.spent):
                break
        return best if best is not None else self._fail(poses, tried)

    def first_of(self, poses: Array, firsts: list[Array], sizes: Mapping[str, float]) -> NlpSolution:
        """The first converged solution.

        If the last optimum cannot reach the added poses, the other starts are tried.
        """
        tried = []
        for k, first in enumerate(firsts):
            seconds = max(self.budget.left - 2 * self.looked, 0.0) / (len(firsts) - k)
            solution = solve(self.problem, poses, first, sizes, seconds)
            if solution.converged:
                return solution
            tried.append(solution)
        return self._fail(poses, tried)

    def require_time(self, done: str, solution: NlpSolution) -> None:
        """Check the budget.

        Raises:
            SynthesisFailed: the time is used up.
        """
        if self.budget.left <= 2 * self.looked:
            raise self.failed(f"the time of {self.budget} ended {done}", solution)

    def failed(self, reason: str, solution: NlpSolution) -> SynthesisFailed:
        """The error to raise, with the best geometry seen. One between it and the last geometry is tried, too."""
        drawn = self._drawn_back()
        if drawn is not None:
            self.note(drawn, self.look(drawn))
        return SynthesisFailed(reason, solution.status, self.seen)

    def _drawn_back(self) -> Mechanism | None:
        """A geometry between the best one seen, which holds, and a better one that does not, where all should hold.

        The worst values of the margins are assumed to change linearly between the two.
        """
        best, beyond = self.seen, self.last
        if best is None or beyond is None or best.shortfall > 0.0 or beyond.good <= best.good:
            return None
        share = 1.0
        for requirement in self.problem.requirements:
            room = requirement.bound.room(best.worst[requirement.margin].value)
            short = -requirement.bound.room(beyond.worst[requirement.margin].value)
            share = min(share, room / (room + short)) if short > 0.0 else share
        places = self.problem.places()
        start, end = (found.robot.geometry.vector()[places] for found in (best, beyond))
        try:
            robot = self.problem.robot_with(rounded(self.problem, start + _OF_THE_WAY * share * (end - start)))
        except InvalidGeometry:
            return None
        return robot if self.problem.allows(robot) else None

    def _fail(self, poses: Array, tried: list[NlpSolution]) -> NlpSolution:
        """Raise the error of solutions that did not converge, after a dense search of the one that breaks the least."""
        nearest = max(tried, key=lambda one: (-sum(one.violations.values()), self.problem.good(one.objective)))
        robot = self.robot_of(nearest)
        if not self.budget.spent:
            self.note(robot, self.look(robot))
        self.require_time(f"by the NLP over {len(poses)} poses", nearest)
        short = "; ".join(f"{name} falls short by {by:.3g} of its size" for name, by in nearest.violations.items())
        what = f"each of the NLP's {len(tried)} starts over {len(poses)} poses did not converge"
        raise self.failed(f"{what}{': ' + short if short else ''}", nearest)


def rounded(problem: Problem, values: Array) -> Array:
    """(k,) the variables with `_DIGITS` digits, inside their bounds."""
    low, high = problem.bounds()
    return np.clip([float(f"{value:.{_DIGITS}g}") for value in values], low, high)


def worst_of(
    problem: Problem, robot: Mechanism, region: Region, about: int = DENSE, seconds: float = np.inf
) -> dict[str, WorstPoses]:
    """Worst poses of the objective and of each requirement, by margin, from a grid of about that many poses.

    Args:
        seconds: time for all of them [s]; see `WorstPoses.complete`.
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
