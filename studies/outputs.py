"""What a run leaves in its folder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from design import certificate_bytes
from kinematics import Mechanism
from kinematics.mjcf import mjcf
from studies import setup
from studies.certify import Proof
from studies.committed_proofs import proof_files
from studies.optimum import FILE, optimum_of
from studies.pipeline import Outcome, Timing
from studies.report import html_report, pictures_of
from studies.schema import Study
from studies.schema_trajectory import Trajectory
from trajectory import CannotWrite, write_files
from trajectory.drive_files import drive_files


def write_run(outcome: Outcome, folder: Path, command: str, beside: Path | None) -> list[Path]:
    """Optimum, certificates, report and set-points; `beside` is the study's folder where the first two go too.

    Raises:
        RequirementFailed: a requirement is not met; nothing is written then.
        CannotWrite: the folder cannot be written to.
    """
    outcome.require_all()
    optimum: dict[str, str | bytes] = {**proof_files(outcome.proofs), FILE: optimum_of(outcome).text()}
    written = write_files(folder, {**optimum, **_report(outcome, command)})
    return written + (write_files(beside, optimum) if beside else [])


def write_report(outcome: Outcome, folder: Path, command: str) -> list[Path]:
    """Report and set-points, as `write_run` but for the optimum."""
    outcome.require_all()
    return write_files(folder, _report(outcome, command))


def _report(outcome: Outcome, command: str) -> dict[str, str | bytes]:
    pictures = pictures_of(outcome)
    files: dict[str, str | bytes] = {"report.html": html_report(outcome, pictures, command)}
    files["mechanism.png"] = pictures[0][1]
    asked = outcome.study.trajectory
    return files | (_setpoints(outcome.timing, asked) if outcome.timing and asked else {})


def write_proofs(proofs: Sequence[Proof], folder: Path) -> list[Path]:
    """Every certificate, the boxes left of an undecided one included.

    Raises:
        CannotWrite: the folder cannot be written to.
    """
    return write_files(folder, {f"{p.certificate.margin}.npz": certificate_bytes(p.certificate) for p in proofs})


def write_model(robot: Mechanism, study: Study, rod_middle: float | None, file: Path) -> Path:
    """The robot as an MJCF file that starts where the study's cycle does, with its payload; else at home, empty.

    Args:
        robot: whose geometry and masses are written.
        study: asks for the cycle.
        rod_middle: share of each rod's mass at its middle; None for the robot's own.
        file: what to write.

    Raises:
        InvalidValue: the mechanism has no such model.
        UnreachablePose: a limb cannot reach the start.
        CannotWrite: the file cannot be written.
    """
    pose, payload = np.array(robot.home), 0.0
    if study.trajectory is not None:
        path, payload = setup.path_of(study.trajectory, robot.pose_names), study.trajectory.payload
        (pose,) = path.evaluate(np.array(0.0), 0)
    if file.is_dir():
        raise CannotWrite(file, "it is a folder")
    if rod_middle is not None:
        robot = type(robot)(robot.geometry, replace(robot.inertia, rod_middle=rod_middle), robot.ranges)
    return write_files(file.parent, {file.name: mjcf(robot, pose, payload)})[0]


def write_setpoints(timing: Timing, asked: Trajectory, folder: Path) -> list[Path]:
    """Only the set-points, in the formats asked for.

    Raises:
        InvalidValue: a format cannot say them.
        CannotWrite: the folder cannot be written to.
    """
    return write_files(folder, _setpoints(timing, asked))


def _setpoints(timing: Timing, asked: Trajectory) -> dict[str, str | bytes]:
    drive = setup.drive_of(asked.drive)
    files = drive_files("cycle", timing.setpoints, asked.files, drive)
    if timing.approach is not None:
        files |= drive_files("approach", timing.approach.setpoints, asked.files, drive)
    return files
