"""A small study, and the command line that runs it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

SMALL = """\
title = "Two variables"
mechanism = "Heli4"
dense_sample = 20_000

[region]
kind = "box"
x = [-0.2, 0.2]
y = [-0.2, 0.2]
z = [-0.76, -0.7]
theta_deg = [-90, 90]

[optimise]
starts = 1

[optimise.variables]
platform_radius_mm = [30, 80]
pitch = [0.02, 0.12]

[[requirement]]
margin = "internal_determinant"
at_least = 0.4

[certify]
margins = ["internal_determinant", "J_q"]
tolerance = 0.02

[trajectory]
law = "toppra"
grid = 1000
period = 0.002

[trajectory.cycle]
lift_mm = 25
span_mm = 300
blend_mm = 20
turn_deg = 90
pick = [-0.15, 0, -0.75]
payload = 0.5

[trajectory.limits]
speed_rpm = 190
torque = 127
"""

SmallRun = tuple[Path, subprocess.CompletedProcess[str]]  # the folder of study and optimum; how `run` ended


def linkwright(*arguments: object, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    call = [sys.executable, "-c", "from studies.cli import main; main()", *map(str, arguments)]
    environment = os.environ | {"COLUMNS": "200", "NO_COLOR": "1"}
    return subprocess.run(call, capture_output=True, text=True, cwd=cwd, check=False, env=environment)


def copy_of(run: Path, folder: Path) -> Path:
    """A copy of study, optimum and certificates; the optimum's path."""
    for name in ("study.toml", "optimum.toml"):
        shutil.copy(run / name, folder)
    shutil.copytree(run / "certificates", folder / "certificates")
    return folder / "optimum.toml"
