"""The table `[surroundings]`: what it builds, and how its faults are told."""

from __future__ import annotations

from pathlib import Path

import pytest

from kinematics import Obstacle, PayloadHull, Surroundings
from studies.building import load_study, robot_of
from studies.errors import StudyError
from studies.report.machine_rows import machine_rows
from studies.study_file import design_question, read_toml

STUDY = """title = "A Delta over a conveyor"
mechanism = "Delta"
[region]
kind = "box"
x = [-0.1, 0.1]
y = [-0.1, 0.1]
z = [-0.8, -0.7]
[surroundings]
floor_mm = -950
[[surroundings.obstacle]]
name = "conveyor"
low = [-1, -0.3, -1.2]
high = [1, 0.3, -0.9]
[surroundings.payload_hull]
radius = 0.03
low_mm = -60
high_mm = -6
"""


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def loaded(folder: Path, *changes: tuple[str, str]):  # type: ignore[no-untyped-def]
    text = STUDY
    for before, after in changes:
        assert before in text
        text = text.replace(before, after)
    (folder / "study.toml").write_text(text)
    return load_study(read_toml(folder / "study.toml"))


def test_a_study_s_surroundings_are_those_of_its_robot_and_of_its_question(tmp_path: Path) -> None:
    study = loaded(tmp_path)
    conveyor = Obstacle("conveyor", (-1.0, -0.3, -1.2), (1.0, 0.3, -0.9))
    assert robot_of(study).surroundings == Surroundings(-0.95, (conveyor,), PayloadHull(0.03, -0.06, -0.006))
    assert robot_of(study).conditions(("surroundings",))["surroundings"]["floor"] == -0.95
    assert "surroundings.floor" in design_question(study)


def test_the_report_states_materials_load_and_surroundings(tmp_path: Path) -> None:
    own = '[structure]\nrod = "light"\n[material.light]\ndensity = 1.5e3\nmodulus = 135e9\nshear_modulus = 9e9\n'
    load = "strength = 500e6\n[load]\npayload = 2\n"
    study = loaded(tmp_path, ("[surroundings]", f"{own}{load}[surroundings]"))
    rows = dict(machine_rows(robot_of(study), study))
    expected = "light: density 1500 kg/m³, modulus 135 GPa, shear modulus 9 GPa, strength 500 MPa"
    assert rows["material of each rod"] == expected
    assert rows["material of each arm"].startswith("aluminium: density 2700")
    assert "material of each leg" not in rows
    assert rows["load of strength and natural_frequency"].startswith("payload 2 kg, acceleration 100 m/s²")
    assert rows["floor"] == "at z = -0.95 m"
    assert rows["box 'conveyor'"] == "(-1, -0.3, -1.2) to (1, 0.3, -0.9) m; the robot stays outside"
    assert rows["room of the payload"].startswith("radius 0.03 m, from -0.06 m to -0.006 m")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            ("high_mm = -6", "high_mm = 4"),
            r"payload_hull\.high_mm: found 4; expected a hull outside all members; .* inside the plate",
        ),
        (("floor_mm = -950", "floor_mm = -10"), r"floor_mm: found -10; expected a height below the base: motor 1"),
        (("0.3, -0.9]", "0.3, -1.2]"), r"obstacle\.high: found \[1, 0\.3, -1\.2\]; expected .* each above that of low"),
        (('"conveyor"', '"rod 1 a"'), r'obstacle\.name: found "rod 1 a"; expected a name that is no member of Delta'),
        (('"conveyor"', '"motor 2"'), r'obstacle\.name: found "motor 2"; expected a name that is no member'),
        (('"conveyor"', '"the floor"'), r'obstacle\.name: found "the floor"; expected .* none of base, floor, payload'),
        (('"conveyor"', '""'), r'obstacle\.name: found ""'),
        (("radius = 0.03", "radius = 0"), r"payload_hull\.radius: found 0; expected a length > 0"),
    ],
)
def test_a_fault_is_told_at_its_key(tmp_path: Path, change: tuple[str, str], words: str) -> None:
    with pytest.raises(StudyError, match=words):
        loaded(tmp_path, change)


def test_a_name_that_two_obstacles_have_is_told_with_both_lines(tmp_path: Path) -> None:
    row = '[[surroundings.obstacle]]\nname = "conveyor"\nlow = [0, 0, -2]\nhigh = [1, 1, -1]\n'
    words = r'study\.toml:15: surroundings\.obstacle\.name: found "conveyor", as on line 11; expected .* different'
    with pytest.raises(StudyError, match=words) as raised:
        loaded(tmp_path, ("[surroundings.payload_hull]", f"{row}[surroundings.payload_hull]"))
    assert len(raised.value.faults) == 1
