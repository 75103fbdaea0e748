"""The command line as a user meets it: what it prints, what it writes, how it exits."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from importlib.metadata import distribution, packages_distributions
from pathlib import Path

import numpy as np
import pytest

from trajectory import read_setpoints

SMALL = """\
title = "Two variables"
mechanism = "Heli4"
dense_sample = 20_000

[region]
kind = "box"
x = [-0.2, 0.2]
y = [-0.2, 0.2]
z = -0.7
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


def test_check_accepts_what_was_committed(small_run: SmallRun) -> None:
    for study in ("heli4", small_run[0]):
        ended = linkwright("check", study)
        assert ended.returncode == 0, ended.stdout + ended.stderr
        assert "all holds" in ended.stdout


@pytest.mark.parametrize(
    ("pattern", "replacement", "claim"),
    [
        (r"pitch = [\d.]+", "pitch = 0.07", "worst fvi"),
        (r"(?m)^fvi = \d", "fvi = 9", "worst fvi"),
        (r"half_cycle = 0\.1\d", "half_cycle = 0.01", "half cycle"),
        (r"platform_radius = [\d.]+", "platform_radius = 0.081", "geometry.platform_radius"),
        (r"height_step = 0\.0", "height_step = 0.001", "geometry, other fields"),
        (r'study_digest = "...', 'study_digest = "000', "study"),
    ],
)
def test_a_tampered_optimum_fails_its_check_with_the_claim_and_its_margin(
    small_run: SmallRun, tmp_path: Path, pattern: str, replacement: str, claim: str
) -> None:
    file = copy_of(small_run[0], tmp_path)
    text, changes = re.subn(pattern, replacement, file.read_text(), count=1)
    assert changes == 1
    file.write_text(text)
    ended = linkwright("check", tmp_path, "--json")
    assert ended.returncode == 1, ended.stderr
    rows = next(iter(json.loads(ended.stdout)["studies"].values()))
    failed = {row["what"]: row["margin"] for row in rows if not row["holds"]}
    assert claim in "".join(failed)
    assert min(failed.values()) < 0


def test_a_failed_check_is_a_table_with_the_margin(small_run: SmallRun, tmp_path: Path) -> None:
    file = copy_of(small_run[0], tmp_path)
    file.write_text(re.sub(r"pitch = [\d.]+", "pitch = 0.07", file.read_text(), count=1))
    ended = linkwright("check", tmp_path)
    assert ended.returncode == 1
    assert re.search(r"FAIL +worst fvi +\S+ +\S+ +-\S+", ended.stdout)


@pytest.mark.parametrize(
    ("pattern", "replacement", "named"),
    [
        (r"arm_length = [\d.]+", "arm_length = -0.3", ["arm_length", "-0.3", "> 0"]),
        (r"arm_length = [\d.]+", "arm_lenght = 0.3", ["optimum.toml", "arm_lenght"]),
        (r"(?m)^fvi = [\d.]+", 'fvi = "good"', ["optimum.toml", "figures.fvi"]),
        (r"\[geometry\]", "[geometry", ["optimum.toml", "TOML"]),
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
        (("z = -0.7", "z = [-0.6, -0.8]"), ["study.toml:9", "region.z"]),
        (("payload = 0.5", "payload = -1"), ["study.toml:", "trajectory.cycle.payload"]),
        (("pick = [-0.15, 0, -0.75]", "pick = [-3, 0, -0.75]"), ["limb", "reach margin"]),
    ],
)
def test_wrong_input_exits_2_with_its_place(tmp_path: Path, change: tuple[str, str], named: list[str]) -> None:
    (tmp_path / "study.toml").write_text(SMALL.replace(*change))
    ended = linkwright("trajectory", tmp_path, "--prototype")
    assert ended.returncode == 2, ended.stdout
    assert "Traceback" not in ended.stderr
    for word in named:
        assert word in ended.stderr


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
