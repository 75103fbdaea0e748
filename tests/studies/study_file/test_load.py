"""From a study file to a Study, or to errors that name file, key and line."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from pydantic import ValidationError

from studies.building.load import load_study
from studies.building.mechanisms import MechanismRefused, mechanism_named
from studies.building.objects import limits_of
from studies.errors import StudyError
from studies.study_file.study import BoxTable, CylinderTable
from studies.study_file.toml_file import read_toml

Write = Callable[[str], Path]


def test_a_study_is_read_in_si(write: Write, study_text: str) -> None:
    study = load_study(read_toml(write(study_text)))
    assert study.geometry["arm_length"] == 0.351
    assert study.geometry["azimuths"] == pytest.approx((0, math.pi, math.pi / 2, 3 * math.pi / 2))
    assert isinstance(study.region, CylinderTable)
    assert study.region.radius == 0.5
    assert study.region.coordinates == {"z": (-0.8, -0.6), "theta": (-math.pi, math.pi)}
    assert study.optimise is not None
    assert study.optimise.variables == {"arm_length": (0.25, 0.5), "pitch": (0.02, 0.12)}
    assert study.optimise.sums[0].fields == ("arm_length", "rod_length")
    assert study.requirement[0].margin == "J_q"
    assert study.trajectory is not None
    assert study.trajectory.cycle.blend == 0.0249
    assert study.trajectory.cycle.turn == math.pi
    assert study.trajectory.limits.jerk == 1e5


def test_a_box_takes_pairs_and_numbers(write: Write, minimal_text: str) -> None:
    region = load_study(read_toml(write(minimal_text))).region
    assert isinstance(region, BoxTable)
    assert region.coordinates == {"x": 0, "y": (-0.25, 0.25), "z": (-0.2, 0.2), "theta": math.pi / 2}


def test_what_rounding_leaves_of_a_zero_is_a_place_and_no_size(
    write: Write, minimal_text: str, study_text: str
) -> None:
    home = "[home]\nx = 6.123e-17\ntheta = -1e-16\n"
    study = load_study(read_toml(write(minimal_text.replace("x = 0", "x = [-1.2e-17, 0.1]") + home)))
    assert study.home is not None
    assert study.home.coordinates == {"x": 6.123e-17, "theta": -1e-16}
    assert study.region.coordinates["x"] == (-1.2e-17, 0.1)
    with pytest.raises(StudyError, match="0, or a number whose size is from 1e-15 to"):
        load_study(read_toml(write(study_text.replace("radius = 0.5", "radius = 1e-16"))))


def test_what_is_left_out_takes_its_default(write: Write, minimal_text: str) -> None:
    study = load_study(read_toml(write(minimal_text)))
    assert (study.geometry, study.requirement) == ({}, ())
    assert (study.fvi, study.optimise, study.trajectory) == (None, None, None)
    assert (study.certify.margins, study.certify.tolerance) == (None, 1e-4)


def test_a_joint_speed_in_rpm_is_read_in_rad_per_s(write: Write, study_text: str) -> None:
    limits = "[trajectory.limits]\nspeed"
    study = load_study(read_toml(write(study_text.replace(f"{limits} = 20", f"{limits}_rpm = [60, 30, 60, 30]"))))
    assert study.trajectory is not None
    assert study.trajectory.limits.speed == pytest.approx((2 * math.pi, math.pi) * 2)


def test_a_study_is_called_after_its_folder(write: Write, study_text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(study_text)
    assert load_study(read_toml(path)).name == "fake"
    monkeypatch.chdir(path.parent)
    assert load_study(read_toml(Path("study.toml"))).name == "fake"


def test_a_study_is_frozen(write: Write, minimal_text: str) -> None:
    study = load_study(read_toml(write(minimal_text)))
    with pytest.raises(ValidationError, match="frozen"):
        study.title = "other"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("radius = 0.5", "# half a metre\nradius   =   5e-1"),
        ("arm_length_mm = 351", "arm_length = 0.351"),
        ("blend_mm = 24.9", "blend = 0.0249"),
        ("theta_deg = [-180, 180]", "theta = [-3.141592653589793, 3.141592653589793]"),
        ("[0.25, 0.50]", "[\n 0.25,\n 0.5,\n]"),
        ("joint_speed = 20", "joint_speed = 20.0"),
        ("seed = 0\n", ""),
        ("heading_deg = 0", "heading = -0.0"),
        ("[[requirement]]\n", "[[ 'requirement' ]] # one\n"),
    ],
)
def test_the_digest_ignores_comments_layout_and_units(write: Write, study_text: str, old: str, new: str) -> None:
    assert old in study_text
    digest = load_study(read_toml(write(study_text))).digest
    assert load_study(read_toml(write(study_text.replace(old, new)))).digest == digest


def test_the_digest_ignores_where_the_study_lies(tmp_path: Path, study_text: str) -> None:
    digests = set()
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        path = tmp_path / name / "study.toml"
        path.write_text(study_text)
        digests.add(load_study(read_toml(path)).digest)
    assert len(digests) == 1


@pytest.mark.parametrize(
    ("old", "new"),
    [("radius = 0.5", "radius = 0.501"), ('"J_q"', '"J_x"'), ("seed = 0", "seed = 1"), ("jerk = 1e5", "")],
)
def test_the_digest_tells_different_studies_apart(write: Write, study_text: str, old: str, new: str) -> None:
    digest = load_study(read_toml(write(study_text))).digest
    assert load_study(read_toml(write(study_text.replace(old, new)))).digest != digest


def test_the_prototype_may_lie_outside_the_bounds(write: Write, minimal_text: str) -> None:
    study = load_study(read_toml(write(minimal_text + "[optimise.variables]\narm_length = [2, 3]\n")))
    assert study.optimise is not None
    assert study.optimise.variables == {"arm_length": (2, 3)}


def test_a_coordinate_of_the_geometry_may_be_negative(write: Write, minimal_text: str) -> None:
    assert load_study(read_toml(write(minimal_text + "[geometry]\nplate_offset_mm = -3\n"))).geometry == {
        "plate_offset": -0.003
    }


def test_an_unknown_mechanism_carries_the_known_names() -> None:
    with pytest.raises(MechanismRefused, match=r"'Fale': .* or one of Fake \(did you mean Fake\?\)") as caught:
        mechanism_named("Fale", Path(), allow_code=True)
    assert (caught.value.name, caught.value.found) == ("Fale", '"Fale"')


def test_limits_of_ranges_lines_and_rms_are_read_and_half_a_line_is_not(write: Write, study_text: str) -> None:
    more = "jerk = 1e5\nposition = [[-1, 2], [0, 1], [0, 1], [0, 1]]\nstall_torque = 150\nno_load_speed_rpm = 300\n"
    more += "rms_torque = [70, 80, 80, 80]"
    study = load_study(read_toml(write(study_text.replace("jerk = 1e5", more))))
    assert study.trajectory is not None
    limits = limits_of(study.trajectory.limits)
    assert limits.position == ((-1.0, 2.0), *[(0.0, 1.0)] * 3)
    assert (limits.stall_torque, limits.no_load_speed) == (150.0, pytest.approx(10 * math.pi))
    assert limits.rms_torque == (70.0, 80.0, 80.0, 80.0)
    with pytest.raises(StudyError, match=r"trajectory.limits.no_load_speed: found nothing; expected .* stall_torque"):
        load_study(read_toml(write(study_text.replace("jerk = 1e5", "stall_torque = 150"))))


def test_the_law_is_jerk_unless_the_study_says_otherwise(write: Write, study_text: str) -> None:
    study = load_study(read_toml(write(study_text.replace('law = "toppra"\n', ""))))
    assert study.trajectory is not None
    assert study.trajectory.law == "jerk"
