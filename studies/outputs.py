"""What a run leaves in its folder."""

from __future__ import annotations

from pathlib import Path

from studies.optimum import FILE, optimum_of
from studies.pipeline import Outcome, Timing
from studies.report import html_report, pictures_of
from trajectory import write_files
from trajectory.setpoint_file import setpoints_text


def write_outcome(outcome: Outcome, folder: Path, command: str, beside: Path | None) -> list[Path]:
    """Report, optimum and set-points; `beside` is the study's folder where the optimum is to be committed too.

    Raises:
        CannotWrite: the folder cannot be written to.
    """
    optimum = optimum_of(outcome).text()
    pictures = pictures_of(outcome)
    files: dict[str, str | bytes] = {
        FILE: optimum,
        "report.html": html_report(outcome, pictures, command),
        "mechanism.png": pictures[0][1],
    }
    if outcome.timing is not None:
        files |= _setpoints(outcome.timing)
    written = write_files(folder, files)
    return written + (write_files(beside, {FILE: optimum}) if beside else [])


def write_setpoints(timing: Timing, folder: Path) -> list[Path]:
    """Only the set-points.

    Raises:
        CannotWrite: the folder cannot be written to.
    """
    return write_files(folder, _setpoints(timing))


def _setpoints(timing: Timing) -> dict[str, str]:
    files = {"cycle.csv": setpoints_text(timing.setpoints)}
    if timing.approach is not None:
        files["approach.csv"] = setpoints_text(timing.approach.setpoints)
    return files
