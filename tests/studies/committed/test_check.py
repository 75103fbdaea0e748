"""`linkwright check`: what a run committed stands, and nothing in it can be changed unnoticed."""

from __future__ import annotations

import copy
import functools
import itertools
import json
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from kinematics import Bound
from studies.building.load import load_study
from studies.committed.check import check_study, compare, proofs
from studies.committed.committed_proofs import proof_entries, proof_files
from studies.committed.optimum import read_optimum
from studies.errors import StudyError
from studies.stages.pipeline import run
from studies.stages.proofs import Claim, question_of
from studies.study_file.locate import study_names
from studies.study_file.toml_file import read_toml
from tests.sizes import few_or_many, later
from tests.studies.command_line import SMALL, SmallRun, copy_of, linkwright
from trajectory import write_files


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


@pytest.mark.parametrize("names", [("heli4",), later(())])
def test_check_accepts_every_committed_optimum(names: tuple[str, ...]) -> None:
    """Without a name it checks all."""
    ended = linkwright("check", *names, "--json")
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert set(json.loads(ended.stdout)["studies"]) == set(names or study_names())


def test_check_accepts_what_a_run_committed(small_run: SmallRun) -> None:
    ended = linkwright("check", small_run[0])
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert re.fullmatch(r".*: all \d\d claims hold\n", ended.stdout)
    assert len(linkwright("check", small_run[0], "--verbose").stdout.splitlines()) > 10


def leaves(node: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    if isinstance(node, dict):
        for key, value in node.items():
            yield from leaves(value, (*path, key))
    else:
        yield path


def tampered(value: Any) -> Any:
    """Another value of the same kind, not far away; a pose inside the region, where the margin is not the worst."""
    if isinstance(value, bool | str):
        return f"{value}x"
    if isinstance(value, list):
        return [v * 0.97 if isinstance(v, float) else tampered(v) for v in value] if value else ["something"]
    return value + 1 if isinstance(value, int) else value * 1.001 + 1e-4


@few_or_many(1, 100)
def test_no_entry_of_an_optimum_can_be_changed_or_removed_unnoticed(
    small_run: SmallRun, tmp_path: Path, count: int
) -> None:
    """Each geometry that differs is computed anew, so only the first `count` are."""
    file = copy_of(small_run[0], tmp_path)
    original = tomllib.loads(file.read_text())
    study = load_study(read_toml(tmp_path / "study.toml"))
    outcome = run(study, read_optimum(file).robot(study), lambda _: None, compare_cycles=False)
    assert all(
        row.holds for row in compare(read_optimum(file), outcome) + proofs(read_optimum(file), outcome, tmp_path)
    )
    for path, change in itertools.product(leaves(original), (tampered, None)):
        data = copy.deepcopy(original)
        table = functools.reduce(dict.__getitem__, path[:-1], data)
        if change is None:
            del table[path[-1]]
        else:
            table[path[-1]] = change(table[path[-1]])
        file.write_text(tomli_w.dumps(data))
        try:
            claimed = read_optimum(file)
            same = claimed.robot(study).geometry == outcome.robot.geometry
        except StudyError:
            continue  # unusable, and said so
        if not same and (count := count - 1) < 0:
            continue
        if not same:
            rows = check_study(read_toml(tmp_path / "study.toml"))
        elif path[0] == "certificate":
            rows = proofs(claimed, outcome, tmp_path)
        else:
            rows = compare(claimed, outcome)
        assert not all(row.holds for row in rows), (path, change)


def test_an_invented_figure_is_noticed(small_run: SmallRun, tmp_path: Path) -> None:
    file = copy_of(small_run[0], tmp_path)
    file.write_text(file.read_text().replace("[figures]\n", "[figures]\nJ_q = 0.99\n"))
    failed = [row.what for row in check_study(read_toml(tmp_path / "study.toml")) if not row.holds]
    assert failed == ["figures.J_q"]


def test_a_best_bound_that_says_next_to_nothing_is_noticed(small_run: SmallRun, tmp_path: Path) -> None:
    """Sound in itself, entered in the optimum and replayed: only its worth is gone."""
    file = copy_of(small_run[0], tmp_path)
    study, optimum = load_study(read_toml(tmp_path / "study.toml")), read_optimum(file)
    weak = question_of(study, optimum.robot(study)).prove(
        Claim("J_q", Bound(0.01), best=False), None, None, lambda _: None
    )
    assert weak.certificate.status == "proved"
    write_files(tmp_path, proof_files([weak]))
    optimum.certificates["J_q"].update(proof_entries([weak], 0)["J_q"])
    file.write_text(optimum.text())
    ended = linkwright("check", tmp_path)
    assert ended.returncode == 1
    assert "1 of " in ended.stdout
    assert re.search(r"FAIL +J_q, best bound +a bound above 0.5 of the worst found, \S+ +>= 0.01 +-", ended.stdout)


def test_a_failed_check_is_a_table_with_the_margin(small_run: SmallRun, tmp_path: Path) -> None:
    file = copy_of(small_run[0], tmp_path)
    file.write_text(re.sub(r"pitch = [\d.]+", "pitch = 0.07", file.read_text(), count=1))
    ended = linkwright("check", tmp_path)
    assert ended.returncode == 1
    assert re.search(r"FAIL +figures\.fvi +\S+ +\S+ +-\S+", ended.stdout)


@pytest.mark.parametrize(
    ("pattern", "replacement", "named"),
    [
        (r"arm_length = [\d.]+", "arm_length = -0.3", ["optimum.toml:", "geometry.arm_length", "-0.3", "> 0"]),
        (r"arm_length = [\d.]+", "arm_lenght = 0.3", ["optimum.toml:", "arm_lenght"]),
        (r"arm_length = [\d.]+\n", "", ["optimum.toml:", "no arm_length"]),
        (r"(?m)^fvi = [\d.]+", 'fvi = "good"', ["optimum.toml", "figures.fvi"]),
        (r"\[geometry\]", "[geometry", ["optimum.toml:", "syntax"]),
        (r"\[certificate\.J_q\]", "[certificate]\nJ_q = 3\n[kept]", ["optimum.toml:", "certificate.J_q", "found 3"]),
    ],
)
def test_an_unusable_optimum_is_wrong_input_by_file_and_key(
    small_run: SmallRun, tmp_path: Path, pattern: str, replacement: str, named: list[str]
) -> None:
    file = copy_of(small_run[0], tmp_path)
    file.write_text(re.sub(pattern, replacement, file.read_text(), count=1))
    ended = linkwright("check", tmp_path)
    assert ended.returncode == 2
    for word in named:
        assert word in ended.stderr


def test_an_optimum_of_another_question_is_refused(small_run: SmallRun, tmp_path: Path) -> None:
    copy_of(small_run[0], tmp_path)
    (tmp_path / "study.toml").write_text(SMALL.replace("z = [-0.76, -0.7]", "z = [-0.76, -0.69]"))
    ended = linkwright("trajectory", tmp_path)
    assert ended.returncode == 2
    assert "another question (region.z was [-0.76, -0.7] and is [-0.76, -0.69])" in ended.stderr
    ended = linkwright("check", tmp_path)
    assert ended.returncode == 1
    assert re.search(r"FAIL +design question: region\.z +\[-0\.76, -0\.7\] +\[-0\.76, -0\.69\]", ended.stdout)


def test_another_payload_leaves_the_geometry_its_claims_and_check_names_the_key(
    small_run: SmallRun, tmp_path: Path
) -> None:
    copy_of(small_run[0], tmp_path)
    (tmp_path / "study.toml").write_text(SMALL.replace("payload = 0.5", "payload = 0.25"))
    assert linkwright("trajectory", tmp_path).returncode == 0
    rows = check_study(read_toml(tmp_path / "study.toml"))
    assert [(row.what, row.expected, row.found) for row in rows if not row.holds][:-1] == [
        ("cycle question: trajectory.cycle.payload", "0.5", "0.25")
    ]
    holds = {row.what for row in rows if row.holds}
    assert {"answers the study's design question", "figures.fvi", "internal_determinant >= 0.4 everywhere"} <= holds


def test_masses_belong_to_the_cycle_and_a_title_to_neither_question(small_run: SmallRun, tmp_path: Path) -> None:
    copy_of(small_run[0], tmp_path)
    plain, other = "Two variables", "Another title"
    (tmp_path / "study.toml").write_text(SMALL.replace(plain, other) + "[trajectory.drive]\nincrements = 4096\n")
    assert all(row.holds for row in check_study(read_toml(tmp_path / "study.toml")))
    (tmp_path / "study.toml").write_text(SMALL + "[inertia]\narm_mass = 0.5\n")
    failed = [row.what for row in check_study(read_toml(tmp_path / "study.toml")) if not row.holds]
    assert failed == ["cycle question: inertia.arm_mass", "answers the study's cycle question"]
