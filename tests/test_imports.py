"""Importing is quick, and nothing at import needs a system that forks or locks files."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BLOCKED = """
import builtins, os, sys
for name in ("register_at_fork", "sched_getaffinity", "fork"):
    if hasattr(os, name):
        delattr(os, name)
for name in ("fcntl", "resource", "pwd", "grp", "termios"):
    sys.modules[name] = None
"""


def ran(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("package", ["kinematics", "design", "trajectory"])
def test_importing_loads_neither_scipys_solvers_nor_pictures(package: str) -> None:
    slow = ("scipy.optimize", "scipy.spatial", "matplotlib", "ruckig", "toppra")
    code = f"import sys, {package}; print([m for m in {slow} if m in sys.modules])"
    assert ran(code).stdout.strip() == "[]"


def test_nothing_at_import_exists_on_posix_alone() -> None:
    modules = "kinematics, design, trajectory, studies.cli, studies.stages, studies.results, studies.committed"
    ended = ran(f"{BLOCKED}\nimport {modules}")
    assert ended.returncode == 0, ended.stderr
