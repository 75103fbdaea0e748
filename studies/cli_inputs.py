"""What a command starts from: its study, the robot, folders that can be written. Heavy imports wait, as in `cli`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kinematics import Mechanism
    from studies.pipeline import Outcome
    from studies.schema import Study


def study_file(given: str) -> Path:
    from studies.locate import study_path

    return study_path(given)


def load(given: str, formats: list[str] | None = None) -> Study:
    """The study, checked against its mechanism; with other formats of drive files where they are given."""
    from studies.load import load_study
    from studies.setup import require_cycle_inside, require_drive_files

    study = load_study(study_file(given))
    if formats and study.trajectory is not None:
        files = study.trajectory.model_copy(update={"files": tuple(formats)})
        study = study.model_copy(update={"trajectory": files})
    require_cycle_inside(study, study_file(given))
    require_drive_files(study, study_file(given), formats)
    return study


def require_writable_folders(*folders: Path | None) -> None:
    from trajectory import require_writable

    for folder in folders:
        if folder is not None:
            require_writable(folder)


def robot_for(given: str, asked: Study, prototype: bool) -> Mechanism:
    """The committed optimum beside the study, or the study's own geometry."""
    from studies import setup
    from studies.optimum import committed

    return (None if prototype else committed(asked, study_file(given).parent)) or setup.robot_of(asked)


def outcome_of(given: str, asked: Study, robot: Any, prove: bool = False, known: Any = None) -> Outcome:
    from studies import console, pipeline
    from studies.at_key import told_at_key

    with told_at_key(study_file(given)), console.progress() as tell:
        outcome = pipeline.run(asked, robot, tell)
        return pipeline.certified(outcome, known or {}, tell) if prove else outcome
