"""What a command starts from: its study, its robot, its output folder. Heavy imports wait, as in `app`."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, overload

if TYPE_CHECKING:
    from kinematics import Mechanism
    from studies.results import OutputFolder
    from studies.study_file import BudgetTable, Study, TomlFile


class Asked(NamedTuple):
    """A study, its file, and the names of the drive files that the command will write."""

    file: TomlFile
    study: Study
    drive_files: tuple[str, ...]


def load(given: str, allow_code: bool = False, formats: list[str] | None = None, seconds: float | None = None) -> Asked:
    """Read a study and check it against its mechanism.

    Args:
        given: the study's name, or a path.
        allow_code: whether the Python module that the study names for its mechanism may run.
        formats: formats of the drive files, in place of the study's.
        seconds: time for each stage [s], in place of the study's budget.
    """
    from studies.building import drive_file_names, load_study, require_cycle_inside
    from studies.study_file import read_toml, study_path

    file = read_toml(study_path(given))
    study = load_study(file, allow_code)
    if formats and study.trajectory is not None:
        files = study.trajectory.model_copy(update={"files": tuple(formats)})
        study = study.model_copy(update={"trajectory": files})
    if seconds is not None:
        study = study.model_copy(update={"budget": _budget(seconds)})
    require_cycle_inside(study, file)
    return Asked(file, study, tuple(drive_file_names(study, file, formats)))


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
    """The folder, after a check that files of these names can be written there; None without a path."""
    from studies.results import OutputFolder

    if path is None:
        return None
    folder = OutputFolder(path, force)
    folder.require(names)
    return folder


def robot_for(file: TomlFile, asked: Study, prototype: bool) -> Mechanism:
    """The committed optimum beside the study, or the study's own geometry."""
    from studies.building import robot_of
    from studies.committed import committed

    return (None if prototype else committed(asked, file.path.parent)) or robot_of(asked)
