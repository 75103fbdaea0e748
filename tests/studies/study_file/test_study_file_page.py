"""docs/study_file.md: its keys are those of the schema, and its examples run."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from kinematics import Heli4, Redundant3T1R
from studies.building.load import load_study
from studies.building.objects import path_of, robot_of
from studies.stages.cycle_stage import time_cycle
from studies.study_file import questions
from studies.study_file.toml_file import read_toml
from tests.bench.study_keys import BY, NAME, PAGE, tables

TEXT = PAGE.read_text()
STUDY, CYCLE = re.findall(r"```toml\n(.*?)```", TEXT, re.S)
(CSV,) = re.findall(r"```csv\n(.*?)```", TEXT, re.S)


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real ones here."""


def test_the_keys_are_those_of_the_schema() -> None:
    written = TEXT.partition(f"<!-- {NAME}: written by `{BY}` -->\n")[2].partition(f"<!-- /{NAME} -->")[0]
    assert written == tables(), f"{BY} writes them anew"


def test_every_key_has_a_meaning() -> None:
    rows = [line for line in tables().partition("### Of each mechanism")[0].splitlines() if line.startswith("| ")]
    assert len(rows) > 100
    assert [row for row in rows if row.endswith("|  |")] == []


def test_the_page_says_that_the_margin_of_the_signed_determinant_is_its_modulus() -> None:
    assert "keeps the sign; the margin of that name is its modulus" in TEXT
    for robot in (Heli4(), Redundant3T1R()):
        signed = robot.internal_determinant(robot.home)
        assert abs(signed) == robot.margin("internal_determinant", robot.home) > 0.0


def test_the_page_lists_every_kind_of_member_with_its_usual_material() -> None:
    for name, kinds in {"Delta": "`arm` (aluminium), `rod` (carbon tube), `plate` (aluminium)"}.items():
        (row,) = (line for line in TEXT.splitlines() if line.startswith(f"| {name} |"))
        assert kinds in row
    assert "| a kind of member of the mechanism | the name of a material |" in TEXT


def test_the_example_is_timed_and_its_waypoints_may_stand_in_a_file(tmp_path: Path) -> None:
    (tmp_path / "waypoints.csv").write_text(CSV)
    paths = []
    for text in (STUDY, STUDY.partition("[[")[0] + 'file = "waypoints.csv"\n'):
        (tmp_path / "study.toml").write_text(text)
        study = load_study(read_toml(tmp_path / "study.toml"))
        assert study.trajectory is not None
        paths.append(path_of(study.trajectory, robot_of(study).pose_names))
    assert paths[0] == paths[1]
    assert max(time_cycle(study, robot_of(study)).figures()["peak_over_limit"].values()) <= 1.0


def test_the_example_of_a_cycle_has_another_payload_on_the_way_back(tmp_path: Path) -> None:
    file = tmp_path / "study.toml"
    file.write_text(STUDY.partition("[trajectory.path]")[0] + CYCLE)
    asked = load_study(read_toml(file)).trajectory
    assert asked is not None
    assert (asked.payload, asked.payload_back) == (1.0, 0.0)


def test_the_page_names_every_table_of_both_questions() -> None:
    said = TEXT.partition("## Two questions")[2].partition("## An example")[0]
    design, cycle = said.split("The cycle question")
    words = {"ranges": "joint ranges", "requirement": "requirements", "code": "mechanism"}
    assert [table for table in questions.DESIGN if words.get(table, table) not in design] == []
    assert [table for table in questions.CYCLE if table not in cycle] == []
