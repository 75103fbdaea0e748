"""A run keeps its optimum before the cycle and the proofs, and the next one takes it up; a folder holds one answer."""

from __future__ import annotations

import json
from pathlib import Path
from unittest.mock import patch

import pytest

from studies.errors import RequirementFailed
from studies.results import resume
from studies.results.output_folder import LIST
from studies.stages import pipeline
from tests.studies.command_line import SMALL, Ended, linkwright
from tests.studies.stages.test_certify import GIVEN
from trajectory import read_setpoints

DESIGN = SMALL.partition("[trajectory]")[0]
CYCLE = GIVEN + "[trajectory]" + SMALL.partition("[trajectory]")[2]


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def run(folder: Path, *more: str) -> Ended:
    return linkwright("run", folder, "--out", folder / "out", "--json", *more)


def stopped(folder: Path) -> None:
    """A run that ends before its proofs, as an interrupt would end it."""
    with patch.object(resume, "certified", side_effect=RequirementFailed([])):
        assert run(folder).returncode == 1
    assert {file.name for file in (folder / "out").iterdir()} == {"optimum.toml", LIST}


def test_a_run_that_was_stopped_goes_on_from_its_optimum_and_ends_as_one_that_was_not(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(DESIGN)
    stopped(tmp_path)
    with patch.object(pipeline, "synthesise", side_effect=AssertionError("optimised again")):
        ended = run(tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert "out/optimum.toml: used" in ended.stderr
    after_a_stop = (tmp_path / "out" / "optimum.toml").read_bytes()
    assert run(tmp_path, "--fresh").returncode == 0
    assert (tmp_path / "out" / "optimum.toml").read_bytes() == after_a_stop


@pytest.mark.parametrize(
    ("change", "again"),
    [
        (("z = [-0.76, -0.7]", "z = [-0.76, -0.71]"), True),
        (("at_least = 0.4", "at_least = 0.41"), True),
        (('"internal_determinant", "J_q"]', '"internal_determinant"]'), False),
        (("Two variables", "Another title"), False),
        (("[certify]", "[inertia]\narm_mass = 0.5\n[budget]\noptimise = 50\n[certify]"), False),
    ],
    ids=["region", "requirement", "certified margins", "title", "masses and budget"],
)
def test_only_another_design_question_is_optimised_again(tmp_path: Path, change: tuple[str, str], again: bool) -> None:
    (tmp_path / "study.toml").write_text(DESIGN)
    stopped(tmp_path)
    (tmp_path / "study.toml").write_text(DESIGN.replace(*change))
    with patch.object(resume, "designed", side_effect=RequirementFailed([])) as designed:
        assert run(tmp_path).returncode == 1
    assert (designed.call_args.args[1] is None) == again


def test_an_optimum_that_the_user_changed_is_neither_taken_up_nor_replaced(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(DESIGN)
    stopped(tmp_path)
    file = tmp_path / "out" / "optimum.toml"
    file.write_text(changed := file.read_text() + "# mine\n")
    ended = run(tmp_path)
    assert ended.returncode == 2
    assert f"{file}: found a file that this program did not write" in json.loads(ended.stdout)["error"]
    assert file.read_text() == changed


@pytest.mark.long
def test_drive_files_of_another_payload_go_and_what_the_user_put_there_stays(tmp_path: Path) -> None:
    out = tmp_path / "out"
    text = CYCLE.replace("period = 0.002", 'period = 0.002\nfiles = ["csv", "xps"]')
    (tmp_path / "study.toml").write_text(text)
    assert linkwright("report", tmp_path, "--out", out).returncode == 0
    (out / "cycle.pmac").write_text("mine")
    (tmp_path / "study.toml").write_text(CYCLE.replace("payload = 0.5", "payload = 0.25"))
    found = json.loads(linkwright("trajectory", tmp_path, "--out", out, "--json").stdout)
    assert found["removed"] == [str(out / "cycle.xps.trj")]
    assert set(found["left"]) == {str(out / "report.html"), str(out / "mechanism.png")}
    assert (out / "cycle.pmac").read_text() == "mine"
    assert read_setpoints(out / "cycle.csv").header["payloads [kg]"] == [0.25, 0.25]


def test_no_stage_takes_longer_than_its_seconds_and_what_stays_open_is_undecided(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(GIVEN)
    ended = linkwright("certify", tmp_path, "--margin", "fvi", "--at-least", "1.7", "--seconds", "1e-3", "--json")
    assert ended.returncode == 1
    (proof,) = json.loads(ended.stdout)["proofs"]
    assert proof["status"] == "undecided"
    assert proof["seconds"] < 5.0
    (tmp_path / "study.toml").write_text(DESIGN)
    ended = linkwright("optimise", tmp_path, "--seconds", "1e-3", "--json")
    assert ended.returncode == 1
    assert "the time of 0.001 s ended" in json.loads(ended.stdout)["error"]
