"""`linkwright map` as a user meets it: what it prints, what it writes, what it refuses."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from design import Box, Cylinder
from kinematics import Heli4, Redundant3T1R
from studies.building.load import load_study
from studies.cli.map_console import print_map
from studies.results.output_folder import Written
from studies.stages.map_options import InvalidOption, MapRequest, map_request
from studies.stages.map_stage import run_map
from studies.study_file.locate import study_path
from studies.study_file.toml_file import read_toml
from tests.studies.command_line import linkwright

CORNER = ("--over", "y_mm=200:300", "--over", "z=0.3:0.6")


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def redundant(**options: Any) -> MapRequest:
    return map_request(load_study(read_toml(study_path("redundant_3t1r"))), Redundant3T1R(), **options)


def heli(**options: Any) -> MapRequest:
    return map_request(load_study(read_toml(study_path("heli4"))), Heli4(), **options)


def test_picture_numbers_and_json_tell_the_same(tmp_path: Path) -> None:
    done = linkwright("map", "redundant_3t1r", *CORNER, "--at", "theta_deg=0", "--out", tmp_path, "--json")
    assert done.returncode == 0, done.stderr
    data = json.loads(done.stdout)
    assert (data["index"], data["bound"], data["worst_over"]) == ("fvi", 1.0, [])
    picture, nodes, edge = (tmp_path / f"map_fvi_y_z{end}" for end in (".png", ".csv", "_boundary.csv"))
    assert sorted(data["files"]) == sorted(map(str, (picture, nodes, edge)))
    assert picture.read_bytes().startswith(b"\x89PNG")
    lines = nodes.read_text().splitlines()
    header = dict(line[2:].split(": ", 1) for line in lines if line.startswith("#"))
    assert json.loads(header["geometry_hash"]) == Redundant3T1R().geometry.digest
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert len(rows) == math.prod(data["nodes"])
    poses = np.array([[float(row[f"worst {c}"]) for c in ("x [m]", "y [m]", "z [m]", "theta [rad]")] for row in rows])
    values = np.array([float(row["fvi"]) for row in rows])
    assert np.allclose(Redundant3T1R().fvi(poses), values, rtol=1e-6)
    ring = np.loadtxt([line for line in edge.read_text().splitlines() if line[0].isdigit()], delimiter=",")[:, 1:]
    x, y = ring.T
    assert abs(0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) - data["area"]) < 1e-3 * data["area"]
    assert np.allclose(data["boundary"][0], ring)


def test_the_proved_part_is_printed_beside_the_sampled_one(tmp_path: Path) -> None:
    box = ("--over", "y=0:0.1", "--over", "z=0:0.1", "--over", "theta_deg=-20:20")
    done = linkwright("map", "redundant_3t1r", *box, "--certified", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "Proved: fvi >= 1" in done.stdout
    assert "0.01, 100.0 % of the sampled" in done.stdout


def test_defaults_come_from_the_study() -> None:
    asked = redundant()
    assert asked.section.axes == ("y", "z")
    assert (asked.index.name, asked.bound) == ("fvi", 1.0)
    assert redundant(margin="clearance").bound == 0.005
    assert redundant(margin="v_w").bound is None
    assert heli().section.axes == ("x", "y")
    assert heli(at=("z=-0.7",)).section.axes == ("x", "y")
    assert heli().fvi_bounds.force == 150.0
    assert heli(section="z, theta").section.axes == ("z", "theta")


def test_a_length_in_millimetres_is_the_very_number_in_metres() -> None:
    for mm, m in (("41.3", 0.0413), ("24.9", 0.0249), ("305.7", 0.3057)):
        assert redundant(at=(f"z_mm={mm}",), section="y,theta", over=("z=0:1",)).section.at["z"] == (m,)
        assert redundant(over=(f"z_mm=0:{mm}",)).section.region.intervals["z"] == (0.0, m)


@pytest.mark.long
def test_figures_that_still_move_are_printed_with_how_far(tmp_path: Path) -> None:
    corner = ("--over", "y_mm=200:300", "--over", "z=0.3:0.6", "--at", "theta_deg=0")
    done = linkwright("map", "redundant_3t1r", *corner, "--tolerance", 1e-12, "--seconds", 4, "--out", tmp_path)
    assert done.returncode == 1, done.stderr
    assert "not settled" in done.stdout
    assert "changed the figures by" in " ".join(done.stdout.split())
    assert "area" in done.stdout
    assert len(list(tmp_path.glob("map_*"))) == 3


def test_other_bounds_and_units() -> None:
    region = redundant(over=("theta_deg=-45:45", "z_mm=0:500")).section.region
    assert isinstance(region, Box)
    assert np.allclose(region.intervals["theta"], (-math.pi / 4, math.pi / 4))
    assert np.allclose(region.intervals["z"], (0.0, 0.5))
    assert region.intervals["y"] == (-0.28, 0.28)
    cylinder = heli(over=("radius_mm=250", "z=-0.75:-0.65")).section.region
    assert isinstance(cylinder, Cylinder)
    assert (cylinder.radius, cylinder.intervals["z"]) == (0.25, (-0.75, -0.65))
    assert np.allclose(redundant(at=("theta_deg=-90,0,45",)).section.at["theta"], np.deg2rad([-90, 0, 45]))


@pytest.mark.parametrize(
    ("options", "option", "words"),
    [
        ({"margin": "speed"}, "--margin", "inverse_condition_number"),
        ({"section": "y,y"}, "--section", "two different"),
        ({"section": "y"}, "--section", "two coordinates"),
        ({"section": "y,q"}, "--section", "one of x, y, z, theta"),
        ({"section": "x,y"}, "--section", "vary"),
        ({"at": ("theta_mm=1",)}, "--at", r"theta\[_deg\]"),
        ({"at": ("theta",)}, "--at", "NAME=VALUE"),
        ({"at": ("theta=up",)}, "--at", "numbers with ','"),
        ({"at": ("theta=inf",)}, "--at", "finite"),
        ({"at": ("theta=0", "theta_deg=10")}, "--at", "once"),
        ({"at": ("theta_deg=100",)}, "--at", "in the region"),
        ({"section": "y,z", "at": ("y=0",)}, "--at", "one of x, theta"),
        ({"over": ("z=1",)}, "--over", "LOW:HIGH"),
        ({"over": ("z=1:0",)}, "--over", "lower first"),
        ({"over": ("radius=1",)}, "--over", "NAME=VALUE"),
        ({"at_least": math.nan}, "--at-least", "finite"),
    ],
)
def test_an_option_that_cannot_be_used_is_named(options: dict[str, Any], option: str, words: str) -> None:
    with pytest.raises(InvalidOption, match=words) as raised:
        redundant(**options)
    assert raised.value.option == option
    assert raised.value.exit_status == 2


@pytest.mark.parametrize(
    "asked",
    [
        lambda: redundant(margin="J_q"),
        lambda: redundant(at=("theta_deg=0,10",)),
        lambda: heli(section="z,theta", at=("x=0.1",)),
        lambda: heli(over=("radius=-1",)),
    ],
)
def test_what_cannot_be_proved_is_refused_before_anything_runs(asked: Any) -> None:
    with pytest.raises(InvalidOption):
        run_map(asked(), 1e-3, True, lambda _: pytest.fail("ran"))


def test_where_no_node_keeps_the_bound_the_grid_s_step_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    print_map(run_map(redundant(at=("theta=0",), at_least=99.0), 1e-3, False, lambda _: None), Written(), False)
    assert "no node keeps the bound; the nodes are 0.0011 m and 0.0011 m apart" in " ".join(
        capsys.readouterr().out.split()
    )


def test_a_bad_option_exits_with_2_and_writes_nothing(tmp_path: Path) -> None:
    done = linkwright("map", "redundant_3t1r", "--tolerance", 0, "--out", tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "linkwright: --tolerance: found 0.0; expected a finite number > 0\n"
    assert list(tmp_path.iterdir()) == []
