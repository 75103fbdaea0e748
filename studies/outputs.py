"""What a run leaves in its folder."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from kinematics import Mechanism
from kinematics.mjcf import mjcf
from studies import setup
from studies.optimum import FILE, optimum_of
from studies.pipeline import Outcome, Timing
from studies.report import html_report, pictures_of
from studies.schema import Study
from trajectory import CannotWrite, write_files
from trajectory.setpoint_file import setpoints_text


def write_run(outcome: Outcome, folder: Path, command: str, beside: Path | None) -> list[Path]:
    """Optimum, report and set-points; `beside` is the study's folder where the optimum is to be committed too.

    Raises:
        RequirementFailed: a requirement is not met; nothing is written then.
        CannotWrite: the folder cannot be written to.
    """
    outcome.require_all()
    optimum = optimum_of(outcome).text()
    written = write_files(folder, {FILE: optimum, **_report(outcome, command)})
    return written + (write_files(beside, {FILE: optimum}) if beside else [])


def write_report(outcome: Outcome, folder: Path, command: str) -> list[Path]:
    """Report and set-points, as `write_run` but for the optimum."""
    outcome.require_all()
    return write_files(folder, _report(outcome, command))


def _report(outcome: Outcome, command: str) -> dict[str, str | bytes]:
    pictures = pictures_of(outcome)
    files: dict[str, str | bytes] = {"report.html": html_report(outcome, pictures, command)}
    files["mechanism.png"] = pictures[0][1]
    return files | (_setpoints(outcome.timing) if outcome.timing else {})


def write_setpoints(timing: Timing, folder: Path) -> list[Path]:
    """Only the set-points.

    Raises:
        CannotWrite: the folder cannot be written to.
    """
    return write_files(folder, _setpoints(timing))


def write_model(robot: Mechanism, study: Study, rod_middle: float, file: Path) -> Path:
    """The robot as an MJCF file that starts where the study's cycle does, with its payload; else at home, empty.

    Args:
        robot: whose geometry and masses are written.
        study: asks for the cycle.
        rod_middle: share of each rod's mass at its middle, in place of the robot's.
        file: what to write.

    Raises:
        InvalidValue: the mechanism has no such model.
        UnreachablePose: a limb cannot reach the start.
        CannotWrite: the file cannot be written.
    """
    pose, payload = np.array(robot.home), 0.0
    if study.trajectory is not None:
        cycle = study.trajectory.cycle
        (pose,), payload = setup.cycle_of(cycle).evaluate(np.array(0.0), 0), cycle.payload
    if file.is_dir():
        raise CannotWrite(file, "it is a folder")
    robot = type(robot)(robot.geometry, replace(robot.inertia, rod_middle=rod_middle))
    return write_files(file.parent, {file.name: mjcf(robot, pose, payload)})[0]


def _setpoints(timing: Timing) -> dict[str, str]:
    files = {"cycle.csv": setpoints_text(timing.setpoints)}
    if timing.approach is not None:
        files["approach.csv"] = setpoints_text(timing.approach.setpoints)
    return files
