"""Names and files that nobody means: each is a named error, and no command hangs on one."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.studies.command_line import SMALL, linkwright
from tests.studies.stages.test_certify import GIVEN


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


@pytest.mark.parametrize(
    "given", ["", "x" * 5000, "a\0b", "\u0434\u0435\u043b\u044c\u0442\u0430", "/dev/null", "..", "~"]
)
def test_what_names_no_study_is_refused(given: str, tmp_path: Path) -> None:
    ended = linkwright("trajectory", given, cwd=tmp_path)
    assert ended.returncode == 2
    assert ended.stderr.startswith("linkwright: ")


def pipe(file: Path) -> None:
    os.mkfifo(file)


def loop(file: Path) -> None:
    file.symlink_to(file.name)


@pytest.mark.parametrize("make", [pipe, loop, Path.mkdir, Path.touch, lambda f: f.write_bytes(b"\0" * 99)])
def test_what_is_no_study_file_is_refused(make: Callable[[Path], object], tmp_path: Path) -> None:
    make(tmp_path / "study.toml")
    ended = linkwright("trajectory", tmp_path / "study.toml")
    assert ended.returncode == 2
    assert f"{tmp_path / 'study.toml'}" in ended.stderr


@pytest.mark.parametrize(
    "dressed",
    [lambda t: t.replace(b"\n", b"\r\n"), lambda t: b"\xef\xbb\xbf" + t, lambda t: t + b"# \xd0\xb4 \xe2\x98\x83\n"],
    ids=["CRLF", "BOM", "unicode"],
)
def test_a_study_as_another_system_saves_it_is_read(dressed: Callable[[bytes], bytes], tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_bytes(dressed(GIVEN.encode()))
    assert linkwright("certify", tmp_path, "--margin", "reach").returncode == 0


@pytest.mark.parametrize("out", ["/dev/null", "/dev/null/out", "/proc/out", "x" * 300, "study.toml"])
def test_a_folder_that_cannot_be_is_refused_before_any_work(out: str, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SMALL)
    for words in (["trajectory", "."], ["run", "."], ["map", "."], ["certify", "."], ["report", "."]):
        more = [] if words[0] == "run" else ["--prototype"]
        ended = linkwright(*words, *more, "--out", out, cwd=tmp_path)
        assert ended.returncode == 2
        assert "cannot write" in ended.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["study.toml"]


@pytest.mark.parametrize("out", [".", "x" * 300, "/", "/dev/null/robot.xml"])
def test_a_model_that_cannot_be_written_is_refused(out: str, tmp_path: Path) -> None:
    ended = linkwright("export", "heli4", "--prototype", "--out", out, cwd=tmp_path)
    assert ended.returncode == 2
    assert "cannot write" in ended.stderr


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ("period = 0.002", "period = 1e-300", "trajectory.period"),
        ("period = 0.002", "period = 1e-9", "trajectory.period"),
        ("speed_rpm = 190", "speed = 1e300", "trajectory.limits.speed"),
        ("speed_rpm = 190", "speed = 1e-9", "trajectory.period"),
        ("z = [-0.76, -0.7]", "z = [-1e308, 1e308]", "region.z"),
        ("payload = 0.5", "payload = 1e200", "trajectory.cycle.payload"),
        ("at_least = 0.4", "at_least = -1e308", "requirement.at_least"),
    ],
)
def test_a_number_that_no_machine_has_is_refused_at_its_key(old: str, new: str, key: str, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SMALL.replace(old, new))
    ended = linkwright("trajectory", tmp_path, "--prototype")
    assert ended.returncode == 2
    assert f": {key}: found " in ended.stderr
