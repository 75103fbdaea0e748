"""Masses, drives and joint ranges of a study: read, carried by every stage, and felt."""

from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path

import numpy as np
import pytest

from kinematics import MECHANISMS, GoughStewart, Heli4
from kinematics.machine.bodies import UNIFORM
from studies.building.hardware import hardware_tables
from studies.building.load import load_study
from studies.building.objects import robot_of
from studies.committed.optimum import committed, read_optimum
from studies.errors import StudyError
from studies.results.output_folder import OutputFolder
from studies.results.outputs import write_model, write_setpoints
from studies.stages.cycle_stage import time_cycle
from studies.stages.proofs import question_of
from studies.study_file.keys import Key
from studies.study_file.locate import FOLDER
from studies.study_file.questions import design_question, digest_of
from studies.study_file.study import Study
from studies.study_file.toml_file import read_toml
from studies.study_file.units import Dimension
from tests.studies.command_line import SMALL, SmallRun, copy_of, linkwright
from trajectory import read_setpoints

HARDWARE = """
[inertia]
arm_mass = 1.1
plate_masses = [0.5, 0.6]
rod_middle = 0.6666666666666666
[inertia.drive_train]
gear_ratio = 5
motor_inertia = 1e-4
coulomb = [1, 1, 2, 2]

[ranges]
joints_deg = [0, 200]
passive_deg = [50, 45]
"""
GIVEN = re.sub(r"\[optimise\].*?(?=\[\[requirement)", "", SMALL, flags=re.DOTALL)
DRIVES = dataclasses.replace(
    Heli4.Inertia().drive_train, gear_ratio=5.0, motor_inertia=1e-4, coulomb=(1.0, 1.0, 2.0, 2.0)
)
INERTIA = Heli4.Inertia(arm_mass=1.1, plate_masses=(0.5, 0.6), rod_middle=2 / 3, drive_train=DRIVES)
RANGES = Heli4.Ranges(joints=(0.0, math.radians(200)), passive=(math.radians(50), math.radians(45)))


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def study_of(folder: Path, text: str) -> Study:
    (folder / "study.toml").write_text(text)
    return load_study(read_toml(folder / "study.toml"))


def test_a_robot_has_its_studys_masses_drives_and_ranges_and_else_its_own(
    tmp_path: Path,
) -> None:
    robot = robot_of(study_of(tmp_path, SMALL + HARDWARE))
    assert (robot.inertia, robot.ranges) == (INERTIA, RANGES)
    plain = robot_of(study_of(tmp_path, SMALL))
    assert (plain.inertia, plain.ranges) == (Heli4.Inertia(), Heli4.Ranges())


def test_a_hexapods_lengths_and_leads_may_be_in_millimetres(tmp_path: Path) -> None:
    text = (FOLDER / "gough_stewart" / "study.toml").read_text()
    robot = robot_of(study_of(tmp_path, text + "[inertia]\nscrew_lead_mm = 5\nrod_length_mm = 300\n"))
    assert robot.inertia == GoughStewart.Inertia(screw_lead=0.005, rod_length=0.3)
    assert robot.ranges == GoughStewart.Ranges((0.4, 1.0), (math.radians(50), math.radians(50)), (0.0, 0.0, 0.6))


def test_the_digest_tells_machines_apart_and_forgives_units(tmp_path: Path) -> None:
    plain, whole = study_of(tmp_path, SMALL).digest, study_of(tmp_path, SMALL + HARDWARE).digest
    changes = [("arm_mass = 1.1", "arm_mass = 1.2"), ("gear_ratio = 5", "gear_ratio = 6"), ("[50, 45]", "[50, 44]")]
    others = {study_of(tmp_path, SMALL + HARDWARE.replace(*change)).digest for change in changes}
    assert len(others | {plain, whole}) == 5
    in_radians = HARDWARE.replace("joints_deg = [0, 200]", f"joints = [0.0, {math.radians(200)!r}]")
    assert study_of(tmp_path, SMALL + in_radians.replace("= 5\n", "= 5.0\n")).digest == whole


@pytest.mark.parametrize("kind", MECHANISMS.values(), ids=list(MECHANISMS))
def test_every_number_of_every_machine_has_a_key(kind: type) -> None:
    tables = hardware_tables(kind, {})
    for table, record in (("inertia", kind.Inertia), ("ranges", kind.Ranges)):
        assert set(tables[table].keys) == {field.name for field in dataclasses.fields(record)}
    joints = tables["ranges"].keys["joints"]
    units = {("m",): Dimension.LENGTH, ("rad",): Dimension.ANGLE}.get(tuple(set(kind.joint_units)), Dimension.NONE)
    assert isinstance(joints, Key)
    assert joints.dimension is units


def test_a_committed_optimum_is_the_studys_machine(small_run: SmallRun, tmp_path: Path) -> None:
    file = copy_of(small_run[0], tmp_path)
    study = study_of(tmp_path, SMALL + HARDWARE)
    optimum, question = read_optimum(file), design_question(study)  # the ranges belong to it
    optimum.data["asked"]["design"], optimum.data["made_by"]["design_digest"] = question, digest_of(question)
    file.write_text(optimum.text())
    robot = committed(study, tmp_path)
    assert robot is not None
    assert robot.geometry != robot_of(study).geometry
    assert (robot.inertia, robot.ranges) == (INERTIA, RANGES)


def test_set_points_say_which_machine_they_are_for(tmp_path: Path) -> None:
    study = study_of(tmp_path, GIVEN + HARDWARE)
    assert study.trajectory is not None
    assert write_setpoints(time_cycle(study, robot_of(study)), study, OutputFolder(tmp_path))
    header = read_setpoints(tmp_path / "cycle.csv").header
    assert header["inertia"]["arm_mass"] == 1.1
    assert header["inertia"]["drive_train"]["coulomb"] == [1.0, 1.0, 2.0, 2.0]
    assert header["joint ranges"] == {"joints": list(RANGES.joints), "passive": list(RANGES.passive)}


@pytest.mark.long
def test_a_machine_twice_as_heavy_and_as_strong_is_as_fast(tmp_path: Path) -> None:
    """Every mass and inertia, the payload and the torques doubled: the same motion; without the torques, a slower."""
    masses = "drive = 0.045\narm_mass = 0.9\nrod_mass = 0.26\nplate_masses = [0.55, 0.55]\ntool = 6e-4\n"
    light = GIVEN + "[inertia]\n" + masses
    masses = "drive = 0.09\narm_mass = 1.8\nrod_mass = 0.52\nplate_masses = [1.1, 1.1]\ntool = 1.2e-3\n"
    heavy = GIVEN.replace("payload = 0.5", "payload = 1.0") + "[inertia]\n" + masses
    times = []
    for text in (light, heavy.replace("torque = 127", "torque = 254"), heavy):
        study = study_of(tmp_path, text)
        assert study.trajectory is not None
        times.append(time_cycle(study, robot_of(study)).half_cycle)
    assert times[1] == pytest.approx(times[0], rel=1e-9)
    assert times[2] > 1.2 * times[0]


@pytest.mark.long
def test_a_machine_without_masses_is_as_fast_as_its_speed_limit_lets_it_and_bears_no_torque(tmp_path: Path) -> None:
    masses = "drive = 0\narm_mass = 0\nrod_mass = 0\nplate_masses = [0, 0]\ntool = 0\n"
    study = study_of(tmp_path, GIVEN.replace("payload = 0.5", "payload = 0") + "[inertia]\n" + masses)
    assert study.trajectory is not None
    figures = time_cycle(study, robot_of(study)).figures()
    assert figures["peak_over_limit"]["joint speed"] == pytest.approx(1.0, abs=1e-3)
    assert figures["peak_over_limit"]["torque"] == figures["worst_rms_over_peak_torque"] == 0.0


def test_room_to_the_joints_limits_is_proved_or_refuted_as_the_study_has_them(tmp_path: Path) -> None:
    """The bound just below and just above the least that is left on a grid of 14,641 poses."""
    study = study_of(tmp_path, GIVEN + HARDWARE)
    question = question_of(study, robot_of(study))
    intervals = [(-0.2, 0.2), (-0.2, 0.2), (-0.76, -0.7), (-np.pi / 2, np.pi / 2)]
    poses = np.stack(np.meshgrid(*(np.linspace(*ends, 11) for ends in intervals)), axis=-1).reshape(-1, 4)
    joints = question.robot.inverse(poses)
    travel = min(joints.min(), math.radians(200) - joints.max())
    for margin, left in (
        ("joint_travel", travel),
        ("passive_joint", question.robot.margin("passive_joint", poses).min()),
    ):
        for bound, status in ((left - 0.02, "proved"), (left + 1e-6, "refuted")):
            (claim,) = question.only(margin, bound)
            assert question.prove(claim, None, None, lambda _: None).certificate.status == status


@pytest.mark.long
def test_a_required_room_that_the_ranges_do_not_leave_stops_a_run(tmp_path: Path) -> None:
    wanted = '[[requirement]]\nmargin = "passive_joint"\nat_least = 0.1\n'
    study_of(tmp_path, GIVEN + wanted + "[ranges]\npassive_deg = [20, 50]\n")
    ended = linkwright("run", tmp_path, "--out", tmp_path / "out")
    assert ended.returncode == 1
    assert re.search(
        r"passive_joint of passive joint \d, .*: found -?0\.\d+ at pose \(.*\); expected at least 0\.1",
        ended.stderr,
    )
    assert not (tmp_path / "out").exists()


def test_where_the_cycle_is_refused_a_requirement_that_fails_over_the_region_is_told_first(tmp_path: Path) -> None:
    wanted = '[[requirement]]\nmargin = "clearance"\nat_least = 0.001\n[surroundings]\nfloor = -0.7\n'
    study_of(tmp_path, GIVEN + wanted)
    ended = linkwright("run", tmp_path, "--out", tmp_path / "out")
    assert ended.returncode == 1
    assert re.search(r"the cycle was refused: .* of screw and the floor", ended.stderr)
    assert re.search(r"requirement\.at_least: clearance of screw and the floor: found -0\.", ended.stderr)


@pytest.mark.parametrize("name", ["heli4", "gough_stewart"])
def test_a_committed_answer_proves_the_room_that_its_ranges_leave(name: str) -> None:
    """That each one stands is `linkwright check`'s to say."""
    study, proved = (
        load_study(read_toml(FOLDER / name / "study.toml")),
        read_optimum(FOLDER / name / "optimum.toml").certificates,
    )
    required = {requirement.margin: requirement.at_least for requirement in study.requirement}
    assert study.ranges
    for margin in ("joint_travel", "passive_joint"):
        assert (proved[margin]["status"], proved[margin]["at_least"]) == ("proved", required[margin])


def test_an_export_spreads_the_rods_as_the_study_does_unless_told_otherwise(tmp_path: Path) -> None:
    texts, file = {}, tmp_path / "robot.xml"
    for name, text in (
        ("plain", GIVEN + "[inertia]\nrod_middle = 0\n"),
        ("uniform", GIVEN + "[inertia]\nrod_middle = 0.6666666666666666\n"),
    ):
        study = study_of(tmp_path, text)
        for rods in (None, 0.0, UNIFORM):
            write_model(robot_of(study), study, rods, file, force=True)
            texts[name, rods] = file.read_text()
    assert texts["plain", None] == texts["plain", 0.0] == texts["uniform", 0.0]
    assert texts["uniform", None] == texts["uniform", UNIFORM] == texts["plain", UNIFORM]
    assert texts["plain", None] != texts["uniform", None]


def test_a_radius_that_is_thinner_than_the_default_wall_is_told_at_the_radius(tmp_path: Path) -> None:
    words = r"geometry\.rod_radius: found 0\.001; expected at least rod_wall, which is 0\.00\d+ m by default"
    with pytest.raises(StudyError, match=words):
        study_of(tmp_path, GIVEN.replace("[region]", "[geometry]\nrod_radius = 0.001\n[region]", 1))
