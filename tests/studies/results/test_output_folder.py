"""A folder of results: the program replaces and removes what it wrote itself, and nothing of the user's."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from studies.results.output_folder import LIST, FileInTheWay, OutputFolder
from trajectory import CannotWrite, write_files

FIRST = {"report": {"report.html": "one"}, "set-points": {"cycle.csv": "1", "cycle.ros2.yaml": "1"}}
SECOND = {"report": {"report.html": "two"}, "set-points": {"cycle.csv": "2"}}


def names(folder: Path) -> set[str]:
    return {str(file.relative_to(folder)) for file in folder.rglob("*") if file.is_file()}


def test_files_of_an_earlier_question_go_and_those_of_the_same_question_stay(tmp_path: Path) -> None:
    folder = OutputFolder(tmp_path)
    folder.write(FIRST, "payload 1")
    again = folder.write(SECOND, "payload 1")
    assert (again.removed, again.left) == ((), ())
    assert names(tmp_path) == {"report.html", "cycle.csv", "cycle.ros2.yaml", LIST}
    other = folder.write(SECOND, "payload 2")
    assert (other.removed, other.left) == ((tmp_path / "cycle.ros2.yaml",), ())
    assert names(tmp_path) == {"report.html", "cycle.csv", LIST}


def test_what_another_command_wrote_for_another_question_stays_and_is_told(tmp_path: Path) -> None:
    folder = OutputFolder(tmp_path)
    folder.write({"map": {"maps/fvi.png": b"1"}, **FIRST}, "payload 1")
    written = folder.write({"set-points": {"cycle.csv": "2"}}, "payload 2")
    assert written.removed == (tmp_path / "cycle.ros2.yaml",)
    assert set(written.left) == {tmp_path / "maps/fvi.png", tmp_path / "report.html"}
    emptied = folder.write({"map": {"map.png": b"2"}}, "payload 2")
    assert emptied.removed == (tmp_path / "maps/fvi.png",)
    assert not (tmp_path / "maps").exists()


def test_a_file_that_the_user_changed_is_neither_removed_nor_replaced(tmp_path: Path) -> None:
    folder = OutputFolder(tmp_path)
    folder.write(FIRST, "payload 1")
    (tmp_path / "cycle.ros2.yaml").write_text("my own")
    written = folder.write(SECOND, "payload 2")
    assert written.left == (tmp_path / "cycle.ros2.yaml",)
    (tmp_path / "cycle.csv").write_text("my own")
    for attempt in (lambda: folder.require(["cycle.csv"]), lambda: folder.write(FIRST, "payload 2")):
        with pytest.raises(FileInTheWay, match=r"cycle\.csv: found a file .* --force to replace it"):
            attempt()
    assert (tmp_path / "report.html").read_text() == "two"
    OutputFolder(tmp_path, force=True).write({"set-points": {"cycle.csv": "3"}}, "payload 3")
    assert (tmp_path / "cycle.csv").read_text() == "3"
    assert (tmp_path / "cycle.ros2.yaml").read_text() == "my own"


def test_a_link_is_the_users_and_what_it_leads_to_is_never_written(tmp_path: Path) -> None:
    (tmp_path / "mine.csv").write_text("mine")
    out = tmp_path / "out"
    out.mkdir()
    (out / "cycle.csv").symlink_to(tmp_path / "mine.csv")
    with pytest.raises(FileInTheWay):
        OutputFolder(out).write(SECOND, "a")
    OutputFolder(out, force=True).write(SECOND, "a")
    assert (tmp_path / "mine.csv").read_text() == "mine"
    assert not (out / "cycle.csv").is_symlink()


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "{}",
        '{"format": "linkwright files 1", "files": {"../study.toml": {"kind": "", "made_for": "", "sha256": ""}}}',
        '{"format": "linkwright files 1", "files": {"a": {"kind": 1, "made_for": "", "sha256": ""}}}',
        '{"format": "linkwright files 1", "files": {"a": 3}}',
        "[" * 100_000,
    ],
)
def test_a_list_that_is_none_is_refused_by_name(tmp_path: Path, text: str) -> None:
    (tmp_path / LIST).write_text(text)
    with pytest.raises(CannotWrite, match=LIST):
        OutputFolder(tmp_path).write(SECOND, "a")
    assert names(tmp_path) == {LIST}


def test_a_full_disk_leaves_everything_as_it_was(tmp_path: Path) -> None:
    """The largest file that may be written stands in for the disk."""
    folder = OutputFolder(tmp_path)
    folder.write(FIRST, "a")
    before = {name: (tmp_path / name).read_bytes() for name in names(tmp_path)}
    limits, ignored = resource.getrlimit(resource.RLIMIT_FSIZE), signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, limits[1]))
    try:
        with pytest.raises(CannotWrite, match="File too large"):
            folder.write({"report": {"report.html": "3"}, "set-points": {"cycle.csv": "x" * 20_000}}, "b")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, ignored)
    assert {name: (tmp_path / name).read_bytes() for name in names(tmp_path)} == before


def test_a_folder_that_stays_empty_is_not_left(tmp_path: Path) -> None:
    with pytest.raises(CannotWrite):
        OutputFolder(tmp_path / "new" / "out").write({"a": {"a\0": "1"}}, "a")
    assert list(tmp_path.iterdir()) == []


def test_an_interrupt_waits_until_the_files_are_written(tmp_path: Path) -> None:
    """One that comes between two replacements."""
    code = """
import os, signal, sys
from pathlib import Path
from trajectory import write_files
signal.signal(signal.SIGINT, lambda *_: os._exit(130))
replace = os.replace
def slow(*names):
    os.kill(os.getpid(), signal.SIGINT)
    replace(*names)
os.replace = slow
write_files(Path(sys.argv[1]), {"a": "1", "b": "2"})
"""
    ended = subprocess.run([sys.executable, "-c", code, str(tmp_path)], check=False, env=os.environ)
    assert ended.returncode == 130
    assert names(tmp_path) == {"a", "b"}


def test_two_commands_at_once_leave_the_files_of_one(tmp_path: Path) -> None:
    """Each writes forty times; every file and its entry in the list is of the same one in the end."""
    code = """
import sys
from pathlib import Path
from studies.results import OutputFolder
for k in range(40):
    OutputFolder(Path(sys.argv[1])).write({"a": {name: f"{sys.argv[2]} {k}" for name in "abcd"}}, sys.argv[2])
"""
    call = [sys.executable, "-c", code, str(tmp_path / "out")]
    both = [subprocess.Popen([*call, name]) for name in ("first", "second")]
    assert [process.wait() for process in both] == [0, 0]
    assert len({(tmp_path / "out" / name).read_text() for name in "abcd"}) == 1
    listed = json.loads((tmp_path / "out" / LIST).read_text())["files"]
    assert len({entry["made_for"] for entry in listed.values()}) == 1
    assert OutputFolder(tmp_path / "out").owns("a")


def test_a_folder_in_the_place_of_a_file_is_told(tmp_path: Path) -> None:
    (tmp_path / "cycle.csv").mkdir()
    with pytest.raises(CannotWrite, match=r"cycle\.csv: cannot write: it is a folder"):
        write_files(tmp_path, {"a": "1", "cycle.csv": "1"})
    assert names(tmp_path) == set()
