"""Imports run one way, other rooms use a room's door, no folder is crowded, and the map of the house is true."""

from __future__ import annotations

import ast
import re
from graphlib import CycleError, TopologicalSorter

import pytest

from tests.house import (
    FOLDERS,
    MODULES,
    PAGE,
    ROOT,
    imports,
    is_door,
    ours,
    reached_rooms,
    room_of,
    rooms,
    table,
    targets,
)

MOST_FILES = 15
BEFORE = {
    "kinematics": set[str](),
    "design": {"kinematics"},
    "trajectory": {"kinematics"},
    "studies": {"kinematics", "design", "trajectory"},
}


@pytest.mark.parametrize("folder", FOLDERS)
def test_a_folder_imports_only_those_before_it_and_through_their_doors(folder: str) -> None:
    for name in (m for m in MODULES if m.split(".")[0] == folder):
        outside = [t for t in ours(name) if t.split(".")[0] != folder]
        assert {t.split(".")[0] for t in outside} <= BEFORE[folder], name
        assert [t for t in outside if "." in t and t != "trajectory.drive_files"] == [], name


def test_a_room_is_entered_by_its_door() -> None:
    """A module is imported by its own name only from its own room, and from rooms inside the folder it stands in."""
    for name in (m for m in MODULES if not is_door(m)):
        here = room_of(name)
        past = [t for t in ours(name) if t in MODULES and not f"{here}.".startswith(f"{room_of(t)}.")]
        assert past == [], name


def test_rooms_import_in_no_circle() -> None:
    try:
        TopologicalSorter(rooms()).prepare()
    except CycleError as error:
        pytest.fail(f"a circle: {error.args[1]}")


@pytest.mark.parametrize("folder", [*FOLDERS, "tests", "docs"])
def test_no_folder_is_crowded(folder: str) -> None:
    for room in (ROOT / folder, *(p for p in (ROOT / folder).rglob("*") if p.is_dir())):
        assert sum(path.suffix in {".py", ".md", ".png"} for path in room.iterdir()) <= MOST_FILES, room


def test_the_map_of_the_house_is_true() -> None:
    assert table() in PAGE.read_text(), "`python -m tests.house` writes it anew"
    for path in re.findall(r"`((?:kinematics|design|trajectory|studies|tests)/[\w/.]*)`", PAGE.read_text()):
        assert (ROOT / path).exists(), path


def test_the_check_sees_imports_wherever_they_hide() -> None:
    code = "import os\ndef f():\n    import design.region\n    from studies import x\nfrom kinematics.arrays import y\n"
    assert {*targets(ast.parse(code))} == {"os", "design.region", "studies", "kinematics.arrays"}


def test_what_verifies_a_motion_knows_nothing_of_what_made_it() -> None:
    """It may know what a path, a motion and a limit are."""
    known = {room for room in reached_rooms("trajectory.verification") if room.startswith("trajectory")}
    models = {"trajectory", "trajectory.motions", "trajectory.paths", "trajectory.limits", "trajectory.limits.model"}
    assert known == {"trajectory.verification", *models}


def test_what_verifies_a_motion_asks_a_limit_for_its_use_alone() -> None:
    """Of what laws use too it imports what a path, a motion and a limit are: no kind of path, no constraint."""
    known = {
        "trajectory.paths": {"Path", "PathBox", "require_poses_of"},
        "trajectory.motions": {"InTime", "Motion", "PoseMotion", "TimedMotion", "motion_of"},
        "trajectory.limits": {"InstantLimit", "Limit", "Limits", "MeanSquareLimit", "Use", "mean_squares", "uses"},
    }
    found: dict[str, set[str]] = {}
    for name in (m for m in MODULES if room_of(m) == "trajectory.verification" and not is_door(m)):
        for node in ast.walk(ast.parse(MODULES[name].read_text())):
            if isinstance(node, ast.ImportFrom) and node.module in known:
                found.setdefault(node.module, set()).update(alias.name for alias in node.names)
    assert found == known


def test_no_law_imports_what_verifies_it() -> None:
    laws = [room for room in rooms() if room.startswith("trajectory.laws")]
    assert len(laws) > 3
    assert "trajectory.verification" not in reached_rooms(*laws)


def test_each_solver_is_imported_by_one_module() -> None:
    def users(solver: str) -> list[str]:
        return [name for name in MODULES if solver in {t.split(".")[0] for t in imports(name)}]

    assert users("ruckig") == ["trajectory.moves.ruckig_plan"]
    assert users("toppra") == []  # an oracle of the tests
