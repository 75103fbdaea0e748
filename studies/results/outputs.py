"""The files that a run writes into its folder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from design import certificate_bytes
from kinematics import Mechanism, mjcf
from studies.building import FRAME_FILE, drive_of, home_of, path_of, problem_of
from studies.committed import FILE, file_of, optimum_of, proof_files
from studies.report import html_report, pictures_of
from studies.results.output_folder import Contents, OutputFolder, Written, require_free
from studies.stages import Outcome, Proof, Question, Timing, claims_of
from studies.study_file import Study, TrajectoryTable, digest_of
from trajectory import frame_reaction_text, write_files
from trajectory.drive_files import drive_files

REPORT, MECHANISM = "report.html", "mechanism.png"
Files = dict[str, Contents]  # by kind


def run_names(study: Study, drive_files: Sequence[str]) -> list[str]:
    """The names of all files that a run writes."""
    return [*optimum_names(study), *report_names(drive_files)]


def optimum_names(study: Study) -> list[str]:
    """The names of the optimum and of the certificates beside it."""
    return [FILE, *(file_of(claim.margin) for claim in claims_of(study, problem_of(study)))]


def report_names(drive_files: Sequence[str]) -> list[str]:
    """The names of all files that a report writes."""
    return [REPORT, MECHANISM, *drive_files]


def made_for(study: Study, robot: Mechanism) -> str:
    """Digest of the question that files answer. The formats of the files do not change it."""
    asked = study.model_copy(update={"title": ""})
    if asked.trajectory is not None:
        asked = asked.model_copy(update={"trajectory": asked.trajectory.model_copy(update={"files": ("csv",)})})
    return digest_of({"study": asked.digest, "geometry": robot.geometry.digest})


def write_optimum(outcome: Outcome, folder: OutputFolder) -> Written:
    """Write the optimum alone, before its cycle and its proofs.

    Raises:
        RequirementFailed: a requirement is not met; nothing is written then.
        CannotWrite, FileInTheWay: as `OutputFolder.write`.
    """
    outcome.require_all()
    files = {"optimum": {FILE: optimum_of(outcome).text()}}
    return folder.write(files, made_for(outcome.study, outcome.robot))


def write_run(outcome: Outcome, folder: OutputFolder, command: str, beside: OutputFolder | None) -> Written:
    """Write optimum, certificates, report and set-points of an outcome of `certified`, which meets every requirement.

    `beside` is the study's folder if optimum and certificates go there too.

    Raises:
        CannotWrite, FileInTheWay: as `OutputFolder.write`.
    """
    question = made_for(outcome.study, outcome.robot)
    optimum: Files = {"optimum": {**proof_files(outcome.proofs), FILE: optimum_of(outcome).text()}}
    written = folder.write({**optimum, **_report(outcome, command)}, question)
    return written + beside.write(optimum, question) if beside else written


def write_report(outcome: Outcome, folder: OutputFolder, command: str) -> Written:
    """Write report and set-points; as `write_run`, without the optimum."""
    return folder.write(_report(outcome, command), made_for(outcome.study, outcome.robot))


def _report(outcome: Outcome, command: str) -> Files:
    pictures = pictures_of(outcome)
    files: Contents = {REPORT: html_report(outcome, pictures, command), MECHANISM: pictures[0][1]}
    asked = outcome.study.trajectory
    drives = _setpoints(outcome.timing, asked) if outcome.timing and asked else {}
    return {"report": files, "set-points": drives}


def write_proofs(question: Question, proofs: Sequence[Proof], folder: OutputFolder) -> Written:
    """Write every certificate. That of an undecided claim includes its undecided boxes.

    Raises:
        CannotWrite, FileInTheWay: as `OutputFolder.write`.
    """
    kinds = {p.certificate.margin: {claim_file(p.certificate.margin): certificate_bytes(p.certificate)} for p in proofs}
    files = {f"certificate of {margin}": file for margin, file in kinds.items()}
    return folder.write(files, made_for(question.study, question.robot))


def claim_file(margin: str) -> str:
    """The file that `certify` writes a margin's certificate to."""
    return f"{margin}.npz"


def write_model(robot: Mechanism, study: Study, rod_middle: float | None, file: Path, force: bool = False) -> Path:
    """Write the robot as an MJCF file: at the start of the study's cycle with the payload, else at home without load.

    Args:
        robot: the robot with its geometry and masses.
        study: the study with the cycle, if any.
        rod_middle: share of each rod's mass at its middle; None for the robot's own.
        file: the file to write.
        force: whether an existing file may be replaced.

    Raises:
        InvalidValue: MJCF cannot describe this mechanism.
        HomeOutOfReach, UnreachablePose: a limb cannot reach home, or the start.
        CannotWrite, FileInTheWay: the file cannot be written.
    """
    if study.trajectory is None:
        pose, payload = home_of(robot), 0.0
    else:
        path, payload = path_of(study.trajectory, robot.pose_names), study.trajectory.payload
        (pose,) = path.evaluate(np.array(0.0), 0)
    if rod_middle is not None:
        robot = robot.with_inertia(replace(robot.inertia, rod_middle=rod_middle))
    text = mjcf(robot, pose, payload)
    require_free(file, force, text)
    return write_files(file.parent, {file.name: text})[0]


def write_setpoints(timing: Timing, study: Study, folder: OutputFolder) -> Written:
    """Write only the set-points, in the formats that the study asks for.

    Raises:
        InvalidValue: a format cannot express them.
        CannotWrite, FileInTheWay: as `OutputFolder.write`.
    """
    assert study.trajectory is not None
    question = made_for(study, timing.cycle.robot)
    return folder.write({"set-points": _setpoints(timing, study.trajectory)}, question)


def _setpoints(timing: Timing, asked: TrajectoryTable) -> dict[str, str | bytes]:
    drive = drive_of(asked.drive)
    files = drive_files("cycle", timing.setpoints, asked.files, drive)
    files[FRAME_FILE] = frame_reaction_text(timing.cycle, asked.period)
    if timing.approach is not None:
        files |= drive_files("approach", timing.approach.setpoints, asked.files, drive)
    return files
