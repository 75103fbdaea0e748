"""The package is light to import, and each solver is used from one module."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import trajectory

FOLDER = Path(trajectory.__file__).parent


def importers(of: str) -> set[str]:
    wanted = re.compile(rf"^\s*(?:from|import)\s+{of}\b", re.MULTILINE)
    return {file.name for file in FOLDER.glob("*.py") if wanted.search(file.read_text())}


def test_each_solver_is_imported_from_one_module() -> None:
    assert importers("toppra") == set()  # an oracle of the tests
    assert importers("ruckig") == {"ruckig_plan.py"}


def test_only_kinematics_is_imported_of_the_other_packages() -> None:
    assert importers("design") == importers("studies") == set()


def reached_from(*modules: str) -> set[str]:
    """These modules of the package and all of it that they import, one by way of another."""
    wanted, found = list(modules), set[str]()
    while wanted:
        name = wanted.pop()
        if name not in found:
            found.add(name)
            text = (FOLDER / f"{name}.py").read_text()
            wanted += re.findall(r"^\s*from trajectory\.(\w+) import", text, re.MULTILINE)
    return found


VERIFIERS = {"verification", "usage", "proof", "enclosure", "sampling"}


def test_what_verifies_a_motion_imports_the_motion_and_the_limits_alone() -> None:
    of_the_motion = {"timed", "timing", "motion", "knots", "path", "limits"}
    assert reached_from(*VERIFIERS) == VERIFIERS | of_the_motion


@pytest.mark.parametrize(
    "law",
    [
        "toppra_law",
        "lower_bound",
        "free_law",
        "jerk/law",
        "jerk/refinement",
        "jerk/rows",
        "jerk/refusal",
        "jerk/motion",
    ],
)
def test_no_law_imports_what_verifies_it(law: str) -> None:
    assert not reached_from(law) & VERIFIERS


def test_importing_the_package_loads_no_solver() -> None:
    code = "import sys, trajectory; sys.exit(any(m in sys.modules for m in ('toppra', 'ruckig', 'matplotlib')))"
    assert subprocess.run([sys.executable, "-c", code], cwd=FOLDER.parent, check=False).returncode == 0


def test_every_public_name_is_there() -> None:
    assert all(hasattr(trajectory, name) for name in trajectory.__all__)
    assert not hasattr(trajectory, "nothing")
