"""Proofs that no geometry within given bounds is better than a target.

    certify_design(problem, region, at_most=1.2027).status  ->  "proved", "refuted" or "undecided"

A geometry is worth what its worst pose is worth. So an upper bound at a few poses is one over the region. The box of
geometries is cut until each part fails at one of these poses, or in a weighted sum of what is asked at all of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from design.budget import Budget
from design.certificates import MOST_BOXES, checked_boxes
from design.over_geometries.chosen_poses import Failing
from design.over_geometries.design_certificate import DesignCertificate
from design.over_geometries.design_proof import DesignProof
from design.regions import Region
from design.synthesis import Problem
from kinematics import Bound, InvalidValue, Mechanism, finite

SEED = 0


def certify_design(
    problem: Problem,
    region: Region,
    *,
    at_most: float | None = None,
    at_least: float | None = None,
    best: Mechanism | None = None,
    requirements: Sequence[str] | None = None,
    most_boxes: int = MOST_BOXES,
    seconds: float = math.inf,
    seed: int = SEED,
    progress: Callable[[str], None] = lambda _: None,
) -> DesignCertificate:
    """Prove that no geometry within the bounds of a problem does better than a target.

    All geometries count that bend as the problem's robot does (its mode).

    Args:
        problem: the variables with their bounds, the requirements, the sums and the objective.
        region: the workspace.
        at_most: the target, if a larger objective is better.
        at_least: the target, if a smaller one is better.
        best: the best geometry that is known, as from `synthesise`; by default the problem's robot. Near it the proof
            is hardest, so its worst poses matter.
        requirements: margins whose requirements count; by default all but the clearance, whose bounds are too wide.
        most_boxes, seconds: after so many boxes, or so much time, the answer is "undecided", with the boxes left.
        seed: of the geometries that choose the poses.
        progress: called with a line of text at each step.

    Raises:
        InvalidRegion: the region does not have the robot's coordinates.
        InvalidValue: the wrong one of `at_most` and `at_least`, or no variable can change, or see `certify`.
    """
    target = _target(problem, at_most, at_least)
    region.check(problem.robot.pose_names)
    if not problem.moving().any():
        raise InvalidValue("variables", [v.field for v in problem.variables], "one whose bounds differ, or more")
    budget, most_boxes = Budget(seconds), checked_boxes(most_boxes)
    used, unused = _counted(problem, requirements)
    proof = DesignProof.of(problem, region, target, used, unused)
    failing = Failing(problem, region, target, used)
    return proof.found(failing, best or problem.robot, most_boxes, budget, seed, progress)


def _target(problem: Problem, at_most: float | None, at_least: float | None) -> Bound:
    margin = problem.robot.margin_named(problem.objective)
    right, wrong = (at_most, at_least) if margin.sense > 0 else (at_least, at_most)
    word = "at_most" if margin.sense > 0 else "at_least"
    if right is None or wrong is not None:
        why = f"as {margin.name} is better {'larger' if margin.sense > 0 else 'smaller'}"
        raise InvalidValue("target of certify_design", "the other word or none", f"{word}, {why}")
    value = finite(f"{word} of {margin.name}", right, "a finite number, in the margin's unit")
    return Bound(value, margin.sense)


def _counted(problem: Problem, requirements: Sequence[str] | None) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The margins of the requirements that count, and of those that do not."""
    asked = tuple(dict.fromkeys(r.margin for r in problem.requirements))
    wanted = [m for m in asked if not problem.robot.margins[m].shown_on_paths] if requirements is None else requirements
    for name in wanted:
        if name not in asked:
            raise InvalidValue("requirements", name, f"some of {', '.join(asked)}")
    used = tuple(name for name in asked if name in wanted)
    return used, tuple(name for name in asked if name not in used)
