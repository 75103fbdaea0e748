"""The poses at which geometries are to be excluded: few, and such that each of many trial geometries fails at one.

The trials are random: over all bounds, and nearer and nearer to the best geometry that is known. A geometry fails at a
pose where a requirement fails, a limb cannot reach, or the objective misses the target.
"""

from __future__ import annotations

import casadi as ca
import numpy as np

from design.budget import Budget
from design.regions import Region
from design.sampling import worst_poses
from design.synthesis import Problem
from kinematics import Array, Bound, Measure, Mechanism, bulk, evaluate

_TRIALS = 256  # over the bounds, and as many at each nearness to the best geometry
_NEARNESS = (0.1, 0.03, 0.01, 1e-3, 1e-4)  # in parts of the bounds
_ABOUT = 100_000  # poses of a dense search
_WORST = 16  # of them that become candidates, for each margin


class Failing:
    """Where geometries fail what is asked of them, in plain numbers."""

    def __init__(self, problem: Problem, region: Region, target: Bound, requirements: tuple[str, ...]) -> None:
        """Build the program of all rooms: how much each margin is better than its bound."""
        self.problem, self.region = problem, region
        robot, model = problem.robot, problem.robot.model()
        self._asked = [(problem.objective, target)]
        self._asked += [(r.margin, r.bound) for r in problem.requirements if r.margin in requirements]
        measure = Measure(problem.fvi_bounds, problem.characteristic_length)
        rooms = [
            bound.sense * (robot.margins[margin].worst(robot, measure) - bound.value) for margin, bound in self._asked
        ]
        rooms.append(ca.mmin(robot.reach(model.pose, model.g)))
        self._rooms = bulk(ca.Function("rooms", [model.pose, model.geometry], [ca.cse(ca.vertcat(*rooms))]))

    def at(self, poses: Array, geometries: Array) -> Array:
        """(p, n) and (t, g) -> (t, p) whether each geometry fails at each pose."""
        t, p = len(geometries), len(poses)
        (rooms,) = evaluate(self._rooms, np.tile(poses, (t, 1)), np.repeat(geometries, p, axis=0))
        result: Array = ~(rooms >= 0.0).all(axis=-1).reshape(t, p)  # NaN fails
        return result

    def somewhere(self, robot: Mechanism, budget: Budget) -> Array:
        """(k, n) poses where a dense search finds that a robot fails, the worst of each margin first; empty if none."""
        found = []
        for margin, bound in self._asked:
            worst = worst_poses(
                robot,
                self.region,
                margin,
                bounds=self.problem.fvi_bounds,
                characteristic_length=self.problem.characteristic_length,
                about=_ABOUT,
                seconds=budget.share(2).seconds,
            )
            found.append(worst.poses[bound.room(worst.values) < 0.0][:_WORST])
        return np.concatenate(found)


def trial_geometries(problem: Problem, best: Mechanism, seed: int) -> Array:
    """(t, g) vectors of geometries within the bounds and sums, far from and near to the best one."""
    rng, vector, places = np.random.default_rng(seed), best.geometry.vector(), problem.places()
    low, high = problem.bounds()
    values = [low + (high - low) * rng.random((_TRIALS, len(low)))]
    for near in _NEARNESS:
        moved = vector[places] + near * (high - low) * rng.normal(size=(_TRIALS, len(low)))
        values.append(np.clip(moved, low, high))
    found = np.repeat(vector[None], sum(map(len, values)), axis=0)
    found[:, places] = np.concatenate(values)
    allowed = np.ones(len(found), dtype=bool)
    for limit in problem.sums:
        for summed in problem.summed(limit):
            allowed &= found[:, summed].sum(axis=1) <= limit.at_most
    return found[allowed]


def covering(fails: Array) -> list[int]:
    """Columns of (t, p) that hold a true one for every row that has one: greedily, the most useful first."""
    open_, chosen = fails.any(axis=1), list[int]()
    while open_.any():
        chosen.append(int(fails[open_].sum(axis=0).argmax()))
        open_ &= ~fails[:, chosen[-1]]
    return chosen
