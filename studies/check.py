"""Re-verification of a committed `optimum.toml`: every figure computed again and held against the claim."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from design.nlp import Problem
from kinematics import Mechanism
from studies import pipeline, setup
from studies.load import load_study
from studies.optimum import FILE, Optimum, optimum_of, read_optimum
from studies.schema import Study

ROUNDING = 1e-12  # m, of a sum
AGREE = 1e-6  # relative: what another machine's rounding may change in a figure


@dataclass(frozen=True)
class Row:
    """One claim: what it is, what the file says or the study wants, what was found, and by how much it holds.

    `margin` is negative where the claim fails.
    """

    what: str
    expected: str
    found: str
    margin: float
    where: str = ""

    @property
    def holds(self) -> bool:
        """Whether the claim stands; NaN never does."""
        return bool(self.margin >= 0.0)


def check_study(study_file: Path) -> list[Row]:
    """Everything that the optimum beside a study file claims.

    Raises:
        StudyError, InvalidOptimum, InvalidGeometry: a file cannot be used at all.
    """
    study = load_study(study_file)
    optimum_file = study_file.parent / FILE
    claimed = read_optimum(optimum_file)
    robot = claimed.robot(optimum_file)
    rows = [
        _same("mechanism", study.mechanism, claimed.mechanism),
        _same("study", study.digest[:12], str(claimed.made_by["study_digest"])[:12]),
    ]
    if not all(row.holds for row in rows):
        return rows
    problem = setup.problem_of(study)
    rows += _within_bounds(problem, robot)
    found = optimum_of(pipeline.run(study, robot, lambda _: None, compare_cycles=False))
    return rows + _figures(study, problem, claimed, found) + _cycle(claimed, found)


def _same(what: str, expected: str, found: str) -> Row:
    return Row(what, expected, found, 0.0 if expected == found else -1.0)


def _within_bounds(problem: Problem, robot: Mechanism) -> list[Row]:
    """Variables inside their bounds, sums kept, everything else as in the study."""
    rows = []
    vector, own = robot.geometry.vector(), problem.robot.geometry.vector()
    places = problem.places()
    for place, bound in zip(places, problem.variables, strict=True):
        margin = min(vector[place] - bound.low, bound.high - vector[place])
        rows.append(Row(f"geometry.{bound.field}", f"{bound.low:g} to {bound.high:g}", f"{vector[place]:g}", margin))
    fixed = [k for k in range(len(own)) if k not in places]
    off = max((abs(vector[k] - own[k]) for k in fixed if vector[k] != own[k]), default=0.0)
    rows.append(Row("geometry, other fields", "the study's", f"off by {off:g}", -off))
    for limit in problem.sums:
        total = sum(float(getattr(robot.geometry, field)) for field in limit.fields)
        rows.append(
            Row(" + ".join(limit.fields), f"<= {limit.at_most:g}", f"{total:g}", limit.at_most - total + ROUNDING)
        )
    return rows


def _figures(study: Study, problem: Problem, claimed: Optimum, found: Optimum) -> list[Row]:
    """Worst values as claimed, requirements met, and the prototype beaten where there was something to optimise."""
    rows = [
        _agrees(f"worst {name}", claimed.figures.get(name), value, found.poses.get(name))
        for name, value in found.figures.items()
    ]
    for requirement in problem.requirements:
        value = found.figures[requirement.margin]
        bound = requirement.at_least
        rows.append(_at_least(f"required {requirement.margin}", bound, value, found.poses[requirement.margin]))
    if study.optimise is not None and "prototype" in found.figures:
        objective = problem.objective
        rows.append(
            _at_least(
                f"{objective} beats the prototype",
                found.figures["prototype"],
                found.figures[objective],
                found.poses[objective],
            )
        )
    return rows


def _cycle(claimed: Optimum, found: Optimum) -> list[Row]:
    if not found.cycle:
        return []
    rows = [_agrees("half cycle [s]", claimed.cycle.get("half_cycle"), found.cycle["half_cycle"], None)]
    rows += [
        Row(f"{name} peak over limit", "<= 1", f"{value:.6f}", 1.0 - value)
        for name, value in found.cycle["peak_over_limit"].items()
    ]
    return rows


def _agrees(what: str, claimed: object, found: float, pose: list[float] | None) -> Row:
    if not isinstance(claimed, float | int):
        return Row(what, "a claim", "none in the file", -1.0)
    off = abs(found - claimed)
    return Row(what, f"{claimed:.9g}", f"{found:.9g}", AGREE * abs(claimed) - off, _pose(pose))


def _at_least(what: str, bound: float, found: float, pose: list[float]) -> Row:
    return Row(what, f">= {bound:g}", f"{found:.9g}", found - bound, _pose(pose))


def _pose(pose: list[float] | None) -> str:
    return "" if pose is None else f"({', '.join(f'{round(v, 6) + 0.0:.4g}' for v in pose)})"
