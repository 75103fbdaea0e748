"""Verify a committed `optimum.toml`: compute every entry again and compare it with the file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from design import Problem, Region
from kinematics import Bound, Mechanism
from studies.building import load_study
from studies.committed.committed_proofs import proof_rows
from studies.committed.optimum import FILE, Optimum, optimum_of, read_optimum, told
from studies.stages import GIVEN, ROUNDING, Outcome, Row, agrees, keeps, run, same, same_digest
from studies.study_file import Study, TomlFile, changes, cycle_question, design_question, digest_of, told_at_key

_OWN_ROWS = ("asked", "worst_pose", "geometry", "certificate", "made_by.design_digest", "made_by.cycle_digest")
_SOLVED = "Solve_Succeeded"


def check_study(file: TomlFile, allow_code: bool = False) -> list[Row]:
    """Check every claim of the optimum beside a study file; `allow_code` as for `load_study`.

    Raises:
        StudyError: the study or the optimum cannot be used at all.
    """
    study, folder = load_study(file, allow_code), file.path.parent
    claimed = read_optimum(folder / FILE)
    if not claimed.answers_design(study):
        return _question(claimed, study, "design")  # an answer to another question
    cycle_stands = claimed.asked("cycle") == cycle_question(study)
    asked = study if cycle_stands else study.model_copy(update={"trajectory": None})
    with told_at_key(file):
        outcome = run(asked, claimed.robot(study), lambda _: None, compare_cycles=False)
    outcome = replace(outcome, study=study)
    return compare(claimed, outcome) + proofs(claimed, outcome, folder)


def proofs(claimed: Optimum, outcome: Outcome, folder: Path) -> list[Row]:
    """Check every entry that says "proved": replay its certificate in the folder.

    Raises:
        UnreadableCertificate: a file is missing or cannot be read.
    """
    worst = {margin: found.value for margin, found in outcome.worst.items()}
    return proof_rows(outcome.question, claimed.certificates, worst, folder)


def compare(claimed: Optimum, outcome: Outcome) -> list[Row]:
    """Check every claim of a file except its proofs against the figures computed now."""
    study, problem, robot = outcome.study, outcome.problem, outcome.robot
    return [
        *_question(claimed, study, "design"),
        *_question(claimed, study, "cycle"),
        *_within_bounds(problem, robot),
        *_requirements(study, outcome),
        *_at_claimed_poses(claimed, problem, robot, outcome.region),
        *_entries(claimed, optimum_of(outcome), study),
    ]


def _question(claimed: Optimum, study: Study, which: str) -> list[Row]:
    """Rows for each key of the question that changed since the file was made, then for the question's digest."""
    now = {"design": design_question, "cycle": cycle_question}[which](study)
    changed = changes(claimed.asked(which), now)
    rows = [Row(f"{which} question: {key}", told(was), told(is_now), -1.0) for key, (was, is_now) in changed.items()]
    digest = claimed.data["made_by"].get(f"{which}_digest")
    return [*rows, same_digest(f"answers the study's {which} question", digest, digest_of(now))]


def _within_bounds(problem: Problem, robot: Mechanism) -> list[Row]:
    """Check that variables are inside their bounds, sums are kept, and other fields are the study's."""
    rows = []
    vector, own = robot.geometry.vector(), problem.robot.geometry.vector()
    places = problem.places()
    for place, bound in zip(places, problem.variables, strict=True):
        margin = min(vector[place] - bound.low, bound.high - vector[place])
        rows.append(Row(f"geometry.{bound.field}", f"{bound.low:g} to {bound.high:g}", f"{vector[place]:g}", margin))
    fixed = [k for k in range(len(own)) if k not in places]
    off = max((abs(vector[k] - own[k]) for k in fixed if vector[k] != own[k]), default=0.0)
    rows.append(Row("geometry, other fields", "the study's", f"off by {off:g}", 0.0 - off))
    for limit in problem.sums:
        total = max(vector[entry].sum() for entry in problem.summed(limit))
        rows.append(Row(str(limit), f"<= {limit.at_most:g}", f"{total:g}", limit.at_most - total + ROUNDING))
    return rows


def _requirements(study: Study, outcome: Outcome) -> list[Row]:
    """Check the requirements over the region and on the cycle, the limits, and the gain over the study's geometry.

    A study's geometry that breaks a requirement may be better in the objective, so there is no gain to check then.
    """
    rows = []
    for r in outcome.problem.requirements:
        worst = outcome.worst[r.margin]
        rows.append(keeps(f"required {r.margin}", r.bound, worst.value, worst.pose.tolist(), outcome.part(r.margin)))
        if (there := outcome.on_cycle.get(r.margin)) is not None:
            rows.append(keeps(f"required {r.margin} on the cycle", r.bound, there.value, there.pose, there.part))
    own = outcome.prototype
    keeps_all = own is not None and all(r.bound.room(own[r.margin].value) >= 0.0 for r in outcome.problem.requirements)
    if study.optimise is not None and own is not None and keeps_all:
        name = outcome.problem.objective
        worst = outcome.worst[name]
        rows.append(
            keeps(
                f"{name} is no worse than the study's own geometry",
                Bound(own[name].value, outcome.robot.margins[name].sense),
                worst.value,
                worst.pose,
            )
        )
    for name, value in outcome.cycle_figures().get("peak_over_limit", {}).items():
        rows.append(Row(f"{name}, peak over limit", "<= 1", f"{value:.6f}", 1.0 - value))
    return rows


def _at_claimed_poses(claimed: Optimum, problem: Problem, robot: Mechanism, region: Region) -> list[Row]:
    """Check that each claimed pose is in the region and has the claimed figure. Any of several equal poses will do."""
    rows = []
    for name, given in claimed.data["worst_pose"].items():
        pose = np.array(given, dtype=float) if _numbers(given, len(robot.pose_names)) else None
        if pose is None or name not in robot.margins or not region.contains(pose, robot.pose_names, ROUNDING):
            rows.append(Row(f"worst_pose.{name}", "a pose in the region", str(given), -1.0))
            continue
        value = robot.margin(name, pose, problem.fvi_bounds, problem.characteristic_length)
        rows.append(agrees(f"{name} at worst_pose", claimed.data["figures"].get(name), float(value)))
    return rows


def _entries(claimed: Optimum, found: Optimum, study: Study) -> list[Row]:
    """Compare every other entry of the file with the same entry computed now. Report missing and unknown ones."""
    ours, theirs = dict(_leaves(found.data)), dict(_leaves(claimed.data))
    ours["made_by.solver_status"] = _SOLVED if study.optimise else GIVEN  # `check` does not optimise again
    cycle_stands = claimed.asked("cycle") == cycle_question(study)
    rows = []
    for key in dict.fromkeys([*ours, *theirs]):
        table = key.split(".")[0]
        if table in _OWN_ROWS or key in _OWN_ROWS or (table == "cycle" and not cycle_stands):
            continue
        if key not in ours or key not in theirs:
            have, lack = ("the file", "the run") if key in theirs else ("the run", "the file")
            rows.append(Row(key, f"only in {have}", f"not in {lack}", -1.0))
        elif isinstance(ours[key], float):
            rows.append(agrees(key, theirs[key], ours[key]))
        elif key == "made_by.geometry_hash":
            rows.append(same_digest(key, theirs[key], ours[key]))
        else:
            rows.append(same(key, theirs[key], ours[key]))
    missing = set(found.data["worst_pose"]) - set(claimed.data["worst_pose"])
    return rows + [Row(f"worst_pose.{name}", "a pose", "none in the file", -1.0) for name in sorted(missing)]


def _leaves(node: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(node, dict):
        for key, value in node.items():
            yield from _leaves(value, f"{path}.{key}" if path else str(key))
    else:
        yield path, node


def _numbers(value: object, count: int) -> bool:
    return isinstance(value, list) and len(value) == count and all(type(v) in (int, float) for v in value)
