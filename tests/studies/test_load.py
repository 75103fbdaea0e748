"""From a study file to a Study, or to errors that name file, key and line."""

import math
import pickle
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from kinematics.errors import LinkwrightError
from studies.errors import StudyError
from studies.load import load_study
from studies.schema import BoxRegion, CylinderRegion, Study

Write = Callable[[str], Path]
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


def test_a_study_is_read_in_si(write: Write, study_text: str) -> None:
    study = load_study(write(study_text))
    assert study.geometry["arm_length"] == 0.351
    assert study.geometry["azimuths"] == pytest.approx((0, math.pi, math.pi / 2, 3 * math.pi / 2))
    assert isinstance(study.region, CylinderRegion)
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


def test_a_box_takes_pairs_and_numbers(write: Write) -> None:
    region = load_study(write(MINIMAL)).region
    assert isinstance(region, BoxRegion)
    assert region.coordinates == {"x": 0, "y": (-0.25, 0.25), "z": (-0.2, 0.2), "theta": math.pi / 2}


def test_what_is_left_out_takes_its_default(write: Write) -> None:
    study = load_study(write(MINIMAL))
    assert (study.geometry, study.requirement) == ({}, ())
    assert (study.fvi, study.optimise, study.trajectory) == (None, None, None)


def test_a_joint_speed_in_rpm_is_read_in_rad_per_s(write: Write, study_text: str) -> None:
    limits = "[trajectory.limits]\nspeed"
    study = load_study(write(study_text.replace(f"{limits} = 20", f"{limits}_rpm = [60, 30]")))
    assert study.trajectory is not None
    assert study.trajectory.limits.speed == pytest.approx((2 * math.pi, math.pi))


def test_a_study_is_called_after_its_folder(
    write: Write, study_text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(study_text)
    assert load_study(path).name == "fake"
    monkeypatch.chdir(path.parent)
    assert load_study(Path("study.toml")).name == "fake"


def test_a_study_is_frozen(write: Write) -> None:
    study = load_study(write(MINIMAL))
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
def test_the_digest_ignores_comments_layout_and_units(
    write: Write, study_text: str, old: str, new: str
) -> None:
    assert old in study_text
    digest = load_study(write(study_text)).digest
    assert load_study(write(study_text.replace(old, new))).digest == digest


def test_the_digest_ignores_where_the_study_lies(tmp_path: Path, study_text: str) -> None:
    digests = set()
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        path = tmp_path / name / "study.toml"
        path.write_text(study_text)
        digests.add(load_study(path).digest)
    assert len(digests) == 1


@pytest.mark.parametrize(
    ("old", "new"),
    [("radius = 0.5", "radius = 0.501"), ('"J_q"', '"J_x"'), ("seed = 0", "seed = 1"), ("jerk = 1e5", "")],
)
def test_the_digest_tells_different_studies_apart(write: Write, study_text: str, old: str, new: str) -> None:
    digest = load_study(write(study_text)).digest
    assert load_study(write(study_text.replace(old, new))).digest != digest


# (old text, new text, key, what the message says); the line is that of the new text's last line.
FAULTS = {
    "unknown key": ("radius = 0.5", "radus = 0.5", "region.radus", "did you mean radius?"),
    "unknown suffixed key": ("lift_mm", "lfit_mm", "trajectory.cycle.lfit_mm", "did you mean lift_mm?"),
    "unknown table": ("[fvi]", "[fvii]", "fvii", "did you mean fvi?"),
    "unknown top key": ('mechanism = "Fake"', 'mechanism = "Fake"\nname = "x"', "name", "unknown key"),
    "quoted key": ("radius = 0.5", 'radius = 0.5\n"a.\\n" = 1', 'region."a.\\n"', "unknown key"),
    "wrong type": ("radius = 0.5", 'radius = "0.5"', "region.radius", 'found "0.5"; expected a length > 0'),
    "boolean": ("radius = 0.5", "radius = true", "region.radius", "found true"),
    "date": ("radius = 0.5", "radius = 1979-05-27", "region.radius", "found 1979-05-27"),
    "fraction": ("grid = 2000", "grid = 2000.5", "trajectory.grid", "a whole number"),
    "table for tables": ("[[requirement]]", "[requirement]", "requirement", "expected an array of tables"),
    "wrong unit": ("radius = 0.5", "radius_deg = 3", "region.radius_deg", "expected radius (m) or radius_mm"),
    "foreign unit": ("radius = 0.5", "radius_inch = 3", "region.radius_inch", 'found unit suffix "_inch"'),
    "cm": ("radius = 0.5", "radius_cm = 50", "region.radius_cm", "radius (m) or radius_mm"),
    "rad": ("theta_deg = [-180, 180]", "theta_rad = [-3, 3]", "region.theta_rad", "theta (rad) or theta_deg"),
    "two units": ("joint_speed = 20", "joint_speed_rad_s = 20", "fvi.joint_speed_rad_s", "_rpm"),
    "no unit": ("period = 0.001", "period_ms = 1", "trajectory.period_ms", "period, which takes no suffix"),
    "geometry unit": ("arm_length_mm = 351", "arm_length_deg = 3", "geometry.arm_length_deg", "length_mm"),
    "twice": ("radius = 0.5", "radius = 0.5\nradius_mm = 500", "region.radius_mm", "given twice"),
    "radius": ("radius = 0.5", "radius = -0.5", "region.radius", "found -0.5; expected a length > 0 (m)"),
    "radius in mm": ("radius = 0.5", "radius_mm = -5", "region.radius_mm", "expected a length > 0 (mm)"),
    "upside down": ("z = [-0.80, -0.60]", "z = [-0.6, -0.8]", "region.z", "a number, or low < high (m)"),
    "three numbers": ("z = [-0.80, -0.60]", "z = [1, 2, 3]", "region.z", "found [1, 2, 3]"),
    "over a turn": ("[-180, 180]", "[-180, 181]", "region.theta_deg", "at most a turn apart (deg)"),
    "a word for an angle": ("[-180, 180]", "[-180, 'x']", "region.theta_deg", "at most a turn apart (deg)"),
    "disc has x": ("radius = 0.5", "radius = 0.5\nx = 1", "region.x", "unknown key"),
    "region kind": ('"cylinder"', '"cylindre"', "region.kind", "box, cylinder (did you mean cylinder?)"),
    "zero length": ("arm_length_mm = 351", "arm_length_mm = 0", "geometry.arm_length_mm", "number > 0 (mm)"),
    "negative length": ("arm_length_mm = 351", "arm_length = -1", "geometry.arm_length", "number > 0 (m)"),
    "geometry field": ("arm_length_mm", "arm_lenght_mm", "geometry.arm_lenght_mm", "mean arm_length_mm?"),
    "tuple length": ("[0, 180, 90, 270]", "[0, 180]", "geometry.azimuths_deg", "4 finite numbers (deg)"),
    "number for tuple": ("[0, 180, 90, 270]", "0", "geometry.azimuths_deg", "4 finite numbers (deg)"),
    "tuple for number": ("arm_length_mm = 351", "arm_length = [1]", "geometry.arm_length", "a finite number"),
    "ragged points": ("arm_length_mm = 351", "points = [[1], [1, 2], []]", "geometry.points", "3 x 2 finite"),
    "mechanism": ('"Fake"', '"Fale"', "mechanism", 'found "Fale"; expected one of Fake (did you mean Fake?)'),
    "margin": ('"J_q"', '"J_Q"', "requirement.margin", "J_q, J_x, fvi, reach (did you mean J_q?)"),
    "variable": ("pitch_mm", "pich_mm", "optimise.variables.pich_mm", "did you mean pitch_mm?"),
    "bounds": ("[20, 120]", "[120, 20]", "optimise.variables.pitch_mm", "expected low < high (mm)"),
    "equal bounds": ("[20, 120]", "[20, 20]", "optimise.variables.pitch_mm", "expected low < high (mm)"),
    "length bounds": ("[0.25, 0.50]", "[0, 0.5]", "optimise.variables.arm_length", "0 < low < high (m)"),
    "sum's field": ('"rod_length"]', '"rod"]', "optimise.sums.fields", "found ["),
    "sum's dimension": ('"rod_length"]', '"pitch"]', "optimise.sums.fields", "a list out of arm_length"),
    "sum's bound": ("at_most = 1.151", "at_most = 0", "optimise.sums.at_most", "a length > 0"),
    "nan": ("at_least = 0.3", "at_least = nan", "requirement.at_least", "found nan; expected a finite"),
    "inf": ("arm_length_mm = 351", "arm_length_mm = inf", "geometry.arm_length_mm", "found inf"),
    "inf in pair": ("[0.25, 0.50]", "[0.25, inf]", "optimise.variables.arm_length", "found [0.25, inf]"),
    "huge": ("force = 150", "force = 1e999", "fvi.force", "found inf"),
    "long integer": ("force = 150", f"force = 0x{'f' * 5000}", "fvi.force", "found 0xfff"),
    "blend over lift": ("blend_mm = 24.9", "blend_mm = 25.1", "trajectory.cycle.blend_mm", "most the lift"),
    "blends meet": (
        "span_mm = 305\nblend_mm = 24.9",
        "span_mm = 49\nblend_mm = 24.9",
        "trajectory.cycle.blend_mm",
        "half the span",
    ),
    "no blend": ("blend_mm = 24.9", "blend = 0", "trajectory.cycle.blend", "a length > 0"),
    "grid": ("grid = 2000", "grid = 999", "trajectory.grid", "found 999; expected a whole number from 1000"),
    "period": ("period = 0.001", "period = 0", "trajectory.period", "found 0; expected a time > 0 (s)"),
    "law": ('"toppra"', '"topra"', "trajectory.law", "did you mean toppra?"),
    "payload": ("payload = 1.0", "payload = -1", "trajectory.cycle.payload", "a mass >= 0 (kg)"),
    "joint limit": ("torque = 127", "torque = [1, 0]", "trajectory.limits.torque", "> 0, or one a joint"),
    "no limits": ("torque = 127", "torque = []", "trajectory.limits.torque", "found []"),
}


@pytest.mark.parametrize(("old", "new", "key", "says"), FAULTS.values(), ids=FAULTS)
def test_a_fault_names_file_key_line_and_what_was_expected(
    write: Write, study_text: str, old: str, new: str, key: str, says: str
) -> None:
    before, found, after = study_text.partition(old)
    assert found
    path = write(before + new + after)
    with pytest.raises(StudyError) as caught:
        load_study(path)
    [problem] = [problem for problem in caught.value.problems if problem.key == key]
    assert (problem.file, problem.line) == (path, (before + new).count("\n") + 1)
    assert str(problem).startswith(f"{path}:{problem.line}: {key}: found ")
    assert says in str(problem)


@pytest.mark.parametrize(
    ("left_out", "key", "line"),
    [
        ('title = "t"\n', "title", 1),
        ('mechanism = "Fake"\n', "mechanism", 1),
        ('kind = "box"\n', "region.kind", 3),
        ("y = [-0.25, 0.25]\n", "region.y", 3),
        ("theta_deg = 90\n", "region.theta", 3),
        (MINIMAL.partition("[region]")[2], "region.kind", 3),
    ],
)
def test_a_missing_key_is_reported_at_its_table(write: Write, left_out: str, key: str, line: int) -> None:
    with pytest.raises(StudyError) as caught:
        load_study(write(MINIMAL.replace(left_out, "")))
    assert (caught.value.key, caught.value.line, caught.value.found) == (key, line, "nothing")
    assert len(caught.value.problems) == 1


def test_a_missing_table_is_reported(write: Write) -> None:
    with pytest.raises(StudyError, match="region: found nothing; expected a table"):
        load_study(write(MINIMAL.partition("[region]")[0]))


@pytest.mark.parametrize(
    ("text", "key", "says"),
    [
        (
            "[trajectory]\ncycle = 3\n",
            "trajectory.cycle",
            "found 3; expected a table with one or more",
        ),
        ("[optimise]\nvariables = {}\n", "optimise.variables", "found an empty table; expected a table"),
        ("[[fvi]]\nspeed = 1\n", "fvi", "found [a table]; expected a table"),
        ("[optimise]\nsums = [3]\n", "optimise.sums", "found 3; expected an array of tables"),
    ],
)
def test_what_should_be_a_table_is_told(write: Write, text: str, key: str, says: str) -> None:
    with pytest.raises(StudyError) as caught:
        load_study(write(MINIMAL + text))
    [problem] = [problem for problem in caught.value.problems if problem.key == key]
    assert says in str(problem)


@pytest.mark.parametrize(("region", "found"), [("3", "3"), ("[{ kind = 'box' }]", "[a table]")])
def test_a_region_that_is_no_table_is_told(write: Write, region: str, found: str) -> None:
    text = MINIMAL.partition("[region]")[0] + f"region = {region}\n"
    with pytest.raises(StudyError) as caught:
        load_study(write(text))
    assert (caught.value.key, caught.value.line, caught.value.found) == ("region", 3, found)


def test_a_box_may_not_name_a_coordinate_that_the_mechanism_lacks(write: Write) -> None:
    with pytest.raises(StudyError, match=r":9: region\.roll: found an unknown key; expected one of"):
        load_study(write(MINIMAL + "roll = 0\n"))


def test_a_misspelt_key_is_not_reported_as_missing_too(write: Write, study_text: str) -> None:
    with pytest.raises(StudyError) as caught:
        load_study(write(study_text.replace("radius =", "radus =").replace("lift_mm", "lift_inch")))
    assert [problem.key for problem in caught.value.problems] == [
        "region.radus",
        "trajectory.cycle.lift_inch",
    ]


def test_a_key_and_its_misspelling_are_both_judged(write: Write, study_text: str) -> None:
    with pytest.raises(StudyError) as caught:
        load_study(write(study_text.replace("grid = 2000", "grid = 10\ngridd = 10")))
    assert [problem.key for problem in caught.value.problems] == ["trajectory.grid", "trajectory.gridd"]


def test_all_faults_are_reported_one_a_line_in_the_files_order(write: Write, study_text: str) -> None:
    text = study_text.replace("= 0.5\n", "= -1\n").replace("[20, 120]", "[3]").replace("351", "0")
    path = write(
        text.replace("grid = 2000", "grid = 1").replace('"J_q"', "3").replace("theta_deg", "theta_m")
    )
    with pytest.raises(StudyError) as caught:
        load_study(path)
    lines = str(caught.value).splitlines()
    assert [line.split(": ")[:2] for line in lines] == [
        [f"{path}:5", "geometry.arm_length_mm"],
        [f"{path}:10", "region.radius"],
        [f"{path}:12", "region.theta_m"],
        [f"{path}:26", "optimise.variables.pitch_mm"],
        [f"{path}:32", "requirement.margin"],
        [f"{path}:37", "trajectory.grid"],
    ]


def test_an_unknown_mechanism_does_not_hide_other_faults(write: Write, study_text: str) -> None:
    with pytest.raises(StudyError) as caught:
        load_study(write(study_text.replace('"Fake"', '"Nope"').replace("grid = 2000", "grid = 1")))
    assert [problem.key for problem in caught.value.problems] == ["mechanism", "trajectory.grid"]


def test_the_second_row_of_an_array_of_tables_is_told_by_its_line(write: Write) -> None:
    rows = '[[requirement]]\nmargin = "J_q"\nat_least = 0\n[[requirement]]\nmargin = "x"\nat_least = 0\n'
    with pytest.raises(StudyError) as caught:
        load_study(write(MINIMAL + rows))
    assert (caught.value.key, caught.value.line) == ("requirement.margin", 13)


def test_a_fault_in_an_inline_array_of_tables_has_its_own_line(write: Write) -> None:
    rows = 'requirement = [\n  { margin = "J_q", at_least = 0 },\n  { margin = "J_q", at_least = "0" },\n]\n'
    with pytest.raises(StudyError) as caught:
        load_study(write(rows + MINIMAL))
    assert (caught.value.key, caught.value.line) == ("requirement.at_least", 3)


def test_the_prototype_may_lie_outside_the_bounds(write: Write) -> None:
    study = load_study(write(MINIMAL + "[optimise.variables]\narm_length = [2, 3]\n"))
    assert study.optimise is not None
    assert study.optimise.variables == {"arm_length": (2, 3)}


def test_a_coordinate_of_the_geometry_may_be_negative(write: Write) -> None:
    assert load_study(write(MINIMAL + "[geometry]\nplate_offset_mm = -3\n")).geometry == {
        "plate_offset": -0.003
    }


def test_a_study_error_survives_pickling(write: Write) -> None:
    with pytest.raises(StudyError) as caught:
        load_study(write("a = 1"))
    assert isinstance(caught.value, LinkwrightError)
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)


def load_or_fault(path: Path) -> None:
    """Reads `path`; any exception but a StudyError escapes, as does a message with a stray line."""
    with suppress(StudyError):
        try:
            assert isinstance(load_study(path), Study)
        except StudyError as error:
            lines = str(error).split("\n")
            if len(lines) != len(error.problems) or not all(line.startswith(str(path)) for line in lines):
                raise AssertionError(lines) from error
            raise


garbage = settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
VALUES = [
    "nan",
    "-inf",
    "[]",
    "{}",
    "[[]]",
    "[{}]",
    "0x" + "f" * 400,
    "''",
    "true",
    "1e308",
    "1979-05-27",
    "[1, '']",
]


@garbage
@given(st.text())
def test_any_text_gives_a_study_or_a_study_error(write: Write, text: str) -> None:
    load_or_fault(write(text.encode("utf-8", "replace").decode()))


@garbage
@given(st.data())
def test_a_study_with_values_replaced_gives_a_study_or_a_study_error(
    write: Write, study_text: str, data: st.DataObject
) -> None:
    lines = study_text.splitlines()
    places = [i for i, line in enumerate(lines) if " = " in line]
    for i in data.draw(st.lists(st.sampled_from(places), min_size=1, max_size=8)):
        lines[i] = f"{lines[i].partition(' = ')[0]} = {data.draw(st.sampled_from(VALUES))}"
    load_or_fault(write("\n".join(lines)))


@garbage
@given(st.data())
def test_a_study_with_lines_shuffled_and_cut_gives_a_study_or_a_study_error(
    write: Write, study_text: str, data: st.DataObject
) -> None:
    blocks = study_text.split("\n[")
    chosen = data.draw(st.lists(st.sampled_from(blocks), unique=True))
    text = "\n[".join(chosen)
    cut = data.draw(st.integers(0, len(text)))
    load_or_fault(
        write(text[:cut] + data.draw(st.sampled_from(["", "_mm", "\n", "]", "=1\n", " = {}\n"])) + text[cut:])
    )
