"""The search for a proof over geometries: which poses it uses, and when a target is refuted."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import asdict, dataclass
from importlib.metadata import version

import numpy as np

from design.budget import Budget
from design.certificates import answer
from design.claims import Statement
from design.over_geometries.chosen_poses import Failing, covering, trial_geometries
from design.over_geometries.design_box import DesignBox
from design.over_geometries.design_certificate import DesignCertificate
from design.over_geometries.geometry_search import GeometrySearch
from design.over_geometries.necessary_rows import NecessaryRows, necessary_rows
from design.over_geometries.upper_bounds import UpperBounds
from design.regions import Region
from design.synthesis import Problem
from kinematics import Array, Bound, InvalidGeometry, Mechanism

_ROUNDS = 8  # searches, each with the poses that the last one lacked
_FIRST = 1 << 15  # boxes of the first search; each next one may take twice as many
_SAME = 1e-9  # rad or m between poses that are one
_MOST_OF_ONE = 1_000_000  # boxes of poses, to prove that one robot reaches the target
_LOOKED_AT = 4  # boxes where a search is stuck, whose geometries get a dense search


def digest_of(problem: Problem) -> str:
    """SHA-256 of what is asked, and of the robot with the records that its margins depend on."""
    robot, margins = problem.robot, (problem.objective, *(r.margin for r in problem.requirements))
    records = sorted({record for margin in margins for record in robot.margins[margin].records})
    asked = {
        "mechanism": type(robot).__name__,
        "geometry": robot.geometry.digest,
        "conditions": robot.conditions_digest(records),
        "objective": problem.objective,
        "variables": [asdict(variable) for variable in problem.variables],
        "requirements": [asdict(requirement) for requirement in problem.requirements],
        "sums": [asdict(limit) for limit in problem.sums],
        "fvi": asdict(problem.fvi_bounds),
        "length": problem.characteristic_length,
    }
    return hashlib.sha256(json.dumps(asked, sort_keys=True).encode()).hexdigest()


@dataclass(frozen=True)
class DesignProof:
    """What one question's searches share."""

    problem: Problem
    region: Region
    target: Bound
    used: tuple[str, ...]
    unused: tuple[str, ...]
    necessary: NecessaryRows
    box: DesignBox

    @classmethod
    def of(
        cls, problem: Problem, region: Region, target: Bound, used: tuple[str, ...], unused: tuple[str, ...]
    ) -> DesignProof:
        """With the rows of the requirements that are used."""
        necessary = necessary_rows(problem, target.value, used)
        return cls(problem, region, target, used, unused, necessary, DesignBox.of(problem, necessary))

    def found(
        self,
        failing: Failing,
        best: Mechanism,
        most_boxes: int,
        budget: Budget,
        seed: int,
        progress: Callable[[str], None],
    ) -> DesignCertificate:
        """Search with few poses; where a search does not end, dense searches tell which poses it lacks."""
        progress("choosing poses")
        names = self.problem.robot.pose_names
        search, fails = GeometrySearch(self.box), failing.somewhere(best, budget)
        if not len(fails) and self._reaches(best, budget):
            return self._certificate(search, np.empty((0, len(names))), [], best)
        candidates = np.concatenate([self.region.spread(names), fails])
        poses = candidates[covering(failing.at(candidates, trial_geometries(self.problem, best, seed)))]
        bounds, counts = self.bounds_at(poses), list[int]()
        for turn in range(_ROUNDS):
            allowed = most_boxes if turn == _ROUNDS - 1 else min(most_boxes, search.boxes + (_FIRST << turn))
            counts.append(len(poses))
            search.run(bounds, allowed, budget, progress)
            if not len(search.left) or search.boxes >= most_boxes or budget.spent:
                break
            more, better = self._lacking(failing, search.left, poses, budget)
            if better is not None:
                return self._certificate(search, poses, counts, better)
            poses = np.concatenate([poses, more])
            bounds += [UpperBounds(self.problem, self.necessary, self.box, pose) for pose in more]
        return self._certificate(search, poses, counts, None)

    def bounds_at(self, poses: Array) -> list[UpperBounds]:
        """The sums' bounds, if there are sums, and those at the poses (p, n)."""
        sums = [None] if self.necessary.sums.numel() else []
        return [UpperBounds(self.problem, self.necessary, self.box, pose) for pose in (*sums, *poses)]

    def _lacking(self, failing: Failing, left: Array, poses: Array, budget: Budget) -> tuple[Array, Mechanism | None]:
        """Poses (k, n) where the geometries of the smallest boxes fail; or one of these robots, if it fails nowhere.

        The poses (p, n) that are known are left out.
        """
        size = ((left[:, 1] - left[:, 0]) / (self.box.high - self.box.low)).max(axis=1)
        known = poses
        for low, high in left[np.argsort(size, kind="stable")[:_LOOKED_AT]]:
            try:
                robot = self.box.robot(0.5 * (low + high))
            except InvalidGeometry:
                continue
            where = failing.somewhere(robot, budget)[:1]
            if not len(where) and self._reaches(robot, budget):
                return known[len(poses) :], robot
            if len(where) and not (np.abs(known - where).max(axis=1, initial=0.0) <= _SAME).any():
                known = np.concatenate([known, where])
        return known[len(poses) :], None

    def _reaches(self, robot: Mechanism, budget: Budget) -> bool:
        """Whether a robot is within the bounds, and proved to reach the target and to keep every requirement."""
        asked = [(self.problem.objective, self.target), *((r.margin, r.bound) for r in self.problem.requirements)]
        measured = self.problem.fvi_bounds, self.problem.characteristic_length
        statements = (Statement.of(robot, margin, bound, *measured) for margin, bound in asked)
        return self.problem.allows(robot) and all(
            answer(statement, self.region, _MOST_OF_ONE, budget.share(2), lambda _: None).status == "proved"
            for statement in statements
        )

    def _certificate(
        self, search: GeometrySearch, poses: Array, counts: list[int], better: Mechanism | None
    ) -> DesignCertificate:
        left = search.left
        proved = not len(left) and better is None
        return DesignCertificate(
            mechanism=type(self.problem.robot).__name__,
            objective=self.problem.objective,
            digest=digest_of(self.problem),
            target=self.target,
            status="refuted" if better else "proved" if proved else "undecided",
            better=better.geometry.vector() if better else None,
            region=self.region,
            poses=poses,
            counts=tuple(dict.fromkeys(counts)),
            used=self.used,
            unused=self.unused,
            together=self.box.together,
            boxes=search.boxes,
            codes=search.codes if proved else np.empty(0, dtype=np.int8),
            left=left,
            variables=self.box.names,
            version=version("linkwright"),
        )
