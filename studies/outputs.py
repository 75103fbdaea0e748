"""What a run leaves in its folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from design import certificate_bytes
from studies.certify import Proof
from studies.committed_proofs import proof_files
from studies.optimum import FILE, optimum_of
from studies.pipeline import Outcome, Timing
from studies.report import html_report, pictures_of
from studies.schema import Trajectory
from studies.setup import drive_of
from trajectory import write_files
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


def write_setpoints(timing: Timing, asked: Trajectory, folder: Path) -> list[Path]:
    """Only the set-points, in the formats asked for.

    Raises:
        InvalidValue: a format cannot say them.
        CannotWrite: the folder cannot be written to.
    """
    return write_files(folder, _setpoints(timing, asked))


def _setpoints(timing: Timing, asked: Trajectory) -> dict[str, str | bytes]:
    drive = drive_of(asked.drive)
    files = drive_files("cycle", timing.setpoints, asked.files, drive)
    if timing.approach is not None:
        files |= drive_files("approach", timing.approach.setpoints, asked.files, drive)
    return files
