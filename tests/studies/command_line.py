"""A small study, and the command line that runs it."""

from __future__ import annotations

import io
import os
import shutil
import signal
import subprocess
import sys
import warnings
from contextlib import ExitStack, chdir, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import pytest

from studies.cli.app import main

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


@dataclass(frozen=True)
class Ended:
    """How a command ended, and what it printed."""

    returncode: int
    stdout: str
    stderr: str


SmallRun = tuple[Path, Ended]  # the folder of study and optimum; how `run` ended
ENVIRONMENT = {"COLUMNS": "200", "NO_COLOR": "1"}


def linkwright(*arguments: object, cwd: Path | None = None) -> Ended:
    """The command in this process, which has the libraries loaded; a traceback would come through as its exception."""
    words, out, err = ["linkwright", *map(str, arguments)], io.StringIO(), io.StringIO()
    handlers = {kind: signal.getsignal(kind) for kind in (signal.SIGINT, signal.SIGTERM)}
    with ExitStack() as stack:
        for kind, handler in handlers.items():
            stack.callback(signal.signal, kind, handler)
        stack.enter_context(warnings.catch_warnings())
        stack.enter_context(patch.object(sys, "argv", words))
        stack.enter_context(patch.dict(os.environ, ENVIRONMENT))
        stack.enter_context(chdir(cwd or Path.cwd()))
        stack.enter_context(redirect_stdout(out))
        stack.enter_context(redirect_stderr(err))
        with pytest.raises(SystemExit) as left:
            main()
    assert isinstance(left.value.code, int)
    return Ended(left.value.code, out.getvalue(), err.getvalue())


def linkwright_apart(*arguments: object) -> Ended:
    """The command in a process of its own, its output in pipes."""
    call = [sys.executable, "-c", "from studies.cli import main; main()", *map(str, arguments)]
    ended = subprocess.run(call, capture_output=True, text=True, check=False, env=os.environ | ENVIRONMENT)
    return Ended(ended.returncode, ended.stdout, ended.stderr)


def copy_of(run: Path, folder: Path) -> Path:
    """A copy of study, optimum and certificates; the optimum's path."""
    for name in ("study.toml", "optimum.toml"):
        shutil.copy(run / name, folder)
    shutil.copytree(run / "certificates", folder / "certificates")
    return folder / "optimum.toml"
