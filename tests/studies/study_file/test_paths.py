"""What a study may say of the path: sizes, places, lifts, waypoints; and what it may not."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from studies.building.load import load_study
from studies.building.objects import path_of, robot_of
from studies.errors import StudyError
from studies.stages.cycle_stage import time_cycle
from studies.study_file.toml_file import read_toml
from trajectory import AdeptCycle, RoundedPath, WaypointFileError

HEAD = """\
title = "t"
mechanism = "{mechanism}"
[region]
kind = "box"
{region}
[trajectory]
law = "toppra"
[trajectory.limits]
speed = 20
torque = 127
"""
SCHOENFLIES = "x = [-0.4, 0.4]\ny = [-0.4, 0.4]\nz = [-0.85, -0.6]\ntheta_deg = [-180, 180]"
SIX = "x = [-0.1, 0.1]\ny = [-0.1, 0.1]\nz = [0.5, 0.7]\nroll = [-0.2, 0.2]\npitch = [-0.2, 0.2]\nyaw = [-0.2, 0.2]"
PLANE = "x = [-0.1, 0.1]\ny = [-0.1, 0.1]\ntheta = [-0.2, 0.2]"
HELI4, HEXAPOD, PLANAR = ("Heli4", SCHOENFLIES), ("GoughStewart", SIX), ("Planar3RRR", PLANE)
CYCLE = "[trajectory.cycle]\nblend_mm = 20\npick = [-0.15, 0.0, -0.8]\npayload = 1.0\n"
ROWS = """\
[trajectory.path]
payload = 1.0
[[trajectory.path.waypoint]]
x_mm = 0
y = 0.0
z = -0.8
theta = 0
[[trajectory.path.waypoint]]
x = 0.0
y = 0.0
z = -0.7
blend_mm = 30
[[trajectory.path.waypoint]]
x = 0.1
y = 0.0
z = -0.7
theta_deg = 90
"""


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real ones here."""


def written(folder: Path, text: str, kind: tuple[str, str] = HELI4) -> Path:
    file = folder / "study.toml"
    file.write_text(HEAD.format(mechanism=kind[0], region=kind[1]) + text)
    return file


def path_in(folder: Path, text: str, kind: tuple[str, str] = HELI4) -> AdeptCycle | RoundedPath:
    study = load_study(read_toml(written(folder, text, kind)))
    assert study.trajectory is not None
    names = tuple(study.region.coordinates)
    return path_of(study.trajectory, names)  # type: ignore[return-value]


def test_a_standard_size_gives_lift_span_and_place_lift(tmp_path: Path) -> None:
    path = path_in(tmp_path, CYCLE + 'size = "25/300/25"\nturn_deg = 180\nstart_angle_deg = -90\n')
    assert path == AdeptCycle.of_size("25/300/25", blend=0.02, pick=(-0.15, 0.0, -0.8), start_angle=-math.pi / 2)


def test_pick_and_place_with_lifts_of_their_own(tmp_path: Path) -> None:
    path = path_in(tmp_path, CYCLE + "place = [0.1, 0.2, -0.75]\nlift_mm = 80\nplace_lift_mm = 40\n")
    places = path.evaluate(np.array([0.0, path.length]), 0)[0][:, :3]
    assert places == pytest.approx(np.array([[-0.15, 0.0, -0.8], [0.1, 0.2, -0.75]]), abs=1e-15)
    assert isinstance(path, AdeptCycle)
    assert (path.lift, path.place_lift) == (0.08, 0.04)


@pytest.mark.long
def test_the_payload_back_is_that_of_the_way_back_alone(tmp_path: Path) -> None:
    study = load_study(read_toml(written(tmp_path, CYCLE + 'size = "25/305/25"\npayload_back = 0.0\n')))
    assert study.trajectory is not None
    cycle = time_cycle(study, robot_of(study)).cycle
    assert [{p.payload for p in way} for way in (cycle.there, cycle.back)] == [{1.0}, {0.0}]
    there, back = (sum(p.duration for p in way) for way in (cycle.there, cycle.back))
    assert back < 0.97 * there  # less to accelerate, with the same drives


def test_a_hexapod_tilts_and_turns_by_yaw(tmp_path: Path) -> None:
    text = CYCLE.replace("-0.8", "0.6") + "lift_mm = 25\nspan_mm = 150\ntilt_deg = [5, -3]\nturn_deg = 10\n"
    path = path_in(tmp_path, text, HEXAPOD)
    (end,) = path.evaluate(np.array(path.length), 0)
    assert end[3:] == pytest.approx(np.radians([5, -3, 10]), abs=1e-15)


def test_waypoints_stand_in_the_study_or_in_a_file_beside_it(tmp_path: Path) -> None:
    inline = path_in(tmp_path, ROWS)
    (tmp_path / "way.csv").write_text("x,y,z,theta_deg,blend\n0,0,-0.8,0,\n0,0,-0.7,,0.03\n0.1,0,-0.7,90,\n")
    from_file = path_in(tmp_path, '[trajectory.path]\nfile = "way.csv"\npayload = 1.0\n')
    assert inline == from_file
    assert isinstance(inline, RoundedPath)
    assert inline.blends == (0.03,)


def test_the_waypoints_belong_to_the_digest(tmp_path: Path) -> None:
    digests = []
    for height in (-0.7, -0.71):
        (tmp_path / "way.csv").write_text(f"x,y,z,theta\n0,0,-0.8,0\n0,0,{height},1\n")
        study = load_study(read_toml(written(tmp_path, '[trajectory.path]\nfile = "way.csv"\npayload = 1.0\n')))
        digests.append(study.digest)
    assert digests[0] != digests[1]


def test_a_study_s_waypoints_are_timed_with_a_stop_at_the_corner_without_a_blend(tmp_path: Path) -> None:
    study = load_study(read_toml(written(tmp_path, ROWS.replace("blend_mm = 30\n", ""))))
    assert study.trajectory is not None
    timing = time_cycle(study, robot_of(study))
    assert [len(way) for way in (timing.cycle.there, timing.cycle.back)] == [2, 2]
    figures = timing.figures()
    assert figures["half_cycle"] == sum(piece.duration for piece in timing.cycle.there)
    assert 0.99 < figures["peak_over_limit"]["torque"] <= 1.0
    assert timing.setpoints.pose[0] == pytest.approx(timing.setpoints.pose[-1], abs=1e-9)
    assert timing.setpoints.header["path blends"] == [0.0]


def test_a_way_that_ends_where_it_starts_is_a_closed_cycle_and_no_half(tmp_path: Path) -> None:
    corners = ((-0.05, -0.8), (0.05, -0.8), (-0.05, -0.8))
    rows = "".join(f"[[trajectory.path.waypoint]]\nx = {x}\ny = 0\nz = {z}\ntheta = 0\n" for x, z in corners)
    study = load_study(read_toml(written(tmp_path, f"[trajectory.path]\npayload = 1.0\n{rows}")))
    timing = time_cycle(study, robot_of(study))
    figures = timing.figures()
    assert "half_cycle" not in figures
    assert figures["closed_cycle"] == sum(piece.duration for piece in timing.cycle.pieces)


@pytest.mark.parametrize(
    ("text", "kind", "key", "expected"),
    [
        (CYCLE + 'size = "30/305/30"\n', HELI4, "cycle.size", "25/305/25, 25/300/25, 25/700/25"),
        (CYCLE + 'size = "25/305/25"\nlift_mm = 25\n', HELI4, "cycle.lift_mm", "or a size instead"),
        (CYCLE + 'size = "25/305/25"\nplace = [0, 0, 0]\n', HELI4, "cycle.place", "not with a size"),
        (CYCLE + "span_mm = 100\n", HELI4, "cycle.lift", "a length > 0"),
        (
            CYCLE.replace("= 1.0", "= [1.0, 0.0]"),
            HELI4,
            "cycle.payload",
            "payload_back may give another for the way back",
        ),
        (CYCLE + "lift_mm = 25\n", HELI4, "cycle.span", "a size or a place"),
        (CYCLE + "lift_mm = 25\nspan = 0.1\nplace = [0, 0, -0.8]\n", HELI4, "cycle.span", "a size or a place instead"),
        (
            CYCLE + "lift_mm = 25\nplace = [-0.15, 0, -0.7]\n",
            HELI4,
            "cycle.place",
            "not straight above or below the pick",
        ),
        (CYCLE + "lift_mm = 25\nplace = [0, 0, -0.8]\nheading = 1\n", HELI4, "cycle.heading", "not with a place"),
        (CYCLE + "lift_mm = 25\nspan_mm = 100\nplace_lift_mm = 19\n", HELI4, "cycle.blend_mm", "at most the lift"),
        (CYCLE + "lift_mm = 25\nspan_mm = 100\ntilt_deg = [1, 2]\n", HELI4, "cycle.tilt_deg", "one of"),
        (CYCLE + "lift_mm = 25\nspan_mm = 100\n", PLANAR, "trajectory.cycle", "one of"),
        ("", HELI4, "trajectory.path", "or [trajectory.cycle] instead"),
        ("", PLANAR, "trajectory.path", "file, waypoint, payload"),
        (
            CYCLE + 'size = "25/305/25"\n' + ROWS,
            HELI4,
            "trajectory.path",
            "only one of this table and [trajectory.cycle]",
        ),
        ("[trajectory.path]\npayload = 1.0\n", HELI4, "trajectory.path", "either a file or waypoints"),
        (
            "[[trajectory.path.waypoint]]".join(ROWS.split("[[trajectory.path.waypoint]]")[:2]),
            HELI4,
            "path.waypoint",
            "two or more",
        ),
        (ROWS.replace("payload", 'file = "a.csv"\npayload'), HELI4, "trajectory.path", "either a file or waypoints"),
        (ROWS.replace("blend_mm = 30", "blend_mm = 101"), HELI4, "path.waypoint", "0.1 m"),
        (ROWS.replace("blend_mm = 30", "blend_mm = -1"), HELI4, "path.waypoint.blend_mm", "a length >= 0"),
        (ROWS.replace("y = 0.0\nz = -0.7\nblend", "z = -0.7\nblend"), HELI4, "path.waypoint", "a finite number"),
        (ROWS.replace("theta = 0", "phi = 0"), HELI4, "path.waypoint.phi", "theta"),
    ],
)
def test_a_fault_is_told_with_its_key(
    tmp_path: Path, text: str, kind: tuple[str, str], key: str, expected: str
) -> None:
    with pytest.raises(StudyError) as caught:
        load_study(read_toml(written(tmp_path, text, kind)))
    problems = [p for p in caught.value.faults if key in p.key]
    assert problems, str(caught.value)
    assert expected in problems[0].expected
    assert problems[0].line is not None


def test_what_the_geometry_as_a_whole_refuses_is_told_at_its_key(tmp_path: Path) -> None:
    region = "".join(f"{name} = 0\n" for name in ("x", "y", "z", "roll", "pitch", "yaw"))
    frame = "[[2, 0, 0, 0], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]"
    text = f'title = "-"\nmechanism = "GoughStewart"\n[geometry]\nE = {frame}\n[region]\nkind = "box"\n{region}'
    (tmp_path / "study.toml").write_text(text)
    with pytest.raises(StudyError, match=r"study\.toml:4: geometry\.E: found .* expected a rotation and a translation"):
        load_study(read_toml(tmp_path / "study.toml"))


@pytest.mark.parametrize(
    ("name", "found"), [("none.csv", "which does not exist"), ("study.toml", "which is no CSV file")]
)
def test_a_file_of_waypoints_that_cannot_be_is_told_at_its_key(tmp_path: Path, name: str, found: str) -> None:
    with pytest.raises(StudyError, match=rf'trajectory\.path\.file: found "{name}", {found}; expected a \.csv file'):
        load_study(read_toml(written(tmp_path, f'[trajectory.path]\nfile = "{name}"\npayload = 1.0\n')))


def test_a_blend_that_does_not_fit_is_told_as_the_study_spells_it(tmp_path: Path) -> None:
    with pytest.raises(StudyError, match=r"path\.waypoint: found blend_mm = 101; expected"):
        load_study(read_toml(written(tmp_path, ROWS.replace("blend_mm = 30", "blend_mm = 101"))))


def test_an_unknown_mechanism_is_told_without_faults_in_its_waypoints(tmp_path: Path) -> None:
    with pytest.raises(StudyError) as caught:
        load_study(read_toml(written(tmp_path, ROWS, ("Heli5", SCHOENFLIES))))
    assert [p.key for p in caught.value.faults] == ["mechanism"]


def test_a_fault_in_the_file_of_waypoints_is_told_with_line_and_column(tmp_path: Path) -> None:
    (tmp_path / "way.csv").write_text("x,y,z,theta\n0,0,-0.8,0\n0,0,nan,1\n")
    with pytest.raises(WaypointFileError, match=r"way.csv, line 3, column z: found nan"):
        load_study(read_toml(written(tmp_path, '[trajectory.path]\nfile = "way.csv"\npayload = 1.0\n')))
