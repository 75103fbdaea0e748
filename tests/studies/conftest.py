"""A small mechanism that stands in for the real ones, and a complete study of it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import pytest

import kinematics
from kinematics import InertiaRecord, Margin
from kinematics.machine import GeometryRecord, RodRanges, angle, length, screw_pitch
from kinematics.margins.isotropic import FVI
from kinematics.margins.mass import MASS
from kinematics.margins.parallel import DET_J_X
from kinematics.margins.reach import REACH
from kinematics.margins.serial import J_Q
from tests.studies.command_line import SMALL, SmallRun, linkwright

STUDY = """\
title = "Fake on its prototype"
mechanism = "Fake"

[geometry]
arm_length_mm = 351
azimuths_deg = [0, 180, 90, 270]

[region]
kind = "cylinder"
radius = 0.5
z = [-0.80, -0.60]
theta_deg = [-180, 180]

[fvi]
joint_speed = 20
joint_effort = 127
speed = 2.5
force = 150
characteristic_length = 0.00796

[optimise]
seed = 0
starts = 3
[optimise.variables]
arm_length = [0.25, 0.50]
pitch_mm = [20, 120]
[[optimise.sums]]
fields = ["arm_length", "rod_length"]
at_most = 1.151

[[requirement]]
margin = "J_q"
at_least = 0.3

[trajectory]
law = "toppra"
grid = 2000
period = 0.001
[trajectory.cycle]
lift_mm = 25
span_mm = 305
blend_mm = 24.9
turn_deg = 180
pick = [-0.1525, 0.0, -0.80]
heading_deg = 0
payload = 1.0
[trajectory.limits]
speed = 20
acceleration = 450
torque = 127
jerk = 1e5

[certify]
margins = ["J_x", "fvi"]
tolerance = 0.02
most_boxes = 1000

[inertia]
arm_mass = 0.8
plate_masses = [0.5, 0.6]
lead_mm = 12
rod_middle = 0.25
[inertia.drive_train]
gear_ratio = 5
coulomb = [1, 2, 3, 4]

[ranges]
joints_deg = [[0, 210], [0, 210], [0, 210], [10, 220]]
passive_deg = [50, 60]
"""

MINIMAL = """\
title = "t"
mechanism = "Fake"
[region]
kind = "box"
x = 0
y = [-0.25, 0.25]
z_mm = [-200, 200]
theta_deg = 90
"""


class Fake:
    """As much of a mechanism as a study file speaks of."""

    joint_names: ClassVar[tuple[str, ...]] = ("q1", "q2", "q3", "q4")
    joint_units: ClassVar[tuple[str, ...]] = ("rad",) * 4
    pose_names: ClassVar[tuple[str, ...]] = ("x", "y", "z", "theta")
    counts_turns: ClassVar[bool] = False
    margins: ClassVar[dict[str, Margin]] = {"mass": MASS, "J_q": J_Q, "J_x": DET_J_X, "fvi": FVI, "reach": REACH}

    @classmethod
    def member_kinds(cls) -> list[str]:
        return ["arm", "rod"]

    @dataclass(frozen=True)
    class Geometry(GeometryRecord):
        arm_length: float = length(0.35, doc="L")
        rod_length: float = length(0.8, doc="l")
        plate_offset: float = length(0.0, minimum=None, doc="h")
        pitch: float = screw_pitch(0.05, doc="p")
        azimuths: tuple[float, ...] = angle((0.0, 1.0, 2.0, 3.0), doc="alpha")
        points: tuple[tuple[float, ...], ...] = length(((0.0, 1.0), (1.0, 0.0), (1.0, 1.0)), minimum=None, doc="P")

    @dataclass(frozen=True)
    class Inertia(InertiaRecord):
        dimensions: ClassVar[Mapping[str, str]] = {"lead": "length_per_turn"}
        arm_mass: float = 0.9
        plate_masses: tuple[float, float] = (0.55, 0.55)
        lead: float = 0.01

    Ranges = RodRanges


@pytest.fixture(autouse=True)
def fake_mechanism(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kinematics, "MECHANISMS", {"Fake": Fake}, raising=False)


Write = Callable[[str], Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes a text as `fake/study.toml`."""
    folder = tmp_path / "fake"
    folder.mkdir()

    def write_study(text: str) -> Path:
        path = folder / "study.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write_study


@pytest.fixture
def study_text() -> str:
    return STUDY


@pytest.fixture
def minimal_text() -> str:
    return MINIMAL


@pytest.fixture(scope="session")
def small_run(tmp_path_factory: pytest.TempPathFactory) -> SmallRun:
    folder = tmp_path_factory.mktemp("small")
    (folder / "study.toml").write_text(SMALL)
    return folder, linkwright("run", folder / "study.toml", "--out", folder / "out", "--commit", "--json")
