"""What a command starts from: its study, the robot, folders that can be written. Heavy imports wait, as in `cli`."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, overload

if TYPE_CHECKING:
    from kinematics import Mechanism
    from studies.results import OutputFolder
    from studies.study_file import BudgetTable, Study


def study_file(given: str) -> Path:
    from studies.study_file import study_path

    return study_path(given)


def load(given: str, formats: list[str] | None = None, seconds: float | None = None) -> Study:
    """The study, checked against its mechanism.

    Args:
        formats: of the drive files, in place of the study's.
        seconds: of each stage, in place of the study's budget.
    """
    from studies.building import drive_file_names, load_study, require_cycle_inside

    study = load_study(study_file(given))
    if formats and study.trajectory is not None:
        files = study.trajectory.model_copy(update={"files": tuple(formats)})
        study = study.model_copy(update={"trajectory": files})
    if seconds is not None:
        study = study.model_copy(update={"budget": _budget(seconds)})
    require_cycle_inside(study, study_file(given))
    drive_file_names(study, study_file(given), formats)
    return study


def _budget(seconds: float) -> BudgetTable:
    from kinematics import InvalidValue
    from studies.study_file import BudgetTable

    if not 0.0 < seconds < math.inf:
        raise InvalidValue("--seconds", seconds, "a finite time > 0 s")
    return BudgetTable.each(seconds)


@overload
def output_folder(path: Path, names: Iterable[str], force: bool) -> OutputFolder: ...


@overload
def output_folder(path: Path | None, names: Iterable[str], force: bool) -> OutputFolder | None: ...


def output_folder(path: Path | None, names: Iterable[str], force: bool) -> OutputFolder | None:
    """The folder, where files of these names can be written; None for none."""
    from studies.results import OutputFolder

    if path is None:
        return None
    folder = OutputFolder(path, force)
    folder.require(names)
    return folder


def robot_for(given: str, asked: Study, prototype: bool) -> Mechanism:
    """The committed optimum beside the study, or the study's own geometry."""
    from studies.building import robot_of
    from studies.committed import committed

    return (None if prototype else committed(asked, study_file(given).parent)) or robot_of(asked)
