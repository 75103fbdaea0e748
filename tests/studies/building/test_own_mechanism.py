"""The example of docs/new_mechanism.md, in a module beside a study, is used from it, and runs only where it may."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable
from importlib.metadata import EntryPoint
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest

from studies.building import mechanisms
from tests.studies.command_line import Ended, linkwright

PAGE = (Path(__file__).parents[3] / "docs" / "new_mechanism.md").read_text()
Case = Callable[..., Path]


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def block(language: str) -> str:
    (text,) = re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)
    return str(text)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page's module beside the page's study, and its run with --commit."""
    folder = tmp_path_factory.mktemp("biglide")
    (folder / "biglide.py").write_text(block("python"))
    (folder / "study.toml").write_text(block("toml"))
    ended = linkwright("run", folder / "study.toml", "--out", folder / "out", "--commit", "--allow-code", "--json")
    assert ended.returncode == 0, ended.stderr
    return folder


def on(folder: Path, command: str, *options: object) -> Ended:
    return linkwright(command, folder / "study.toml", *options, "--allow-code", "--json")


@pytest.fixture
def other(folder: Path, tmp_path: Path) -> Case:
    """Writes a study of the example with another module or another name for its mechanism."""

    def write(module: str | None = None, name: str = "biglide:Biglide") -> Path:
        if module is not None:
            (tmp_path / "biglide.py").write_text(module)
        study = tmp_path / "study.toml"
        study.write_text((folder / "study.toml").read_text().replace("biglide:Biglide", name))
        return study

    return write


def test_a_study_beside_the_module_runs_the_whole_way(folder: Path) -> None:
    assert {"optimum.toml", "report.html", "cycle.csv"} <= {path.name for path in (folder / "out").iterdir()}
    assert 'mechanism = "biglide:Biglide"' in (folder / "optimum.toml").read_text()
    timed = on(folder, "trajectory")
    assert timed.returncode == 0
    assert max(json.loads(timed.stdout)["peak_over_limit"].values()) <= 1.0
    proved = on(folder, "certify", "--margin", "J_q", "--at-least", "0.3")
    assert proved.returncode == 0, proved.stderr
    checked = on(folder, "check")
    assert checked.returncode == 0, checked.stdout


def test_its_export_follows_from_its_bodies_and_closes_at_the_start(folder: Path, tmp_path: Path) -> None:
    ended = on(folder, "export", "--rods", "uniform", "--out", tmp_path / "biglide.xml")
    assert ended.returncode == 0, ended.stderr
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "biglide.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert np.abs(data.efc_pos).max() < 1e-14
    assert model.nv - np.linalg.matrix_rank(data.efc_J.reshape(-1, model.nv)) == 2
    assert [data.joint(name).qpos[0] for name in ("x", "y")] == [-0.08, -0.38]
    assert ElementTree.parse(tmp_path / "biglide.xml").getroot().get("model") == "Biglide"


@pytest.mark.parametrize(
    "words",
    [
        ("run",),
        ("optimise",),
        ("map",),
        ("certify",),
        ("trajectory",),
        ("report",),
        ("export", "--out", "x.xml"),
        ("check",),
    ],
    ids=lambda words: words[0],
)
def test_no_command_runs_the_module_unless_it_is_told_to(words: tuple[str, ...], other: Case, tmp_path: Path) -> None:
    study = other("from pathlib import Path\n(Path(__file__).parent / 'ran').touch()\n" + block("python"))
    command, *options = words
    ended = linkwright(command, study, *options, cwd=tmp_path)
    assert ended.returncode == 2
    for part in (f"{study}:2: mechanism", '"biglide:Biglide"', "biglide.py beside the study", "--allow-code"):
        assert part in ended.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["biglide.py", "study.toml"]


def test_a_module_on_pythons_path_is_found_and_not_run_without_the_option(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, other: Case
) -> None:
    package = tmp_path / "path" / "my_robots"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("")
    (package / "slides.py").write_text(block("python"))
    monkeypatch.syspath_prepend(str(tmp_path / "path"))
    study = other(name="my_robots.slides:Biglide")
    refused = linkwright("optimise", study)
    assert refused.returncode == 2
    assert "the module my_robots.slides" in refused.stderr
    assert "my_robots" not in sys.modules
    ended = linkwright("trajectory", study, "--allow-code", "--prototype", "--json")
    assert ended.returncode == 0, ended.stderr
    assert json.loads(ended.stdout)["mechanism"] == "Biglide"


def test_an_installed_packages_mechanism_is_listed_unloaded_and_needs_no_option(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, other: Case
) -> None:
    (tmp_path / "installed_slides.py").write_text(block("python"))
    monkeypatch.syspath_prepend(str(tmp_path))
    point = EntryPoint("Slides", "installed_slides:Biglide", mechanisms.GROUP)
    monkeypatch.setattr(mechanisms, "entry_points", lambda group: [point] if group == mechanisms.GROUP else [])
    listed = json.loads(linkwright("list", "--json").stdout)
    assert listed["mechanisms"]["Slides"] == "installed: installed_slides:Biglide"
    assert "installed_slides" not in sys.modules
    ended = linkwright("trajectory", other(name="Slides"), "--prototype", "--json")
    assert ended.returncode == 0, ended.stderr


BROKEN = {
    "no module": (None, "slides:Biglide", "no module slides", "slides.py beside the study"),
    "no class": ("", "biglide:Biglide", "no Biglide in biglide.py", "a mechanism there"),
    "another class": (block("python"), "biglide:Bigslide", "no Bigslide in", "did you mean Biglide?"),
    "no mechanism": ("Biglide = 3", "biglide:Biglide", "found 3", "derived from kinematics.Mechanism"),
    "no Python": ("def", "biglide:Biglide", "SyntaxError", "biglide.py:1"),
    "it raises": ("x = 1\nx / 0", "biglide:Biglide", "ZeroDivisionError", "biglide.py:2"),
    "it imports what is not there": ("import not_there", "biglide:Biglide", "No module named 'not_there'", ":1"),
    "it leaves": ("import sys\nsys.exit(0)", "biglide:Biglide", "SystemExit", "biglide.py:2"),
    "hooks are missing": (
        "from kinematics import Mechanism\nclass Biglide(Mechanism):\n    joint_units = ('m',)\n",
        "biglide:Biglide",
        "a mechanism without Geometry, Inertia, assembly_modes",
        "all hooks of docs/new_mechanism.md",
    ),
    "a closure that raises": (
        block("python").replace("rods = Biglide.rods(pose, joints)", "raise ValueError('here')"),
        "biglide:Biglide",
        "ValueError: here",
        "biglide.py:",
    ),
    "a member that joins nothing": (
        block("python").replace('(f"slide {k + 1}", "tool")', '(f"nowhere {k + 1}",)'),
        "biglide:Biglide",
        "'nowhere 1'",
        'a joint that another member has too, or "base"',
    ),
    "no name": (None, "biglide:", 'found "biglide:"', '"module:Class", or one of'),
    "a path": (None, "../biglide.py:Biglide", 'found "../biglide.py:Biglide"', '"module:Class", or one of'),
}


@pytest.mark.parametrize(("module", "name", "found", "expected"), BROKEN.values(), ids=BROKEN)
def test_a_module_that_cannot_be_used_is_told_at_its_key(
    module: str | None, name: str, found: str, expected: str, other: Case
) -> None:
    study = other(module, name)
    ended = linkwright("optimise", study, "--allow-code", "--json")
    assert ended.returncode == 2
    (problem,) = json.loads(ended.stdout)["problems"]
    assert (problem["key"], problem["line"]) == ("mechanism", 2)
    assert found in ended.stderr
    assert expected in ended.stderr


def test_two_studies_may_each_have_a_module_of_the_same_name(folder: Path, other: Case) -> None:
    """Each is read from beside its own study, in one command."""
    study = other("raise RuntimeError('the other one')")
    ended = linkwright("check", folder / "study.toml", study, "--allow-code", "--json")
    assert "the other one" in ended.stderr


def test_an_optimum_of_a_module_that_was_changed_answers_another_question(folder: Path, tmp_path: Path) -> None:
    for name in ("study.toml", "optimum.toml"):
        (tmp_path / name).write_text((folder / name).read_text())
    (tmp_path / "biglide.py").write_text(block("python") + "# changed\n")
    ended = linkwright("trajectory", tmp_path / "study.toml", "--allow-code")
    assert ended.returncode == 2
    assert "code was" in ended.stderr
