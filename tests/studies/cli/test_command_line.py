"""The command line as a user meets it: what it prints, what it writes, how it exits."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from importlib.metadata import distribution, packages_distributions
from pathlib import Path

import pytest
from typer.core import TyperGroup
from typer.main import get_command
from typer.testing import CliRunner

from studies.cli.app import app
from tests.studies.command_line import SMALL, linkwright, linkwright_apart

GROUP = get_command(app)
assert isinstance(GROUP, TyperGroup)
COMMANDS = GROUP.commands


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def test_help_loads_none_of_the_heavy_libraries() -> None:
    heavy = ("casadi", "kinematics", "matplotlib", "numba", "numpy", "pydantic", "scipy")
    code = f"""
import sys, studies.cli
sys.argv = ["linkwright", "--help"]
try:
    studies.cli.main()
finally:
    print([name for name in {heavy} if name in sys.modules])
"""
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert shown.endswith("[]\n")
    for command in COMMANDS:
        assert command in shown


@pytest.mark.parametrize("command", COMMANDS)
def test_every_commands_help_has_examples_that_the_command_takes(command: str) -> None:
    shown = CliRunner().invoke(app, [command, "--help"])
    assert shown.exit_code == 0
    parser = COMMANDS[command]
    examples = [line.split() for line in (parser.help or "").splitlines() if line.startswith("linkwright ")]
    assert examples
    for example in examples:
        assert " ".join(example) in " ".join(shown.output.split())
        assert example[1] == command
        parser.make_context(command, example[2:])


@pytest.mark.parametrize("command", COMMANDS)
def test_help_shows_the_words_in_brackets_that_it_is_given(command: str) -> None:
    shown = "".join(CliRunner().invoke(app, [command, "--help"]).output.replace("│", " ").split())
    for option in COMMANDS[command].params:
        words = (getattr(option, "help", None) or "").replace("\\[", "[")
        assert "".join(words.split()) in shown


def test_an_error_is_a_message_and_an_exit_status_and_no_traceback(tmp_path: Path) -> None:
    ended = linkwright_apart("trajectory", tmp_path)
    assert (ended.returncode, ended.stdout) == (2, "")
    assert ended.stderr.startswith("linkwright: ")
    assert "Traceback" not in ended.stderr


def test_the_help_of_trajectory_promises_no_files_without_a_folder(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SMALL)
    shown = linkwright("trajectory", "--help").stdout
    assert "none are written" in shown
    assert linkwright("trajectory", tmp_path, "--prototype", cwd=tmp_path).returncode == 0
    assert [file.name for file in tmp_path.iterdir()] == ["study.toml"]


def test_list_shows_the_mechanisms_and_the_studies() -> None:
    data = json.loads(linkwright("list", "--json").stdout)
    assert "Heli4" in data["mechanisms"]
    assert "heli4" in data["studies"]
    assert "heli4" in linkwright("list").stdout


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (("platform_radius_mm", "platform_radius_deg"), ["study.toml:16", "platform_radius_deg"]),
        (("z = [-0.76, -0.7]", "z = [-0.6, -0.8]"), ["study.toml:9", "region.z"]),
        (("payload = 0.5", "payload = -1"), ["study.toml:", "trajectory.cycle.payload"]),
        (
            ("pick = [-0.15, 0, -0.75]", "pick = [-3, 0, -0.75]"),
            ["study.toml:", "trajectory.cycle", "inside the region"],
        ),
        (("x = [-0.2, 0.2]", "x = [-0.9, 0.9]", "pick = [-0.15", "pick = [-0.9"), ["limb", "reach margin"]),
    ],
)
def test_wrong_input_exits_2_with_its_place(tmp_path: Path, change: tuple[str, ...], named: list[str]) -> None:
    text = SMALL
    for old, new in zip(change[::2], change[1::2], strict=True):
        text = text.replace(old, new)
    (tmp_path / "study.toml").write_text(text)
    ended = linkwright("trajectory", tmp_path, "--prototype")
    assert ended.returncode == 2, ended.stdout
    for word in named:
        assert word in ended.stderr


def test_a_requirement_that_fails_on_the_path_exits_1_and_writes_nothing(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SMALL.replace("at_least = 0.4", "at_least = 0.99"))
    ended = linkwright("trajectory", tmp_path, "--prototype", "--out", tmp_path / "out")
    assert ended.returncode == 1
    assert "internal_determinant on the cycle" in ended.stderr
    assert not list((tmp_path / "out").glob("*"))


def test_another_format_is_written_for_a_committed_optimum(tmp_path: Path) -> None:
    ended = linkwright("trajectory", "peppermill", "--out", tmp_path, "--format", "zaber")
    assert ended.returncode == 0, ended.stderr
    assert (tmp_path / "cycle.zaber.csv").exists()


def test_without_a_committed_optimum_nothing_else_is_taken_for_it(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SMALL)
    for command in ("trajectory", "report", "check"):
        ended = linkwright(command, tmp_path)
        assert ended.returncode == 2
        assert f"{tmp_path / 'optimum.toml'}: found no such file; expected the study's committed" in ended.stderr
        assert "`linkwright run STUDY --commit` writes it; --prototype works" in ended.stderr


def test_an_approach_keeps_the_drives_limits_too(tmp_path: Path) -> None:
    wild = "\n[trajectory.approach]\nspeed = 60\nacceleration = 4000\njerk = 5e5\n"
    (tmp_path / "study.toml").write_text(SMALL + wild)
    ended = linkwright("trajectory", tmp_path, "--prototype")
    assert ended.returncode == 1
    assert "torque" in ended.stderr


@pytest.mark.long
def test_one_study_serves_every_law() -> None:
    found = {}
    for law in ("jerk", "toppra"):
        ended = linkwright("trajectory", "cycle_reference", "--law", law, "--json")
        assert ended.returncode == 0, ended.stderr
        found[law] = json.loads(ended.stdout)
        assert found[law]["law"] == law
        assert max(found[law]["peak_over_limit"].values()) <= 1.0
    assert found["toppra"]["half_cycle"] < found["jerk"]["half_cycle"] <= 0.1325
    assert "joint jerk" in found["jerk"]["peak_over_limit"]
    assert "joint jerk" not in found["toppra"]["peak_over_limit"]
    assert found["toppra"]["limits_not_kept"] == ["jerk"]


def test_an_unknown_law_and_a_law_without_its_limit_are_wrong_input(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SMALL)
    for law, said in (
        ("fast", "expected one of jerk, toppra"),
        ("jerk", "trajectory.limits.jerk: found nothing for the jerk law"),
    ):
        ended = linkwright("trajectory", tmp_path, "--prototype", "--law", law)
        assert ended.returncode == 2
        assert said in ended.stderr


def test_an_unknown_study_is_answered_with_the_known_ones(tmp_path: Path) -> None:
    ended = linkwright("run", "heli5", cwd=tmp_path)
    assert ended.returncode == 2
    assert "did you mean heli4?" in ended.stderr


def test_an_output_folder_that_cannot_be_is_wrong_input(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SMALL)
    (tmp_path / "file").write_text("")
    ended = linkwright("trajectory", tmp_path, "--prototype", "--out", tmp_path / "file" / "out")
    assert ended.returncode == 2
    assert "cannot write" in ended.stderr
    ended = linkwright("trajectory", tmp_path, "--prototype", "--out", tmp_path / "file")
    assert ended.returncode == 2
    assert "it is a file; expected a folder" in ended.stderr


def test_a_run_that_fails_leaves_no_folder_behind(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(
        SMALL.partition("[optimise]")[0] + '[[requirement]]\nmargin = "reach"\nat_least = 9\n'
    )
    ended = linkwright("run", tmp_path, "--out", tmp_path / "new" / "out")
    assert ended.returncode == 1
    assert [file.name for file in tmp_path.iterdir()] == ["study.toml"]


def test_all_four_packages_belong_to_this_distribution() -> None:
    import design
    import kinematics
    import studies
    import trajectory

    assert distribution("linkwright").version
    roots = {Path(package.__file__).parents[1] for package in (kinematics, design, trajectory, studies)}
    assert len(roots) == 1
    owners = packages_distributions()
    for name in ("kinematics", "design", "trajectory", "studies"):
        assert set(owners[name]) == {"linkwright"}


def test_the_version_is_told_and_no_command_at_all_is_answered_by_the_help_alone() -> None:
    assert linkwright("--version").stdout.startswith("linkwright ")
    ended = linkwright()
    assert (ended.returncode, ended.stderr) == (2, "")
    assert "--version" in ended.stdout


def test_an_error_whose_reader_has_left_is_no_traceback(tmp_path: Path) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-c", "from studies.cli import main; main()", "run", str(tmp_path), "--json"]
    ended = subprocess.run(command, stdout=writer, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writer)
    assert ended.returncode == 2
    assert ended.stderr.startswith("linkwright: ")
    assert "Traceback" not in ended.stderr
    assert "BrokenPipe" not in ended.stderr
