"""The study and the command line say which drive files are written, and are told before any work what cannot be."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from kinematics import InvalidValue
from studies.cli.app import app
from studies.errors import StudyError
from studies.results.output_folder import LIST
from tests.studies.cli.test_command_line import SMALL
from trajectory import LAWS
from trajectory.drive_files.formats import FORMATS

DRIVE = "[trajectory.drive]\nincrements = 1048576\nencoder_gear = 9\naxes = ['X', 'Y', 'Z', 'A']\n"


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def trajectory(folder: Path, text: str, *arguments: str) -> dict[str, object]:
    (folder / "study.toml").write_text(text)
    call = ["trajectory", str(folder / "study.toml"), "--out", str(folder / "out"), "--prototype", "--json", *arguments]
    result = CliRunner().invoke(app, call)
    if result.exception:
        raise result.exception
    return json.loads(result.stdout)


def asking(files: str, more: str = "") -> str:
    return SMALL.replace("period = 0.002", f"period = 0.002\nfiles = {files}") + more


def test_list_names_the_registrys_formats_and_laws() -> None:
    listed = json.loads(CliRunner().invoke(app, ["list", "--json"]).stdout)
    assert listed["formats"] == {name: form.title for name, form in FORMATS.items()}
    assert listed["laws"] == {name: law.title for name, law in LAWS.items()}


def test_a_study_gets_the_files_it_asks_for(tmp_path: Path) -> None:
    said = trajectory(tmp_path, asking(json.dumps(list(FORMATS)), DRIVE))
    written = {file.name for file in (tmp_path / "out").iterdir()}
    ends = ("csv", "ros2.yaml", "ros2.mcap", "cia402.csv", "zaber.csv", "xps.trj", "pmac")
    expected = {"frame_reaction.csv"} | {f"cycle.{end}" for end in ends}
    assert written - {LIST} == expected == {Path(name).name for name in said["files"]}
    assert set(said["between_setpoints"]) == {"linear", "cubic", "quintic"}
    assert "X 0x607A,Y 0x607A,Z 0x607A,A 0x607A" in (tmp_path / "out" / "cycle.cia402.csv").read_text()


def test_the_command_line_s_formats_take_the_study_s_place(tmp_path: Path) -> None:
    trajectory(tmp_path, SMALL, "--format", "xps", "--format", "zaber")
    written = {file.name for file in (tmp_path / "out").iterdir()} - {LIST}
    assert written == {"cycle.xps.trj", "cycle.zaber.csv", "frame_reaction.csv"}


@pytest.mark.parametrize(
    ("text", "arguments", "says"),
    [
        (SMALL, ["--format", "rso2"], "found rso2; expected one of csv (all of each set-point, SI), ros2 (ROS 2"),
        (SMALL, ["--format", "cia402"], "trajectory.drive.increments: found nothing for --format cia402; expected the"),
        (asking('["pmac"]', DRIVE.replace("'A'", "'joint'")), [], "letters out of X Y Z"),
        (asking('["zaber"]', DRIVE.replace(", 'A'", "")), [], "a list of names, one a joint of the 4"),
        (asking('["csv"]', DRIVE.replace("encoder_gear = 9", "encoder_gear = 0")), [], "other than 0"),
        (
            asking('["cia402"]', DRIVE.replace("encoder_gear = 9", "encoder_gear = 90000")),
            [],
            "-2147483648 to 2147483647",
        ),
        (asking('["pmac"]').replace("0.002", "0.0004"), [], "1/4096 ms"),
    ],
)
def test_what_a_format_cannot_say_is_told_before_any_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str, arguments: list[str], says: str
) -> None:
    monkeypatch.setattr("studies.stages.pipeline.time_cycle", None)  # calling it would be another error
    with pytest.raises((StudyError, InvalidValue)) as caught:
        trajectory(tmp_path, text, *arguments)
    assert says in str(caught.value)
    assert not list((tmp_path / "out").glob("*"))


def test_a_format_without_a_folder_is_refused() -> None:
    result = CliRunner().invoke(app, ["trajectory", "heli4", "--format", "ros2"])
    assert isinstance(result.exception, InvalidValue)
    assert "--out" in str(result.exception)
