"""Robots of another size than the prototypes: runs, models and approaches start where these robots can be."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.studies.command_line import linkwright

DELTA = """\
title = "A delta on a desk"
mechanism = "Delta"
dense_sample = 10_000
[geometry]
base_radius_mm = 90
platform_radius_mm = 25
arm_length_mm = 120
rod_length_mm = 260
[region]
kind = "box"
x_mm = [-30, 30]
y_mm = [-30, 30]
z_mm = [-290, -250]
[certify]
margins = ["reach"]
"""
CYCLE = """\
[trajectory]
law = "toppra"
[trajectory.cycle]
lift_mm = 15
span_mm = 50
pick_mm = [-25, 0, -280]
blend_mm = 12
payload = 0.1
[trajectory.limits]
speed = 10
acceleration = 200
[trajectory.approach]
speed = 3
acceleration = 30
jerk = 500
"""
HELI4 = """\
title = "A small Heli4"
mechanism = "Heli4"
[geometry]
base_radius = 0.09
platform_radius = 0.016
arm_length = 0.12
rod_length = 0.26
plate_offset = 0.011
height_step = 0.014
pitch = 0.02
[region]
kind = "box"
x = [-0.04, 0.04]
y = [-0.04, 0.04]
z = [-0.26, -0.22]
theta_deg = [-60, 60]
"""


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def test_a_run_of_a_small_robot_writes_its_report(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(DELTA)
    ended = linkwright("run", tmp_path, "--out", tmp_path / "out")
    assert ended.returncode == 0, ended.stderr
    assert (tmp_path / "out" / "report.html").is_file()


def test_an_approach_starts_at_a_home_of_this_robot(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(DELTA + CYCLE)
    ended = linkwright("trajectory", tmp_path, "--out", tmp_path / "out")
    assert ended.returncode == 0, ended.stderr
    assert (tmp_path / "out" / "approach.csv").is_file()


def test_a_model_without_a_cycle_starts_in_the_region(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(HELI4)
    ended = linkwright("export", tmp_path, "--out", tmp_path / "robot.xml")
    assert ended.returncode == 0, ended.stderr
    assert ElementTree.parse(tmp_path / "robot.xml").getroot().tag == "mujoco"


@pytest.mark.parametrize(
    ("change", "status", "says"),
    [
        (
            ("speed = 3\n", "speed = 1e-5\n"),
            1,
            r":\d+: trajectory\.approach: no approach from home .* it would take longer than ruckig can plan",
        ),
        (
            ("[region]", "[home]\nz_mm = -900\n[region]"),
            2,
            r"study\.toml:10: home.z_mm: found -900; expected a home in reach",
        ),
        (("pick_mm = [-25", "pick_mm = [-28"), 0, ""),
    ],
    ids=["too slow", "home out of reach", "right"],
)
def test_an_approach_that_cannot_be_is_told_at_its_own_table(
    change: tuple[str, str], status: int, says: str, tmp_path: Path
) -> None:
    (tmp_path / "study.toml").write_text((DELTA + CYCLE).replace(*change))
    ended = linkwright("trajectory", tmp_path)
    assert ended.returncode == status, ended.stderr
    assert re.search(says, ended.stderr), ended.stderr
    assert "trajectory.cycle:" not in ended.stderr
