"""`linkwright export`: the model of a committed optimum, for a simulator."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest

from studies.building.load import load_study
from studies.building.objects import robot_of
from studies.committed.optimum import committed
from studies.study_file.locate import FOLDER
from studies.study_file.toml_file import read_toml
from tests.studies.command_line import linkwright


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


@pytest.mark.parametrize("rods", ["split", "uniform"])
@pytest.mark.parametrize("study", ["heli4", "redundant_3t1r", "peppermill", "gough_stewart"])
def test_the_file_starts_at_the_studys_cycle_with_its_loops_closed(study: str, rods: str, tmp_path: Path) -> None:
    file = tmp_path / "models" / "robot.xml"
    ended = linkwright("export", study, "--format", "mjcf", "--rods", rods, "--out", file, "--json")
    assert json.loads(ended.stdout) == {"files": [str(file)]}
    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert np.abs(data.efc_pos).max() < 1e-14
    asked = load_study(read_toml(FOLDER / study / "study.toml"))
    robot = committed(asked, FOLDER / study) or robot_of(asked)
    start = robot.home
    if asked.trajectory:  # none of these cycles starts turned
        start = [*asked.trajectory.cycle.pick, *np.zeros(len(robot.rotations))]
    assert [data.joint(name).qpos[0] for name in robot.pose_names] == pytest.approx(start, abs=1e-15)
    joints = [data.joint(name).qpos[0] for name in robot.joint_names]
    assert joints == pytest.approx(robot.inverse(np.array(start)).tolist(), abs=1e-14)


def test_prototype_and_optimum_are_different_files(tmp_path: Path) -> None:
    texts = []
    for more in ([], ["--prototype", "--force"]):
        assert linkwright("export", "heli4", "--out", tmp_path / "robot.xml", *more).returncode == 0
        texts.append((tmp_path / "robot.xml").read_text())
        assert ElementTree.fromstring(texts[-1]).tag == "mujoco"
    assert texts[0] != texts[1]
    assert [p.name for p in tmp_path.iterdir()] == ["robot.xml"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["heli4", "--format", "urdf", "--out", "robot.xml"], "'urdf' is not"),
        (["heli4", "--rods", "thick", "--out", "robot.xml"], "'thick' is not"),
        (["heli4"], "--out"),
        (["heli5", "--out", "robot.xml"], "heli5"),
        (["heli4", "--out", "folder"], "folder"),
    ],
)
def test_wrong_input_exits_2_and_leaves_nothing(words: list[str], message: str, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    ended = linkwright("export", *words, cwd=tmp_path)
    assert ended.returncode == 2
    assert message in ended.stderr
    assert [p.name for p in tmp_path.rglob("*")] == ["folder"]


def test_a_file_that_is_there_stays_unless_it_is_forced_or_the_very_same(tmp_path: Path) -> None:
    file = tmp_path / "robot.xml"
    for _ in range(2):
        assert linkwright("export", "heli4", "--prototype", "--out", file).returncode == 0
    file.write_text("mine")
    ended = linkwright("export", "heli4", "--prototype", "--out", file, "--json")
    assert ended.returncode == 2
    assert "--force" in json.loads(ended.stdout)["error"]
    assert file.read_text() == "mine"


def test_a_mechanism_without_a_model_is_named(
    tmp_path: Path,
) -> None:
    study = tmp_path / "par4" / "study.toml"
    study.parent.mkdir()
    (study.parent / "unclear.py").write_text(
        "from kinematics import Par4\nfrom kinematics.model.definition import Definition\n"
        "class Unclear(Par4):\n    link_tree = Definition.link_tree\n"
    )
    study.write_text(
        'title = "Par4"\nmechanism = "unclear:Unclear"\n[region]\nkind = "box"\n'
        "x = [-0.1, 0.1]\ny = [-0.1, 0.1]\nz = [-0.8, -0.7]\ntheta = 0\n"
        '[[requirement]]\nmargin = "reach"\nat_least = 0.0\n'
    )
    ended = linkwright("export", study, "--out", tmp_path / "model.xml", "--allow-code")
    assert ended.returncode == 2
    assert "links of Unclear for simulators: found half 1" in ended.stderr
