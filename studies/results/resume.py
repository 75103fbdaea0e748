"""A run into a folder. It writes its optimum before the cycle and the proofs, and the next run can start from it."""

from __future__ import annotations

from design import Certificate, UnreadableCertificate
from kinematics import Mechanism
from studies.committed import FILE, Optimum, committed_certificates, read_optimum
from studies.errors import StudyError
from studies.results.output_folder import OutputFolder
from studies.results.outputs import write_optimum
from studies.stages import Lasting, Outcome, Progress, certified, designed, with_cycle, with_unasked
from studies.study_file import Study


def run_into(folder: OutputFolder, study: Study, fresh: bool, progress: Progress) -> Outcome:
    """All stages of a run.

    Args:
        folder: where the optimum is kept.
        fresh: whether to optimise even if the folder has an optimum for the study's design question.

    Raises:
        LinkwrightError: any error of a stage. An optimum that was found before it stays in the folder.
    """
    known = None if fresh else known_optimum(folder, study)
    if known is not None:
        progress(
            Lasting(f"{folder.path / FILE}: used, as it answers the same design question (--fresh optimises again)")
        )
        robot = known.robot(study)
        outcome = designed(study, robot, progress, str(known.data["made_by"]["solver_status"]))
        certificates = _known_certificates(folder, study, robot)
    else:
        outcome, certificates = designed(study, None, progress), {}
        if study.optimise is not None:
            written = write_optimum(outcome, folder)
            progress(Lasting(f"{folder.path / FILE}: written, before the cycle and the proofs"))
            for path in written.left:
                progress(Lasting(f"{path}: from an earlier command; kept until this command ends"))
    return certified(with_unasked(with_cycle(outcome, progress), progress), certificates, progress)


def _known_certificates(folder: OutputFolder, study: Study, robot: Mechanism) -> dict[str, Certificate]:
    try:
        return committed_certificates(study, folder.path, robot)
    except UnreadableCertificate:  # it is missing or of another version of this program, so prove again
        return {}


def known_optimum(folder: OutputFolder, study: Study) -> Optimum | None:
    """The folder's optimum if this program wrote it for the study's design question, else None."""
    if study.optimise is None or not folder.owns(FILE):
        return None
    try:
        optimum = read_optimum(folder.path / FILE)
        return optimum if optimum.answers_design(study) else None
    except StudyError:  # another version of this program wrote it
        return None
