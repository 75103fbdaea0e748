"""What a study says of a cycle's loads: tables, JSON, files; and of a cycle that would break a member."""

from __future__ import annotations

import json
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


def test_a_cycle_that_would_break_a_member_is_told(tmp_path: Path) -> None:
    ended = linkwright("trajectory", study(tmp_path, 2000.0))
    assert ended.returncode == 0, ended.stderr
    assert "this cycle would break rod" in ended.stderr
    assert "below 1" in ended.stderr
    assert "Reaction on the frame" in ended.stdout
    assert "Members over the whole cycle" in ended.stdout


def test_a_required_strength_refuses_it(tmp_path: Path) -> None:
    """The robot's own load, 1 kg, would be borne everywhere; the cycle's is not."""
    ended = linkwright("trajectory", study(tmp_path, 2000.0, REQUIRED))
    assert ended.returncode == 1
    assert "strength on the cycle: found 0." in ended.stderr
