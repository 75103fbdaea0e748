"""Each format brings the set-points back, by a reader that shares no code with its writer."""

from __future__ import annotations

import json
import math
import struct
from dataclasses import replace
from pathlib import Path

import canopen
import numpy as np
import pytest
import yaml
from canopen.objectdictionary import INTEGER8, INTEGER32, UNSIGNED8, UNSIGNED32, ODRecord, ODVariable
from rosbags.highlevel import AnyReader
from zaber_motion import Units
from zaber_motion.ascii import PvtSequence

from kinematics import InvalidValue
from trajectory import Cycle, Setpoints, cycle_setpoints, write_files
from trajectory.drive_files.cia402 import interpolation_time
from trajectory.drive_files.drive import Drive
from trajectory.drive_files.formats import FORMATS, drive_files

PERIOD = 1e-3
DRIVE = Drive(increments=2**20, encoder_gear=9.0)
ROUNDED = 0.5e-9 + 1e-12  # of the text formats, in degrees or millimetres; and double arithmetic on thousands of them


@pytest.fixture(scope="module")
def turning(cycle: Cycle) -> Setpoints:
    return cycle_setpoints(cycle, PERIOD, ("rad",) * 4)


@pytest.fixture(scope="module", params=["turning", "mixed"])
def setpoints(request: pytest.FixtureRequest, turning: Setpoints) -> Setpoints:
    """The same numbers as angles, and with the first and third axis as rails."""
    return replace(turning, joint_units=("m", "rad", "m", "rad")) if request.param == "mixed" else turning


def one(setpoints: Setpoints, name: str, drive: Drive = DRIVE) -> str:
    """The text of a format's first file."""
    content = next(iter(drive_files("cycle", setpoints, [name], drive).values()))
    assert isinstance(content, str)
    return content


def in_format_units(setpoints: Setpoints, values: np.ndarray) -> np.ndarray:
    return np.column_stack(
        [np.degrees(v) if unit == "rad" else 1000 * v for v, unit in zip(values.T, setpoints.joint_units, strict=True)]
    )


# ROS 2


def bag_message(setpoints: Setpoints, folder: Path, drive: Drive = DRIVE) -> tuple[str, object]:
    write_files(folder, drive_files("cycle", setpoints, ["ros2"], drive))
    with AnyReader([folder / "cycle.ros2.mcap"]) as reader:
        ((connection, _, raw),) = reader.messages()
        return connection.msgtype, reader.deserialize(raw, connection.msgtype)


def test_ros_bag_brings_back_every_number_and_nanosecond(setpoints: Setpoints, tmp_path: Path) -> None:
    kind, message = bag_message(setpoints, tmp_path)
    assert kind == "trajectory_msgs/msg/JointTrajectory"
    assert message.joint_names == list(setpoints.joint_names)
    for field, expected in {
        "positions": setpoints.joints,
        "velocities": setpoints.speed,
        "accelerations": setpoints.acceleration,
    }.items():
        assert np.array_equal([getattr(p, field) for p in message.points], expected)
    assert all(p.effort.size == 0 for p in message.points)
    times = [p.time_from_start.sec * 10**9 + p.time_from_start.nanosec for p in message.points]
    assert times == [k * 10**6 for k in range(len(setpoints.time))]


def test_ros_yaml_says_the_same_as_the_bag(setpoints: Setpoints, tmp_path: Path) -> None:
    _, message = bag_message(setpoints, tmp_path)
    text = yaml.safe_load((tmp_path / "cycle.ros2.yaml").read_text())
    assert text["joint_names"] == message.joint_names
    assert text["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    for found, point in zip(text["points"], message.points, strict=True):
        for field in ("positions", "velocities", "accelerations", "effort"):
            assert all(type(v) is float for v in found[field])
            assert found[field] == getattr(point, field).tolist()
        stamp = point.time_from_start
        assert found["time_from_start"] == {"sec": stamp.sec, "nanosec": stamp.nanosec}


def test_ros_times_stay_exact_over_the_second(turning: Setpoints, tmp_path: Path) -> None:
    header = {**turning.header, "period [s]": 0.0077}
    _, message = bag_message(replace(turning, header=header), tmp_path)
    last = message.points[-1].time_from_start
    assert (last.sec, last.nanosec) == divmod(256 * 7_700_000, 10**9)


def test_a_period_that_is_no_whole_nanosecond_is_refused(turning: Setpoints) -> None:
    with pytest.raises(InvalidValue, match="nanoseconds"):
        drive_files("cycle", replace(turning, header={**turning.header, "period [s]": 1 / 1024}), ["ros2"])


# CiA 402


def read_increments(text: str) -> tuple[dict[str, object], list[str], np.ndarray]:
    lines = text.splitlines()
    header = dict(line[2:].split(": ", 1) for line in lines if line.startswith("#"))
    rows = [line for line in lines if not line.startswith("#")]
    table = np.array([[int(cell) for cell in row.split(",")] for row in rows[1:]])
    return {name: json.loads(value) for name, value in header.items()}, rows[0].split(","), table


def csp_pdo() -> tuple[canopen.ObjectDictionary, canopen.pdo.base.PdoMap]:
    """Two CSP axes behind one receive PDO, their objects 0x800 apart (CiA 402-1, multiple-axis devices)."""
    dictionary = canopen.ObjectDictionary()
    for index in (0x607A, 0x687A):
        target = ODVariable(f"target position {index:X}", index)
        target.data_type = INTEGER32
        dictionary.add_object(target)
    records = {
        0x60C2: {1: UNSIGNED8, 2: INTEGER8},
        0x1400: {0: UNSIGNED8, 1: UNSIGNED32, 2: UNSIGNED8},
        0x1600: {0: UNSIGNED8, 1: UNSIGNED32, 2: UNSIGNED32},
    }
    for index, members in records.items():
        record = ODRecord(f"{index:X}", index)
        for subindex, kind in members.items():
            member = ODVariable(f"{index:X} {subindex}", index, subindex)
            member.data_type = kind
            record.add_member(member)
        dictionary.add_object(record)
    pdo = canopen.RemoteNode(1, dictionary).rpdo[1]
    for index in (0x607A, 0x687A):
        pdo.add_variable(index)
    return dictionary, pdo


def test_increments_pass_through_a_drive_s_process_data(setpoints: Setpoints) -> None:
    header, columns, table = read_increments(one(setpoints, "cia402"))
    assert columns == [f"{name} 0x607A" for name in setpoints.joint_names]
    assert table.shape == setpoints.joints.shape
    dictionary, pdo = csp_pdo()
    turns = np.array([2 * math.pi if unit == "rad" else 1.0 for unit in setpoints.joint_units])
    for axis in range(4):
        back = []
        for target in table[:, axis].tolist():
            pdo[0].raw, pdo[1].raw = target, -target
            assert struct.unpack("<ii", pdo.data) == (target, -target)
            back.append(pdo[0].raw)
        back = np.array(back) * turns[axis] / (9.0 * 2**20)
        rounding = header["rounding to increments [rad or m]"][axis]
        assert rounding == pytest.approx(turns[axis] / 9 / 2**21, rel=1e-12)
        assert np.abs(back - setpoints.joints[:, axis]).max() <= rounding * (1 + 1e-6)
    value, exponent = (
        dictionary[0x60C2][k].decode_raw(dictionary[0x60C2][k].encode_raw(header[f"0x60C2:0{k}"])) for k in (1, 2)
    )
    assert value * 10.0**exponent == pytest.approx(PERIOD, rel=1e-12)


def test_a_motor_that_turns_the_other_way_counts_the_other_way(turning: Setpoints) -> None:
    (*_, there), (*_, back) = (
        read_increments(one(turning, "cia402", Drive(increments=4096, encoder_gear=gear)))
        for gear in (5.0, (-5.0,) * 4)
    )
    assert np.array_equal(there, -back)


@pytest.mark.parametrize(
    ("period", "found"), [(1e-3, (1, -3)), (2e-3, (2, -3)), (2.5e-4, (25, -5)), (1.25e-4, (125, -6)), (1.0, (1, 0))]
)
def test_the_interpolation_time_is_a_byte_and_a_power_of_ten(period: float, found: tuple[int, int]) -> None:
    assert interpolation_time(period) == found


def test_a_period_that_no_byte_can_say_is_refused() -> None:
    with pytest.raises(InvalidValue, match="0x60C2"):
        interpolation_time(1.0 / 1024)


def test_an_overflow_of_32_bits_is_refused_with_its_axis(turning: Setpoints) -> None:
    with pytest.raises(InvalidValue, match="0x607A of q2, set-point"):
        one(turning, "cia402", Drive(increments=2**24, encoder_gear=(1.0, 9000.0, 1.0, 1.0)))


def test_increments_are_asked_for(turning: Setpoints) -> None:
    with pytest.raises(InvalidValue, match="increments"):
        drive_files("cycle", turning, ["cia402"])


# Position, velocity, time


def test_zaber_s_own_reader_brings_back_every_row(setpoints: Setpoints, tmp_path: Path) -> None:
    write_files(tmp_path, drive_files("cycle", setpoints, ["zaber"]))
    data = PvtSequence.load_sequence_data(str(tmp_path / "cycle.zaber.csv"))
    assert data.series_names == ["Axis 1", "Axis 2", "Axis 3", "Axis 4"]
    units = {
        "rad": (Units.ANGLE_DEGREES, Units.ANGULAR_VELOCITY_DEGREES_PER_SECOND),
        "m": (Units.LENGTH_MILLIMETRES, Units.VELOCITY_MILLIMETRES_PER_SECOND),
    }
    first = data.sequence_data[0]
    found = [(p.unit, v.unit) for p, v in zip(first.positions, first.velocities, strict=True)]
    assert found == [units[unit] for unit in setpoints.joint_units]
    times = [point.time.value for point in data.sequence_data]
    assert times == [0.0] + [PERIOD] * (len(setpoints.time) - 1)
    assert not any(point.relative for point in data.sequence_data)
    position = [[p.value for p in point.positions] for point in data.sequence_data]
    speed = [[v.value for v in point.velocities] for point in data.sequence_data]
    assert np.abs(position - in_format_units(setpoints, setpoints.joints)).max() <= ROUNDED
    assert np.abs(speed - in_format_units(setpoints, setpoints.speed)).max() <= ROUNDED


def test_xps_displacements_add_up_without_drift(setpoints: Setpoints) -> None:
    elements = np.array([[float(v) for v in line.split(",")] for line in one(setpoints, "xps").splitlines()])
    assert elements.shape == (len(setpoints.time) - 1, 1 + 2 * 4)
    assert (elements[:, 0] == PERIOD).all()
    expected = in_format_units(setpoints, setpoints.joints)
    position = expected[0] + elements[:, 1::2].cumsum(axis=0)
    assert np.abs(position - expected[1:]).max() <= 2 * ROUNDED
    assert np.abs(elements[:, 2::2] - in_format_units(setpoints, setpoints.speed)[1:]).max() <= ROUNDED
    assert np.abs(elements[-1, 2::2]).max() == 0.0


def run_pmac(text: str) -> tuple[np.ndarray, np.ndarray, list[str], dict[str, str]]:
    """A PMAC as its manual describes it: the ends of the moves (k, 1 + axes), their velocities, the axes, comments."""
    now, milliseconds, absolute, open_program = 0.0, math.nan, False, False
    times, moves, comments = [], [], {}
    for line in text.splitlines():
        code, _, comment = line.partition(";")
        if comment:
            name, _, value = comment.strip().partition(": ")
            comments[name] = value
        words = code.split()
        if words[:1] == ["OPEN"]:
            assert words == ["OPEN", "PROG", "1", "CLEAR"]
            open_program = True
        elif words == ["CLOSE"]:
            open_program = False
        elif words == ["ABS"]:
            absolute = True
        elif words and words[0].startswith("PVT"):
            milliseconds = float(words[0][3:])
        elif words:
            assert open_program
            assert absolute
            now += round(milliseconds * 4096) / 4096e3
            times.append(now)
            moves.append({word[0]: tuple(float(v) for v in word[1:].split(":")) for word in words})
    assert not open_program
    axes = list(moves[0])
    both = np.array([[move[axis] for axis in axes] for move in moves])
    return np.column_stack([times, both[..., 0]]), both[..., 1], axes, comments


@pytest.mark.parametrize("period", [PERIOD, 0.00025, 4.0])
def test_pmac_arrives_where_and_when_the_set_points_say(setpoints: Setpoints, period: float) -> None:
    slower = replace(
        setpoints, time=setpoints.time * period / PERIOD, header={**setpoints.header, "period [s]": period}
    )
    arrived, speed, axes, comments = run_pmac(one(slower, "pmac"))
    assert axes == ["X", "Y", "Z", "A"]
    assert np.abs(arrived[:, 0] - slower.time[1:]).max() < 1e-9
    assert np.abs(arrived[:, 1:] - in_format_units(slower, slower.joints)[1:]).max() <= ROUNDED
    assert np.abs(speed - in_format_units(slower, slower.speed)[1:]).max() <= ROUNDED
    assert ("any PMAC" if period >= 1e-3 else "I42 = 0") in comments["needs"]


@pytest.mark.parametrize("period", [4.096, 0.0004, 1e-7])
def test_a_period_that_pmac_would_round_is_refused(turning: Setpoints, period: float) -> None:
    with pytest.raises(InvalidValue, match="period of a PMAC program"):
        one(replace(turning, header={**turning.header, "period [s]": period}), "pmac")


# All formats


def test_every_format_with_comments_says_what_made_it(turning: Setpoints, tmp_path: Path) -> None:
    files = drive_files("cycle", turning, FORMATS, DRIVE)
    assert set(files) == {f"cycle.{end}" for end in ENDS}
    marks = {"csv": "#", "ros2.yaml": "#", "cia402.csv": "#", "pmac": ";"}
    for end, mark in marks.items():
        for line in (
            f"{mark} geometry hash: {json.dumps(turning.header['geometry hash'])}",
            f'{mark} mechanism: "Heli4"',
        ):
            assert line in files[f"cycle.{end}"].splitlines()
    write_files(tmp_path, {"cycle.mcap": files["cycle.ros2.mcap"]})
    assert turning.header["geometry hash"].encode() in (tmp_path / "cycle.mcap").read_bytes()


ENDS = ("csv", "ros2.yaml", "ros2.mcap", "cia402.csv", "zaber.csv", "xps.trj", "pmac")


def test_names_of_the_axes_reach_the_files(turning: Setpoints, tmp_path: Path) -> None:
    drive = Drive(axes=("U", "V", "W", "A"), increments=1000)
    assert bag_message(turning, tmp_path, drive)[1].joint_names == ["U", "V", "W", "A"]
    assert one(turning, "zaber", drive).startswith("Time (s),U Position (°),U Velocity (°/s),V Position")
    assert run_pmac(one(turning, "pmac", drive))[2] == ["U", "V", "W", "A"]
    assert "U 0x607A,V 0x607A,W 0x607A,A 0x607A" in one(turning, "cia402", drive)


@pytest.mark.parametrize("name", FORMATS)
def test_a_number_that_is_not_finite_reaches_no_file(turning: Setpoints, name: str) -> None:
    speed = turning.speed.copy()
    speed[7, 1] = np.inf
    with pytest.raises(InvalidValue, match="set-point 7, q2_speed"):
        drive_files("cycle", replace(turning, speed=speed), [name], DRIVE)


@pytest.mark.parametrize(
    "wrong",
    [
        {"axes": ("q1", "q1", "q2", "q3")},
        {"axes": ("q1", "q,2", "q3", "q4")},
        {"increments": 0},
        {"increments": (4096, 4096.5)},
        {"encoder_gear": 0.0},
        {"encoder_gear": math.nan},
    ],
)
def test_a_drive_that_cannot_be_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(InvalidValue, match=next(iter(wrong))):
        Drive(**wrong)


@pytest.mark.parametrize(
    ("name", "drive", "match"),
    [
        ("ros2", Drive(axes=("a", "b")), "axes"),
        ("pmac", Drive(axes=("q1", "q2", "q3", "q4")), "letters"),
        ("cia402", Drive(increments=(1, 2)), "increments"),
        ("cia402", Drive(increments=1, encoder_gear=(1.0, 2.0)), "encoder_gear"),
        ("step", Drive(), r"one of csv \(.*, ros2 \("),
    ],
)
def test_a_drive_that_does_not_fit_is_refused(turning: Setpoints, name: str, drive: Drive, match: str) -> None:
    with pytest.raises(InvalidValue, match=match):
        drive_files("cycle", turning, [name], drive)


@pytest.mark.parametrize(("name", "most"), [("xps", 8), ("pmac", 9)])
def test_more_axes_than_a_controller_has_are_refused(turning: Setpoints, name: str, most: int) -> None:
    def wide(axes: int) -> Setpoints:
        names = tuple(f"q{k}" for k in range(axes))
        columns = {c: np.zeros((len(turning.time), axes)) for c in ("joints", "speed", "acceleration", "torque")}
        return replace(turning, joint_names=names, joint_units=("rad",) * axes, **columns)

    assert drive_files("cycle", wide(most), [name])
    with pytest.raises(InvalidValue, match=f"at most {most}"):
        drive_files("cycle", wide(most + 1), [name])
