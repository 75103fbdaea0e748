"""Set-points close the cycle in whole periods, and their file brings back exactly what was written."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kinematics import Heli4, InvalidShape, InvalidValue, inverse_dynamics
from trajectory import (
    AdeptCycle,
    CannotWrite,
    Cycle,
    Limits,
    LimitsExceeded,
    SetpointFileError,
    Setpoints,
    cycle_setpoints,
    read_setpoints,
    there_and_back,
    time_optimal,
    write_setpoints,
)

PERIOD = 1e-3
UNITS = ("rad",) * 4


@pytest.fixture(scope="module")
def setpoints(cycle: Cycle) -> Setpoints:
    return cycle_setpoints(cycle, PERIOD, UNITS)


@pytest.fixture
def file(tmp_path: Path, setpoints: Setpoints) -> Path:
    write_setpoints(tmp_path / "cycle.csv", setpoints)
    return tmp_path / "cycle.csv"


def test_there_and_back_takes_twice_the_half_cycle(cycle: Cycle) -> None:
    assert cycle.duration == pytest.approx(2 * cycle.pieces[0].duration, rel=1e-5)


def test_each_way_is_the_next_whole_number_of_periods(cycle: Cycle, setpoints: Setpoints) -> None:
    whole = cycle.stretched_to(PERIOD)
    assert setpoints.header["periods"] == [128, 128]
    assert whole.duration == pytest.approx(0.256, rel=1e-12)
    assert all(piece.timed.factor >= 1 and piece.timed.verification.ok for piece in whole.pieces)
    assert [piece.timed.verification.duration for piece in whole.pieces] == pytest.approx([0.128, 0.128])
    assert np.abs(np.diff(setpoints.time) - PERIOD).max() < 1e-15


def test_a_whole_number_of_periods_is_left_as_it_is(cycle: Cycle) -> None:
    once = cycle.stretched_to(PERIOD)
    assert once.stretched_to(PERIOD).duration == pytest.approx(once.duration, rel=1e-14)


def test_pick_and_place_are_set_points_at_rest(setpoints: Setpoints, path: AdeptCycle) -> None:
    pick, place = path.evaluate(np.array([0.0, path.length]), 0)[0]
    for row, pose in ((0, pick), (128, place), (256, pick)):
        assert np.abs(setpoints.pose[row] - pose).max() < 1e-12
        assert np.abs(setpoints.speed[row]).max() < 1e-10


def test_joints_belong_to_the_poses_and_torques_to_the_motion(robot: Heli4, setpoints: Setpoints) -> None:
    setpoints.require_consistent(robot)
    assert np.abs(robot.inverse(setpoints.pose) - setpoints.joints).max() < 1e-12
    rest = np.zeros((1, 4))
    weight = inverse_dynamics(robot, 1.0, setpoints.pose[:1], rest, rest)
    assert np.abs(weight).max() < np.abs(setpoints.torque[0]).max() <= 127.0


def test_speeds_are_the_slopes_of_the_joints(cycle: Cycle) -> None:
    fine = cycle_setpoints(cycle, 1e-5, UNITS)
    slope = (fine.joints[2:] - fine.joints[:-2]) / 2e-5
    assert np.abs(slope - fine.speed[1:-1]).max() < 1e-3 * np.abs(fine.speed).max()
    error = np.diff(fine.joints, axis=0) - (fine.speed[1:] + fine.speed[:-1]) * 0.5e-5
    assert np.abs(error).max() < 1e-8


def test_a_lighter_way_back_is_faster(robot: Heli4, path: AdeptCycle, limits: Limits) -> None:
    cycle = there_and_back(robot, path, limits, 1.0, time_optimal, payload_back=0.0)
    there, back = (piece.duration for piece in cycle.pieces)
    assert back < 0.97 * there
    assert cycle_setpoints(cycle, PERIOD, UNITS).header["payloads [kg]"] == [1.0, 0.0]


def test_a_stretched_cycle_is_verified_again(cycle: Cycle) -> None:
    tighter = replace(cycle, limits=replace(cycle.limits, torque=120.0))
    with pytest.raises(LimitsExceeded):
        cycle_setpoints(tighter, PERIOD, UNITS)


@pytest.mark.parametrize("period", [0.0, -1e-3, math.nan, math.inf])
def test_an_impossible_period_is_refused(cycle: Cycle, period: float) -> None:
    with pytest.raises(InvalidValue, match="period"):
        cycle_setpoints(cycle, period, UNITS)


@pytest.mark.parametrize("units", [("rad",) * 3, ("deg",) * 4])
def test_impossible_units_are_refused(cycle: Cycle, units: tuple[str, ...]) -> None:
    with pytest.raises(InvalidValue, match="joint_units"):
        cycle_setpoints(cycle, PERIOD, units)


def test_sliding_joints_have_metres_and_newtons(setpoints: Setpoints) -> None:
    units = replace(setpoints, joint_units=("m", "rad", "m", "rad")).units
    assert units[5:7] == ("m", "rad")
    assert units[9:11] == ("m/s", "rad/s")
    assert units[-4:] == ("N", "N m", "N", "N m")


def test_arrays_that_do_not_fit_are_refused(setpoints: Setpoints) -> None:
    with pytest.raises(InvalidShape, match="torque"):
        replace(setpoints, torque=setpoints.torque[:, :3])


def test_the_file_brings_back_exactly_what_was_written(file: Path, setpoints: Setpoints) -> None:
    back = read_setpoints(file)
    assert np.array_equal(back.table(), setpoints.table())
    assert back.header == setpoints.header
    assert (back.joint_names, back.joint_units) == (setpoints.joint_names, setpoints.joint_units)
    write_setpoints(file.with_name("again.csv"), back)
    assert file.with_name("again.csv").read_bytes() == file.read_bytes()


def test_the_header_says_what_the_set_points_are_for(file: Path, robot: Heli4, cycle: Cycle) -> None:
    header = read_setpoints(file).header
    assert header["mechanism"] == "Heli4"
    assert header["geometry hash"] == robot.geometry.digest
    assert header["payloads [kg]"] == [1.0, 1.0]
    assert (header["limit speed"], header["limit torque"]) == (20.0, 127.0)
    assert [header[f"path {name}"] for name in ("blend", "lift", "span", "turn")] == [0.0249, 0.025, 0.305, math.pi]
    assert header["period [s]"] == PERIOD
    assert header["cycle time before stretching [s]"] == cycle.duration
    assert header["cycle time after stretching [s]"] == pytest.approx(0.256)
    assumptions = " ".join(header["assumptions"])
    assert "assumed drive set" in assumptions
    assert "rod_middle" in assumptions
    assert header["inertia"]["rod_middle"] == 0.0
    assert header["inertia"]["drive_train"]["coulomb"] == header["inertia"]["drive_train"]["viscous"] == 0.0
    assert header["joint ranges"] == {"joints": [0.0, 3.8], "passive": [1.0, 1.0]}
    lines = file.read_text().splitlines()
    above = next(k for k, line in enumerate(lines) if not line.startswith("#"))
    assert all(line.startswith("# ") for line in lines[:above])
    assert len(lines) == above + 1 + 257
    units = next(line for line in lines if line.startswith("# units: "))
    assert units.count('"') // 2 == len(lines[above].split(","))


@pytest.mark.parametrize("step", ["replace", "chmod"])
def test_a_file_survives_a_failing_write(
    file: Path, setpoints: Setpoints, step: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = file.read_bytes()

    def fail(*_: object) -> None:
        raise OSError("disk full")

    monkeypatch.setattr(os, step, fail)
    with pytest.raises(CannotWrite, match="disk full"):
        write_setpoints(file, replace(setpoints, time=setpoints.time * 2))
    assert file.read_bytes() == before
    assert list(file.parent.iterdir()) == [file]


def test_a_number_that_is_not_finite_is_not_written(tmp_path: Path, setpoints: Setpoints) -> None:
    torque = setpoints.torque.copy()
    torque[3, 2] = np.nan
    with pytest.raises(InvalidValue, match="set-point 3, q3_torque"):
        write_setpoints(tmp_path / "cycle.csv", replace(setpoints, torque=torque))
    assert list(tmp_path.iterdir()) == []


def test_a_header_that_is_not_finite_is_not_written(tmp_path: Path, setpoints: Setpoints) -> None:
    with pytest.raises(ValueError, match="JSON"):
        write_setpoints(tmp_path / "cycle.csv", replace(setpoints, header={**setpoints.header, "note": math.inf}))
    assert list(tmp_path.iterdir()) == []


def test_swapped_joints_are_caught_by_the_loop_closure(robot: Heli4, setpoints: Setpoints) -> None:
    with pytest.raises(InvalidValue, match="loop closure of set-point"):
        replace(setpoints, joints=setpoints.joints[:, [1, 0, 2, 3]]).require_consistent(robot)
    with pytest.raises(InvalidValue, match="loop closure"):
        replace(setpoints, pose=setpoints.pose[:, [1, 0, 2, 3]]).require_consistent(robot)
    joints = setpoints.joints.copy()
    joints[5, 1] = np.nan
    with pytest.raises(InvalidValue, match="set-point 5, limb 2"):
        replace(setpoints, joints=joints).require_consistent(robot)


def test_set_points_of_another_geometry_are_refused(setpoints: Setpoints) -> None:
    with pytest.raises(InvalidValue, match="geometry"):
        setpoints.require_consistent(Heli4(Heli4.Geometry(rod_length=0.81)))


def first_row(lines: list[str]) -> int:
    return next(k for k, line in enumerate(lines) if not line.startswith("#")) + 1


def edited(lines: list[str], change: str) -> list[str]:
    row = first_row(lines)
    at = {line.split(":")[0]: k for k, line in enumerate(lines[: row - 1])}
    if change == "empty":
        return []
    if change == "cut off":
        return lines[:-1]
    if change == "only a header":
        return lines[: row - 1]
    if change == "no rows":
        return lines[:row]
    replaced = {
        "format": (0, "# set-points of someone else"),
        "columns": (row - 1, lines[row - 1].replace("q1,q2", "q2,q1")),
        "a cell less": (row + 4, lines[row + 4].rpartition(",")[0]),
        "a word": (row + 4, "fast" + lines[row + 4]),
        "nan": (row + 4, "nan," + lines[row + 4].partition(",")[2]),
        "a time off": (row + 4, "0.0041," + lines[row + 4].partition(",")[2]),
        "not JSON": (at["# laws"], "# laws: toppra"),
        "no colon": (at["# laws"], "# laws"),
        "twice": (at["# laws"], lines[at["# mechanism"]]),
        "no period": (at["# period [s]"], "# a period: 0.001"),
        "a word for a period": (at["# period [s]"], '# period [s]: "1 ms"'),
        "other periods": (at["# periods"], "# periods: [128, 127]"),
        "no list of periods": (at["# periods"], "# periods: 256"),
        "few units": (at["# units"], '# units: ["s"]'),
        "other units": (at["# units"], lines[at["# units"]].replace("N m", "N")),
    }[change]
    return [replaced[1] if k == replaced[0] else line for k, line in enumerate(lines)]


@pytest.mark.parametrize(
    "change",
    [
        "empty",
        "cut off",
        "only a header",
        "no rows",
        "format",
        "columns",
        "a cell less",
        "a word",
        "nan",
        "a time off",
        "not JSON",
        "no colon",
        "twice",
        "no period",
        "a word for a period",
        "other periods",
        "no list of periods",
        "few units",
        "other units",
    ],
)
def test_a_file_that_was_tampered_with_is_refused(file: Path, change: str) -> None:
    lines = file.read_text().splitlines()
    file.write_text("".join(f"{line}\n" for line in edited(lines, change)))
    with pytest.raises(SetpointFileError) as caught:
        read_setpoints(file)
    assert str(file) in str(caught.value)
    assert caught.value.line >= 1


def test_a_bad_row_is_named_by_its_line(file: Path) -> None:
    lines = file.read_text().splitlines()
    file.write_text("\n".join(edited(lines, "a word")))
    with pytest.raises(SetpointFileError) as caught:
        read_setpoints(file)
    assert caught.value.line == first_row(lines) + 5


def test_a_binary_file_is_refused(file: Path) -> None:
    file.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SetpointFileError, match="UTF-8"):
        read_setpoints(file)
