"""The package is light to import, and each solver is used from one module."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import trajectory

FOLDER = Path(trajectory.__file__).parent


def importers(of: str) -> set[str]:
    wanted = re.compile(rf"^\s*(?:from|import)\s+{of}\b", re.MULTILINE)
    return {file.name for file in FOLDER.glob("*.py") if wanted.search(file.read_text())}


def test_each_solver_is_imported_from_one_module() -> None:
    assert importers("toppra") == set()  # an oracle of the tests
    assert importers("ruckig") == {"moves.py"}


def test_only_kinematics_is_imported_of_the_other_packages() -> None:
    assert importers("design") == importers("studies") == set()


def test_importing_the_package_loads_no_solver() -> None:
    code = "import sys, trajectory; sys.exit(any(m in sys.modules for m in ('toppra', 'ruckig', 'matplotlib')))"
    assert subprocess.run([sys.executable, "-c", code], cwd=FOLDER.parent, check=False).returncode == 0


def test_every_public_name_is_there() -> None:
    assert all(hasattr(trajectory, name) for name in trajectory.__all__)
    assert not hasattr(trajectory, "nothing")
