"""The package is light to import."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import trajectory


def test_importing_the_package_loads_no_solver() -> None:
    code = "import sys, trajectory; sys.exit(any(m in sys.modules for m in ('toppra', 'ruckig', 'matplotlib')))"
    root = Path(trajectory.__file__).parents[1]
    assert subprocess.run([sys.executable, "-c", code], cwd=root, check=False).returncode == 0


def test_every_public_name_is_there() -> None:
    assert all(hasattr(trajectory, name) for name in trajectory.__all__)
    assert not hasattr(trajectory, "nothing")
