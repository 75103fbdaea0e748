"""`--json` prints one object on standard output, whatever the exit status."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.studies.command_line import SMALL, SmallRun, copy_of, linkwright
from tests.studies.stages.test_certify import GIVEN


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def printed(status: int, *words: object, cwd: Path) -> dict[str, Any]:
    ended = linkwright(*words, "--json", cwd=cwd)
    assert ended.returncode == status, ended.stderr
    found = json.loads(ended.stdout)
    assert isinstance(found, dict)
    return found


WRONG = (
    ["run", "wrong"],
    ["optimise", "wrong"],
    ["map", "wrong"],
    ["certify", "wrong"],
    ["trajectory", "wrong"],
    ["report", "wrong"],
    ["export", "wrong", "--out", "robot.xml"],
    ["check", "wrong"],
)


@pytest.mark.parametrize("words", WRONG, ids=lambda words: words[0])
def test_a_fault_of_the_study_has_its_file_key_and_line(words: list[str], tmp_path: Path) -> None:
    (tmp_path / "wrong").mkdir()
    (tmp_path / "wrong" / "study.toml").write_text(SMALL.replace("z = [-0.76, -0.7]", "z = [-0.7, -0.76]"))
    found = printed(2, *words, cwd=tmp_path)
    assert found["exit_status"] == 2
    assert [(p["key"], p["line"]) for p in found["problems"]] == [("region.z", 9)]
    assert found["problems"][0]["found"] == "[-0.7, -0.76]"


@pytest.mark.parametrize(
    "words",
    [
        ["run"],
        ["run", "a", "b"],
        ["fly", "heli4"],
        ["run", "heli4", "--fast"],
        ["list", "--wide"],
        ["run", "heli5"],
        ["map", "heli4", "--tolerance", "thin"],
        ["certify", "heli4", "--seconds", "0"],
        ["run", "heli4", "--seconds", "nan"],
        ["trajectory", "heli4", "--law", "fast"],
    ],
    ids=" ".join,
)
def test_a_wrong_command_line_is_told_in_an_object(words: list[str], tmp_path: Path) -> None:
    found = printed(2, *words, cwd=tmp_path)
    assert found["error"]
    assert found["exit_status"] == 2


def test_a_requirement_that_fails_is_in_the_object_with_its_pose(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(GIVEN.replace("at_least = 0.4", "at_least = 0.99"))
    (failed,) = printed(1, "run", "study.toml", cwd=tmp_path)["failed"]
    assert (failed["margin"], failed["at_least"], len(failed["pose"])) == ("internal_determinant", 0.99, 4)
    assert failed["found"] < 0.99
    proofs = printed(1, "certify", "study.toml", cwd=tmp_path)["proofs"]
    assert proofs[0]["status"] == "refuted"
    (tmp_path / "study.toml").write_text(SMALL.replace("at_least = 0.4", "at_least = 0.99"))
    (failed,) = printed(1, "trajectory", "study.toml", "--prototype", cwd=tmp_path)["failed"]
    assert failed["margin"] == "internal_determinant on the cycle"


def test_a_failed_check_is_an_object_with_its_rows(small_run: SmallRun, tmp_path: Path) -> None:
    copy_of(small_run[0], tmp_path)
    (tmp_path / "study.toml").write_text(SMALL.replace("x = [-0.2, 0.2]", "x = [-0.2, 0.21]"))
    found = printed(1, "check", "study.toml", cwd=tmp_path)
    assert found["holds"] is False
    assert any("region.x" in row["what"] for row in found["studies"]["study.toml"] if not row["holds"])
