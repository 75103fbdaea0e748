"""The command line as a user meets it: what it prints, what it writes, how it exits."""

from __future__ import annotations

import copy
import functools
import itertools
import json
import os
import re
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator
from importlib.metadata import distribution, packages_distributions
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w

from studies.check import check_study, compare
from studies.errors import StudyError
from studies.load import load_study
from studies.locate import study_names
from studies.optimum import read_optimum
from studies.pipeline import run
from trajectory import read_setpoints

SMALL = """\
title = "Two variables"
mechanism = "Heli4"
dense_sample = 20_000

[region]
kind = "box"
x = [-0.2, 0.2]
y = [-0.2, 0.2]
z = [-0.76, -0.7]
theta_deg = [-90, 90]

[optimise]
starts = 1

[optimise.variables]
platform_radius_mm = [30, 80]
pitch = [0.02, 0.12]

[[requirement]]
margin = "internal_determinant"
at_least = 0.4

[trajectory]
law = "toppra"
grid = 1000
period = 0.002

[trajectory.cycle]
lift_mm = 25
span_mm = 300
blend_mm = 20
turn_deg = 90
pick = [-0.15, 0, -0.75]
payload = 0.5

[trajectory.limits]
speed_rpm = 190
torque = 127
"""


def linkwright(*arguments: object, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    call = [sys.executable, "-c", "from studies.cli import main; main()", *map(str, arguments)]
    environment = os.environ | {"COLUMNS": "200", "NO_COLOR": "1"}
    return subprocess.run(call, capture_output=True, text=True, cwd=cwd, check=False, env=environment)


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


@pytest.fixture(scope="module")
def small_run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, subprocess.CompletedProcess[str]]:
    folder = tmp_path_factory.mktemp("small")
    (folder / "study.toml").write_text(SMALL)
    return folder, linkwright("run", folder / "study.toml", "--out", folder / "out", "--commit", "--json")


def copy_of(run: Path, folder: Path) -> Path:
    for name in ("study.toml", "optimum.toml"):
        (folder / name).write_text((run / name).read_text())
    return folder / "optimum.toml"


SmallRun = tuple[Path, subprocess.CompletedProcess[str]]


def test_help_loads_none_of_the_heavy_libraries() -> None:
    code = "import sys, studies.cli; print([m for m in ('casadi','numba','numpy','matplotlib') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
    shown = linkwright("--help")
    assert shown.returncode == 0
    for command in ("list", "run", "optimise", "trajectory", "report", "check"):
        assert command in shown.stdout


def test_list_shows_the_mechanisms_and_the_studies() -> None:
    data = json.loads(linkwright("list", "--json").stdout)
    assert "Heli4" in data["mechanisms"]
    assert "heli4" in data["studies"]
    assert "heli4" in linkwright("list").stdout


def test_a_run_writes_optimum_report_and_set_points_and_says_so(
    small_run: SmallRun,
) -> None:
    folder, ended = small_run
    assert ended.returncode == 0, ended.stderr
    data = json.loads(ended.stdout)
    assert data["worst"]["fvi"]["value"] > data["prototype"]["fvi"]
    assert {Path(f).name for f in data["files"]} == {"optimum.toml", "report.html", "mechanism.png", "cycle.csv"}
    assert (folder / "optimum.toml").read_text() == (folder / "out" / "optimum.toml").read_text()
    points = read_setpoints(folder / "out" / "cycle.csv")
    np.testing.assert_allclose(np.diff(points.time), 0.002, rtol=1e-9)
    np.testing.assert_allclose(points.pose[0], points.pose[-1], atol=1e-9)
    assert max(data["cycle"]["peak_over_limit"].values()) <= 1.0
    assert not [f for f in (folder / "out").iterdir() if f.name.startswith(".")]


def test_the_report_opens_offline(small_run: SmallRun) -> None:
    page = (small_run[0] / "out" / "report.html").read_text()
    sources = re.findall(r'(?:src|href)="([^"]{0,40})', page)
    assert len(sources) >= 5
    assert all(source.startswith("data:image/png;base64,") for source in sources)
    assert "nan" not in re.sub(r'src="[^"]*"', "", page).lower().split()


def test_a_run_is_reproducible_from_the_study_alone(small_run: SmallRun, tmp_path: Path) -> None:
    again = tmp_path / "study.toml"
    again.write_text(SMALL)
    assert linkwright("run", again, "--out", tmp_path / "out").returncode == 0
    for name in ("optimum.toml", "cycle.csv"):
        assert (tmp_path / "out" / name).read_text() == (small_run[0] / "out" / name).read_text()


def test_check_accepts_every_committed_optimum() -> None:
    ended = linkwright("check", "--json")
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert set(json.loads(ended.stdout)["studies"]) == set(study_names())


def test_check_accepts_what_a_run_committed(small_run: SmallRun) -> None:
    ended = linkwright("check", small_run[0])
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert "all holds" in ended.stdout


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


def test_no_entry_of_an_optimum_can_be_changed_or_removed_unnoticed(small_run: SmallRun, tmp_path: Path) -> None:
    file = copy_of(small_run[0], tmp_path)
    original = tomllib.loads(file.read_text())
    study = load_study(tmp_path / "study.toml")
    outcome = run(study, read_optimum(file).robot(study), lambda _: None, compare_cycles=False)
    assert all(row.holds for row in compare(read_optimum(file), outcome))
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
        rows = compare(claimed, outcome) if same else check_study(tmp_path / "study.toml")
        assert not all(row.holds for row in rows), (path, change)


def test_an_invented_figure_is_noticed(small_run: SmallRun, tmp_path: Path) -> None:
    file = copy_of(small_run[0], tmp_path)
    file.write_text(file.read_text().replace("[figures]\n", "[figures]\nJ_q = 0.99\n"))
    failed = [row.what for row in check_study(tmp_path / "study.toml") if not row.holds]
    assert failed == ["figures.J_q"]


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
    ],
)
def test_an_unusable_optimum_is_wrong_input_by_file_and_key(
    small_run: SmallRun, tmp_path: Path, pattern: str, replacement: str, named: list[str]
) -> None:
    file = copy_of(small_run[0], tmp_path)
    file.write_text(re.sub(pattern, replacement, file.read_text(), count=1))
    ended = linkwright("check", tmp_path)
    assert ended.returncode == 2
    assert "Traceback" not in ended.stderr
    for word in named:
        assert word in ended.stderr


def test_a_failing_run_exits_1_and_leaves_what_was_there(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SMALL.replace("at_least = 0.4", "at_least = 0.999"))
    out = tmp_path / "out"
    out.mkdir()
    (out / "optimum.toml").write_text("of an earlier day")
    ended = linkwright("run", tmp_path, "--out", out)
    assert ended.returncode == 1
    assert "internal_determinant >= 0.999 falls short" in ended.stderr
    assert (out / "optimum.toml").read_text() == "of an earlier day"
    assert [f.name for f in out.iterdir()] == ["optimum.toml"]


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
    assert "Traceback" not in ended.stderr
    for word in named:
        assert word in ended.stderr


def test_a_given_geometry_that_fails_its_requirement_writes_nothing(tmp_path: Path) -> None:
    given = re.sub(r"\[optimise\].*?(?=\[\[requirement)", "", SMALL, flags=re.DOTALL)
    (tmp_path / "study.toml").write_text(given.replace("at_least = 0.4", "at_least = 0.99"))
    for command in ("run", "report"):
        ended = linkwright(command, tmp_path, "--out", tmp_path / "out")
        assert ended.returncode == 1, ended.stderr
        assert re.search(r"internal_determinant: found 0\.\d+ at pose \(.*\); expected at least 0\.99", ended.stderr)
        assert not list((tmp_path / "out").iterdir())


def test_without_a_committed_optimum_nothing_else_is_taken_for_it(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SMALL)
    for command in ("trajectory", "report"):
        ended = linkwright(command, tmp_path)
        assert ended.returncode == 2
        assert "optimum.toml" in ended.stderr


def test_an_optimum_of_another_question_is_refused(small_run: SmallRun, tmp_path: Path) -> None:
    copy_of(small_run[0], tmp_path)
    (tmp_path / "study.toml").write_text(SMALL.replace("turn_deg = 90", "turn_deg = 80"))
    ended = linkwright("trajectory", tmp_path)
    assert ended.returncode == 2
    assert "study_digest" in ended.stderr
    assert linkwright("check", tmp_path).returncode == 1


def test_an_interrupt_ends_a_run_at_once_even_inside_the_solver(tmp_path: Path) -> None:
    call = [
        sys.executable,
        "-c",
        "from studies.cli import main; main()",
        "run",
        "heli4",
        "--out",
        str(tmp_path / "out"),
    ]
    for wait in (3.0, 6.0):
        running = subprocess.Popen(call, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(wait)
        running.send_signal(signal.SIGINT)
        _, error = running.communicate(timeout=20)
        assert running.returncode == 130
        assert "interrupted" in error
    assert not list((tmp_path / "out").iterdir())


def test_an_approach_keeps_the_drives_limits_too(tmp_path: Path) -> None:
    wild = "\n[trajectory.approach]\nspeed = 60\nacceleration = 4000\njerk = 5e5\n"
    (tmp_path / "study.toml").write_text(SMALL + wild)
    ended = linkwright("trajectory", tmp_path, "--prototype")
    assert ended.returncode == 1
    assert "torque" in ended.stderr


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
    for law, said in (("fast", "expected one of jerk, toppra"), ("jerk", "Limits jerk for the jerk law")):
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


def test_all_four_packages_belong_to_this_distribution() -> None:
    import design
    import kinematics
    import studies
    import trajectory

    assert distribution("linkwright").version
    roots = {Path(package.__file__).parents[1] for package in (kinematics, design, trajectory, studies)}
    assert len(roots) == 1
    for name in ("kinematics", "design", "trajectory", "studies"):
        assert set(packages_distributions()[name]) == {"linkwright"}
