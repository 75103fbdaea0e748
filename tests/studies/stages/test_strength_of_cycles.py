"""What a study says of a cycle's loads: tables, JSON, files; and of a cycle that would break a member."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from tests.studies.command_line import linkwright

STUDY = """\
title = "Three legs"
mechanism = "Planar3RPR"
dense_sample = 10_000
[region]
kind = "box"
x = [-0.1, 0.1]
y = [-0.1, 0.1]
theta = [-0.2, 0.2]
[trajectory]
law = "toppra"
grid = 1000
[trajectory.path]
payload = PAYLOAD
waypoint = [{ x = -0.05, y = 0.0, theta = 0.0 }, { x = 0.05, y = 0.02, theta = 0.1 }]
[trajectory.limits]
speed = 2
acceleration = 60
"""
REQUIRED = '\n[[requirement]]\nmargin = "strength"\nat_least = 1\n'


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def study(folder: Path, payload: float, more: str = "") -> Path:
    (folder / "study.toml").write_text(STUDY.replace("PAYLOAD", str(payload)) + more)
    return folder


def test_a_cycle_reports_its_frame_and_its_members(tmp_path: Path) -> None:
    ended = linkwright("trajectory", study(tmp_path, 2.0), "--out", tmp_path / "out", "--json")
    assert ended.returncode == 0, ended.stderr
    assert "would break" not in ended.stderr
    data = json.loads(ended.stdout)
    frame, members = data["frame_reaction"], data["members"]
    assert frame["force"]["peak"] >= frame["force"]["rms"] > 0.0
    assert [member["member"] for member in members] == ["rod 1", "rod 2", "rod 3"]
    assert all(member["safety"] > 1.0 for member in members)
    rows = (tmp_path / "out" / "frame_reaction.csv").read_text().splitlines()
    assert len(rows) == round(data["cycle_on_the_bus"] / 0.001) + 5


def test_a_cycle_that_would_break_a_member_says_how_and_marks_its_row(tmp_path: Path) -> None:
    ended = linkwright("trajectory", study(tmp_path, 2000.0))
    assert ended.returncode == 0, ended.stderr
    told = " ".join(ended.stderr.split())
    assert re.search(r"this cycle would break rod \d by (buckling|yield): its safety factor falls to 0\.", told), told
    assert "below 1" in told
    assert "Reaction on the frame" in ended.stdout
    table = ended.stdout.partition("Members over the whole cycle")[2].partition("Reaction")[0]
    assert re.search(r"BREAKS +rod \d .* (buckling|yield)", table), table
    assert "largest tension [N]" in table
    assert "largest compression [N]" in table


def test_a_broken_member_is_in_the_data_and_in_the_report(tmp_path: Path) -> None:
    folder = study(tmp_path, 2000.0)
    data = json.loads(linkwright("trajectory", folder, "--json").stdout)
    worst = min(data["members"], key=lambda member: member["safety"])
    assert data["would_break"][0] == worst["member"]
    assert worst["fails_by"] in ("buckling", "yield")
    assert min(worst["tension"], worst["compression"]) >= 0.0
    ended = linkwright("report", folder, "--out", tmp_path / "out", "--json")
    assert json.loads(ended.stdout)["cycle"]["would_break"] == data["would_break"]
    page = (tmp_path / "out" / "report.html").read_text()
    assert f"would break {worst['member']} by {worst['fails_by']}" in page
    assert page.count('<tr class="fails">') == len(data["would_break"])


@pytest.mark.parametrize("command", ["trajectory", "run"])
def test_a_required_strength_refuses_it_with_member_pose_time_and_key(tmp_path: Path, command: str) -> None:
    """The robot's own load, 1 kg, would be borne everywhere; the cycle's is not."""
    folder = study(tmp_path, 2000.0, REQUIRED)
    ended = linkwright(command, folder, *(("--out", tmp_path / "out") if command == "run" else ()))
    assert ended.returncode == 1
    told = " ".join(ended.stderr.split())
    line = (STUDY + REQUIRED).splitlines().index("at_least = 1") + 1
    found = (
        r"strength on the cycle of rod \d, (buckling|yield): found 0\.\d+ at pose \(.*\), \S+ s after the cycle starts"
    )
    assert re.search(rf"study\.toml:{line}: requirement\.at_least: {found}; expected at least 1", told), told


def test_another_margin_that_fails_on_the_cycle_names_its_place_on_the_path(tmp_path: Path) -> None:
    asked = '\n[[requirement]]\nmargin = "reach"\nat_least = 5\n'
    ended = linkwright("trajectory", study(tmp_path, 2.0, asked))
    assert ended.returncode == 1
    told = " ".join(ended.stderr.split())
    assert re.search(
        r"reach on the cycle of limb \d: found \S+ at pose \(.*\), \S+ m along the path; expected", told
    ), told
