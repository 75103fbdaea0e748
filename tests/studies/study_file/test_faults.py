"""Each fault of a study file is told with its file, key and line."""

import math
import pickle
from collections.abc import Callable
from pathlib import Path

import pytest

import kinematics
from kinematics import LinkwrightError
from studies.building.load import load_study
from studies.errors import StudyError
from studies.study_file.toml_file import read_toml

Write = Callable[[str], Path]

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
    "no unit": ("period = 0.001", "period_ms = 1", "trajectory.period_ms", "period without a suffix"),
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
    "zero length": ("arm_length_mm = 351", "arm_length_mm = 0", "geometry.arm_length_mm", "number, above 0 (mm)"),
    "negative length": ("arm_length_mm = 351", "arm_length = -1", "geometry.arm_length", "number, above 0 (m)"),
    "geometry field": ("arm_length_mm", "arm_lenght_mm", "geometry.arm_lenght_mm", "mean arm_length_mm?"),
    "tuple length": ("[0, 180, 90, 270]", "[0, 180]", "geometry.azimuths_deg", "4 finite numbers (deg)"),
    "number for tuple": ("[0, 180, 90, 270]", "0", "geometry.azimuths_deg", "4 finite numbers (deg)"),
    "tuple for number": ("arm_length_mm = 351", "arm_length = [1]", "geometry.arm_length", "a finite number"),
    "ragged points": ("arm_length_mm = 351", "points = [[1], [1, 2], []]", "geometry.points", "3 x 2 finite"),
    "mass key": ("arm_mass", "arm_masss", "inertia.arm_masss", "did you mean arm_mass?"),
    "no mass": ("arm_mass = 0.8", "arm_mass = -0.8", "inertia.arm_mass", "found -0.8; expected a finite number >= 0"),
    "mass of words": ("arm_mass = 0.8", 'arm_mass = "0.8"', "inertia.arm_mass", 'found "0.8"; expected a finite'),
    "one mass for two": ("[0.5, 0.6]", "0.5", "inertia.plate_masses", "found 0.5; expected 2 finite numbers >= 0"),
    "mass in grams": ("arm_mass = 0.8", "arm_mass_g = 800", "inertia.arm_mass_g", "arm_mass without a suffix"),
    "lead in degrees": ("lead_mm", "lead_deg", "inertia.lead_deg", "lead (m per turn) or lead_mm"),
    "more than the rod": ("rod_middle = 0.25", "rod_middle = 1.5", "inertia.rod_middle", "a number from 0 to 1"),
    "no gear": ("gear_ratio = 5", "gear_ratio = 0", "inertia.drive_train.gear_ratio", "found 0; expected a number > 0"),
    "three drives": ("[1, 2, 3, 4]", "[1, 2, 3]", "inertia.drive_train.coulomb", ">= 0, or one a joint (N m, or N)"),
    "ragged drives": ("[1, 2, 3, 4]", "[[1], [2, 3]]", "inertia.drive_train.coulomb", "found [[1], [2, 3]]; expected"),
    "drive key": ("gear_ratio", "gear_rato", "inertia.drive_train.gear_rato", "did you mean gear_ratio?"),
    "three joints": ("[0, 210], [10, 220]]", "[0, 210]]", "ranges.joints_deg", "one pair or 4 pairs (deg)"),
    "joint upside down": ("[10, 220]]", "[220, 10]]", "ranges.joints_deg", "expected finite low < high"),
    "joint in mm": ("joints_deg", "joints_mm", "ranges.joints_mm", "joints (rad) or joints_deg"),
    "joint without end": ("[10, 220]]", "[10, inf]]", "ranges.joints_deg", "expected finite low < high"),
    "one passive angle": ("[50, 60]", "50", "ranges.passive_deg", "found 50; expected two angles above 0"),
    "more than half a turn": ("[50, 60]", "[50, 181]", "ranges.passive_deg", "at most half a turn"),
    "no rest": ("passive_deg", "rest_mm", "ranges.rest_mm", "unknown key"),
    "mechanism": (
        '"Fake"',
        '"Fale"',
        "mechanism",
        'expected "module:Class", or one of Fake (did you mean Fake?)',
    ),
    "margin": ('"J_q"', '"J_Q"', "requirement.margin", "J_q, J_x, fvi, reach (did you mean J_q?)"),
    "variable": ("pitch_mm", "pich_mm", "optimise.variables.pich_mm", "did you mean pitch_mm?"),
    "bounds": (
        "[20, 120]",
        "[120, 20]",
        "optimise.variables.pitch_mm",
        "low < high, with no 0 from low to high (mm",
    ),
    "equal bounds": (
        "[20, 120]",
        "[20, 20]",
        "optimise.variables.pitch_mm",
        "low < high, with no 0 from low to high (mm",
    ),
    "less than reach": (
        '"J_q"\nat_least = 0.3',
        '"reach"\nat_least = -0.3',
        "requirement.at_least",
        "for the margin reach, 0 or more",
    ),
    "no entry moves": (
        "pitch_mm = [20, 120]",
        "azimuths_deg = [[0, 0], [180, 180], [90, 90], [270, 270]]",
        "optimise.variables.azimuths_deg",
        "low = high fixes an entry, but not all",
    ),
    "length bounds": ("[0.25, 0.50]", "[0, 0.5]", "optimise.variables.arm_length", "low < high, above 0 (m)"),
    "bounds around no pitch": ("[20, 120]", "[-20, 120]", "optimise.variables.pitch_mm", "with no 0 from low to high"),
    "no pitch": ("arm_length_mm = 351", "pitch = 0", "geometry.pitch", "a finite number other than 0"),
    "sum's field": ('"rod_length"]', '"rod"]', "optimise.sums.fields", "found ["),
    "sum's dimension": ('"rod_length"]', '"pitch"]', "optimise.sums.fields", "a list out of arm_length"),
    "sum's bound": ("at_most = 1.151", "at_most = 0", "optimise.sums.at_most", "a length > 0"),
    "certified margin": (
        '["J_x", "fvi"]',
        '["J_x", "fvu"]',
        "certify.margins",
        "J_q, J_x, fvi, reach (did you mean fvi?)",
    ),
    "no tolerance": ("tolerance = 0.02", "tolerance = 0", "certify.tolerance", "a number above 0 and below 1"),
    "no boxes": ("most_boxes = 1000", "most_boxes = 3", "certify.most_boxes", "a whole number from 4"),
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
    "period": ("period = 0.001", "period = 0", "trajectory.period", "found 0; expected a time > 0, at most 1 (s)"),
    "law": ('"toppra"', '"topra"', "trajectory.law", "did you mean toppra?"),
    "file format": (
        "period = 0.001",
        'period = 0.001\nfiles = ["csv", "rso2"]',
        "trajectory.files",
        "ros2, cia402, zaber, xps, pmac (did you mean ros2?)",
    ),
    "no file format": ("period = 0.001", "period = 0.001\nfiles = []", "trajectory.files", "found []"),
    "increments": (
        "jerk = 1e5",
        "jerk = 1e5\n[trajectory.drive]\nincrements = [4096, 0]",
        "trajectory.drive.increments",
        "a whole number > 0, or one a joint",
    ),
    "payload": ("payload = 1.0", "payload = -1", "trajectory.cycle.payload", "a mass >= 0 (kg)"),
    "payload back": (
        "payload = 1.0",
        "payload = 1.0\npayload_back = -1",
        "trajectory.cycle.payload_back",
        "a mass >= 0",
    ),
    "line without its torque": ("jerk = 1e5", "no_load_speed = 30", "trajectory.limits.no_load_speed", "stall_torque"),
    "range": ("jerk = 1e5", "position = [2, 1]", "trajectory.limits.position", "low < high"),
    "one range of two": (
        "jerk = 1e5",
        "position = [[1, 2], [2, 1]]",
        "trajectory.limits.position",
        "such pair a joint",
    ),
    "rms": ("jerk = 1e5", "rms_torque = 0", "trajectory.limits.rms_torque", "a number > 0"),
    "joint limit": ("torque = 127", "torque = [1, 0]", "trajectory.limits.torque", "> 0, or one a joint"),
    "no limits": ("torque = 127", "torque = []", "trajectory.limits.torque", "found []"),
}


def refused(path: Path) -> StudyError:
    with pytest.raises(StudyError) as caught:
        load_study(read_toml(path))
    return caught.value


@pytest.mark.parametrize(("old", "new", "key", "says"), FAULTS.values(), ids=FAULTS)
def test_a_fault_names_file_key_line_and_what_was_expected(
    write: Write, study_text: str, old: str, new: str, key: str, says: str
) -> None:
    before, found, after = study_text.partition(old)
    assert found
    path = write(before + new + after)
    error = refused(path)
    [problem] = [problem for problem in error.faults if problem.key == key]
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
    ],
)
def test_a_missing_key_is_reported_at_its_table(
    write: Write, minimal_text: str, left_out: str, key: str, line: int
) -> None:
    error = refused(write(minimal_text.replace(left_out, "")))
    assert (error.key, error.line, error.found) == (key, line, "nothing")
    assert len(error.faults) == 1


def test_a_region_without_keys_lacks_its_kind(write: Write, minimal_text: str) -> None:
    error = refused(write(minimal_text.partition("kind")[0]))
    assert [(problem.key, problem.line) for problem in error.faults] == [("region.kind", 3)]


def test_a_missing_table_is_reported(write: Write, minimal_text: str) -> None:
    with pytest.raises(StudyError, match="region: found nothing; expected a table"):
        load_study(read_toml(write(minimal_text.partition("[region]")[0])))


@pytest.mark.parametrize(
    ("text", "key", "says"),
    [
        (
            "[trajectory]\ncycle = 3\n",
            "trajectory.cycle",
            "found 3; expected a table with one or more",
        ),
        ("[optimise]\nvariables = {}\n", "optimise.variables", "found an empty table; expected a table"),
        ("[inertia]\ndrive_train = 3\n", "inertia.drive_train", "found 3; expected a table with one or more of gear"),
        ("[[ranges]]\njoints = 3\n", "ranges", "found [a table]; expected a table with one or more of joints, passive"),
        ("[[fvi]]\nspeed = 1\n", "fvi", "found [a table]; expected a table"),
        ("[optimise]\nsums = [3]\n", "optimise.sums", "found 3; expected an array of tables"),
    ],
)
def test_what_should_be_a_table_is_told(write: Write, minimal_text: str, text: str, key: str, says: str) -> None:
    error = refused(write(minimal_text + text))
    [problem] = [problem for problem in error.faults if problem.key == key]
    assert says in str(problem)


@pytest.mark.parametrize(("region", "found"), [("3", "3"), ("[{ kind = 'box' }]", "[a table]")])
def test_a_region_that_is_no_table_is_told(write: Write, minimal_text: str, region: str, found: str) -> None:
    text = minimal_text.partition("[region]")[0] + f"region = {region}\n"
    error = refused(write(text))
    assert (error.key, error.line, error.found) == ("region", 3, found)


def test_a_box_may_not_name_a_coordinate_that_the_mechanism_lacks(write: Write, minimal_text: str) -> None:
    with pytest.raises(StudyError, match=r":9: region\.roll: found an unknown key; expected one of"):
        load_study(read_toml(write(minimal_text + "roll = 0\n")))


def test_a_misspelt_key_is_not_reported_as_missing_too(write: Write, study_text: str) -> None:
    error = refused(write(study_text.replace("radius =", "radus =").replace("lift_mm", "lift_inch")))
    assert [problem.key for problem in error.faults] == [
        "region.radus",
        "trajectory.cycle.lift_inch",
    ]


def test_a_key_and_its_misspelling_are_both_judged(write: Write, study_text: str) -> None:
    error = refused(write(study_text.replace("grid = 2000", "grid = 10\ngridd = 10")))
    assert [problem.key for problem in error.faults] == ["trajectory.grid", "trajectory.gridd"]


def test_all_faults_are_reported_one_a_line_in_the_files_order(write: Write, study_text: str) -> None:
    text = study_text.replace("= 0.5\n", "= -1\n").replace("[20, 120]", "[3]").replace("351", "0")
    path = write(text.replace("grid = 2000", "grid = 1").replace('"J_q"', "3").replace("theta_deg", "theta_m"))
    error = refused(path)
    lines = str(error).splitlines()
    assert [line.split(": ")[:2] for line in lines] == [
        [f"{path}:5", "geometry.arm_length_mm"],
        [f"{path}:10", "region.radius"],
        [f"{path}:12", "region.theta_m"],
        [f"{path}:26", "optimise.variables.pitch_mm"],
        [f"{path}:32", "requirement.margin"],
        [f"{path}:37", "trajectory.grid"],
    ]


def test_an_unknown_mechanism_does_not_hide_other_faults(write: Write, study_text: str) -> None:
    error = refused(write(study_text.replace('"Fake"', '"Nope"').replace("grid = 2000", "grid = 1")))
    assert [problem.key for problem in error.faults] == ["mechanism", "trajectory.grid"]


def test_the_second_row_of_an_array_of_tables_is_told_by_its_line(write: Write, minimal_text: str) -> None:
    rows = '[[requirement]]\nmargin = "J_q"\nat_least = 0\n[[requirement]]\nmargin = "x"\nat_least = 0\n'
    error = refused(write(minimal_text + rows))
    assert (error.key, error.line) == ("requirement.margin", 13)


def test_a_fault_in_an_inline_array_of_tables_has_its_own_line(write: Write, minimal_text: str) -> None:
    rows = 'requirement = [\n  { margin = "J_q", at_least = 0 },\n  { margin = "J_x", at_least = "0" },\n]\n'
    error = refused(write(rows + minimal_text))
    assert (error.key, error.line) == ("requirement.at_least", 3)


def test_a_second_requirement_on_a_margin_is_refused_and_both_lines_are_named(write: Write, minimal_text: str) -> None:
    row = '[[requirement]]\nmargin = "J_q"\nat_least = 0\n'
    error = refused(write(minimal_text + row + row))
    assert (error.key, error.line) == ("requirement.margin", 13)
    assert str(error).endswith(
        "found a second requirement on J_q; expected one requirement a margin; line 10 has the first one on J_q"
    )


@pytest.mark.parametrize(("margin", "told"), [("J_q", False), ("reach", True)])
def test_only_a_bound_of_reach_is_told_what_reach_expects(
    write: Write, minimal_text: str, margin: str, told: bool
) -> None:
    row = f'[[requirement]]\nmargin = "{margin}"\n'
    for bound in ("", "at_least = nan\n", "at_least = -inf\n"):
        error = refused(write(minimal_text + row + bound))
        assert error.key == "requirement.at_least"
        assert error.expected.startswith("a finite number")
        assert ("reach" in error.expected) <= told
    if told:
        assert "for the margin reach, 0 or more" in str(refused(write(minimal_text + row + "at_least = -1\n")))


def test_an_upper_bound_below_every_value_of_its_margin_is_refused(write: Write, minimal_text: str) -> None:
    error = refused(write(minimal_text + '[[requirement]]\nmargin = "mass"\nat_most = -1\n'))
    assert str(error).endswith("requirement.at_most: found -1; expected 0 or more, as mass is never below it")


def test_a_study_error_survives_pickling(write: Write) -> None:
    error = refused(write("a = 1"))
    assert isinstance(error, LinkwrightError)
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_a_screw_may_turn_further_than_once(write: Write, minimal_text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    text = minimal_text.replace("theta_deg = 90", "theta_deg = [-360, 360]")
    path = write(text)
    with pytest.raises(StudyError, match="at most a turn apart"):
        load_study(read_toml(path))
    monkeypatch.setattr(kinematics.MECHANISMS["Fake"], "counts_turns", True)
    assert load_study(read_toml(path)).region.coordinates["theta"] == pytest.approx((-2 * math.pi, 2 * math.pi))


def test_an_entry_of_a_list_of_bounds_may_be_fixed(write: Write, study_text: str) -> None:
    bounds = "azimuths_deg = [[0, 0], [170, 190], [90, 90], [270, 270]]"
    found = load_study(read_toml(write(study_text.replace("pitch_mm = [20, 120]", bounds)))).optimise
    assert found is not None
    assert found.variables["azimuths"][2] == (math.pi / 2, math.pi / 2)  # type: ignore[index]
