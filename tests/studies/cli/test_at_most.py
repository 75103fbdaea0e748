"""A study that requires an accuracy and a mass: read, run, checked, mapped and told in its own words."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

from kinematics import Delta, DriveTrain, Heli4
from kinematics.machine import ROTARY
from studies.building.load import load_study
from studies.building.objects import robot_of
from studies.study_file.toml_file import read_toml
from tests.studies.command_line import Ended, linkwright

STUDY = """\
title = "An accurate Delta"
mechanism = "Delta"
dense_sample = 10_000

[region]
kind = "box"
x = [-0.2, 0.2]
y = [-0.1, 0.1]
z = [-0.72, -0.65]

[inertia.drive_train]
backlash_deg = 0.002

[optimise]
starts = 1
[optimise.variables]
arm_length = [0.25, 0.45]
rod_length = [0.7, 0.9]

[[requirement]]
margin = "position_accuracy"
at_most = 8e-5

[[requirement]]
margin = "mass"
at_most = 4

[certify]
margins = ["position_accuracy", "mass"]
"""
Run = tuple[Path, Ended]
MASS = float(Delta().margin("mass", Delta().home))


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def written(folder: Path, text: str = STUDY) -> Path:
    (folder / "study.toml").write_text(text)
    return folder / "study.toml"


@pytest.fixture(scope="module")
def ended(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("accurate")
    return folder, linkwright("run", written(folder), "--commit", "--out", folder / "out", "--json")


def test_the_run_keeps_and_proves_both_upper_bounds(ended: Run) -> None:
    data = json.loads(ended[1].stdout)
    assert ended[1].returncode == 0
    assert 7.9e-5 < data["worst"]["position_accuracy"]["value"] <= 8e-5
    found = Delta(Delta.Geometry(**data["geometry"]))
    assert data["worst"]["mass"]["value"] == pytest.approx(float(found.margin("mass", found.home)))
    assert data["worst"]["mass"]["value"] < 4.0
    assert "position_accuracy at its upper bound 8e-05" in data["active"]
    proofs = {proof["margin"]: proof for proof in data["proofs"]}
    assert [(p["status"], p["at_most"]) for p in proofs.values()] == [("proved", 8e-5), ("proved", 4.0)]
    assert all("at_least" not in proof and proof["gap"] >= 0.0 for proof in proofs.values())


def test_its_optimum_is_verified_again_and_a_false_bound_is_found(ended: Run) -> None:
    optimum = ended[0] / "optimum.toml"
    checked = linkwright("check", ended[0], "--verbose")
    assert checked.returncode == 0
    assert "position_accuracy <= 8e-05 everywhere" in checked.stdout
    assert "mass <= 4 everywhere" in checked.stdout
    text = optimum.read_text()
    try:
        optimum.write_text(text.replace("at_most = 8e-05\nstatus", "at_most = 7e-05\nstatus"))
        assert "certificate.position_accuracy.at_most" in linkwright("check", ended[0]).stdout
    finally:
        optimum.write_text(text)


def test_an_optimum_for_other_drives_answers_another_question(ended: Run, tmp_path: Path) -> None:
    asked = written(tmp_path, STUDY.replace("backlash_deg = 0.002", "backlash_deg = 0.001"))
    (tmp_path / "optimum.toml").write_text((ended[0] / "optimum.toml").read_text())
    result = linkwright("certify", asked)
    assert result.returncode == 2
    assert "inertia.drive_train.backlash was" in " ".join(result.stderr.split())


def test_no_printed_number_has_the_sign_of_a_search(ended: Run) -> None:
    page = (ended[0] / "out" / "report.html").read_text()
    told = (
        re.sub(r"<img[^>]*>", "", page)
        + (ended[0] / "optimum.toml").read_text()
        + linkwright("certify", ended[0]).stdout
    )
    for line in re.split(r"\n|<tr>", told):
        if re.search("position_accuracy|mass", line) and "pose" not in line:
            assert not re.search(r"(?<![\w(, ])-\d|(<td>|= )-\d", line), line
    assert "&lt;= 8e-05" in page


def test_the_best_bound_is_the_smallest_that_is_proved(tmp_path: Path) -> None:
    text = STUDY.replace('margin = "position_accuracy"\nat_most = 8e-5', 'margin = "reach"\nat_least = 0.01')
    result = linkwright("certify", written(tmp_path, text), "--prototype", "--margin", "position_accuracy", "--json")
    (proof,) = json.loads(result.stdout)["proofs"]
    assert proof["status"] == "proved"
    assert proof["sampled"] < proof["at_most"] < 1.011 * proof["sampled"]


def test_a_bound_that_does_not_hold_names_file_line_key_and_both_numbers(tmp_path: Path) -> None:
    text = re.sub(r"\[optimise\].*?(?=\[\[req)", "", STUDY, flags=re.DOTALL).replace("at_most = 4", "at_most = 3.5")
    study = written(tmp_path, text)
    result = linkwright("run", study, "--out", tmp_path / "out")
    assert result.returncode == 1
    line = text.splitlines().index("at_most = 3.5") + 1
    told = " ".join(result.stderr.split())
    assert f"{study}:{line}: requirement.at_most: mass: found {MASS:.6g} at pose" in told
    assert "expected at most 3.5" in told
    data = json.loads(linkwright("run", study, "--out", tmp_path / "out", "--json").stdout)
    failed = next(one for one in data["failed"] if one["margin"] == "mass")
    assert (failed["at_most"], failed["found"]) == (3.5, pytest.approx(MASS))
    assert "at_least" not in failed


@pytest.mark.parametrize(
    ("change", "key", "words"),
    [
        (("at_most = 4", "at_least = 4"), "at_least", "expected at_most, as mass is better smaller"),
        (("at_most = 4", "at_most = 4\nat_least = 1"), "at_least", "expected at_most, as mass is better smaller"),
        (("at_most = 4", ""), "at_most", "found nothing; expected a finite number"),
        (("at_most = 4", "at_most = inf"), "at_most", "found inf; expected a finite number"),
        (('margin = "mass"', 'margin = "J_q"'), "at_most", "expected at_least, as J_q is better larger"),
    ],
)
def test_the_wrong_word_is_named_with_its_key(change: tuple[str, str], key: str, words: str, tmp_path: Path) -> None:
    study = written(tmp_path, STUDY.replace(*change))
    result = linkwright("run", study)
    told = " ".join(result.stderr.split())
    assert result.returncode == 2
    assert f"requirement.{key}: " in told
    assert words in told
    assert told.count("expected") == 1


@pytest.mark.parametrize("command", ["map", "certify"])
def test_the_wrong_option_is_named(command: str, ended: Run) -> None:
    result = linkwright(command, ended[0], "--margin", "mass", "--at-least", 4)
    assert result.returncode == 2
    assert "--at-least: found 4.0; expected --at-most, as mass is better smaller" in " ".join(result.stderr.split())


def test_a_map_takes_the_studys_upper_bound_or_another(ended: Run, tmp_path: Path) -> None:
    asked = ("map", ended[0], "--margin", "position_accuracy", "--at", "z=-0.7", "--tolerance", 0.02, "--json")
    own = json.loads(linkwright(*asked, "--out", tmp_path / "a").stdout)
    assert own["bound"] == 8e-5
    smaller = json.loads(linkwright(*asked, "--at-most", own["mean"], "--out", tmp_path / "b").stdout)
    assert smaller["bound"] == own["mean"]
    assert 0.0 < smaller["area"] < own["area"]
    assert smaller["mean"] < own["mean"] < smaller["worst"]


def test_a_partial_table_keeps_the_mechanisms_own_resolution(tmp_path: Path) -> None:
    train = robot_of(load_study(read_toml(written(tmp_path)))).inertia.drive_train
    assert train.encoder_resolution == ROTARY.encoder_resolution > 0.0
    assert train.backlash == pytest.approx(math.radians(0.002))
    assert Heli4().inertia.drive_train == replace(ROTARY, stiffness=1e5)
    assert DriveTrain().encoder_resolution == 0.0
