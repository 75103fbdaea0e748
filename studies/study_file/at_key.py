"""Reports an error of a computation at the key of the study file that asked for it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

from design import ImpossibleSum
from kinematics import InvalidField, LinkwrightError, UnreachablePose
from studies.errors import (
    ApproachFailed,
    Fault,
    HomeOutOfReach,
    KeyPath,
    RequirementFailed,
    StudyError,
    dotted,
    spelled,
)
from studies.study_file.toml_file import TomlFile
from studies.study_file.units import SUFFIX
from trajectory import LimitsExceeded, PathBeyondLimit, PathRefused, RoughPath, TimingFailed, UnsuitedPath

_RECORDS: dict[str, KeyPath] = {
    "Limits": ("trajectory", "limits"),
    "Trajectory": ("trajectory",),
    "Drive": ("trajectory", "drive"),
    "DriveTrain": ("inertia", "drive_train"),
    "Structure": ("structure",),
    "Load": ("load",),
}
_OF_THE_PATH = (PathRefused, RoughPath, UnreachablePose, UnsuitedPath)
_OF_THE_LIMITS = (LimitsExceeded, TimingFailed)


class StudyFailed(LinkwrightError):
    """What a study asks for cannot be computed. `cause` says why and gives the exit status."""

    def __init__(self, file: TomlFile, path: KeyPath, cause: LinkwrightError) -> None:
        self.file, self.key, self.cause = file.path, dotted(path), cause
        self.exit_status = cause.exit_status
        super().__init__(f"{file.path}:{file.line(path)}: {self.key}: {cause}")


@contextmanager
def told_at_key(file: TomlFile) -> Iterator[None]:
    """Raise the errors of paths, timing, limits and drives again, with their key and line in the study file.

    Raises:
        StudyError: a record refuses a value of the file.
        StudyFailed: a path or limits do not fit the rest of the study.
    """
    try:
        yield
    except ApproachFailed as error:
        raise StudyFailed(file, ("trajectory", "approach"), error) from error
    except HomeOutOfReach as error:
        raise _of_home(file, error) from error
    except ImpossibleSum as error:
        raise StudyFailed(file, ("optimise", "sums", error.number, "at_most"), error) from error
    except RequirementFailed as error:
        raise RequirementFailed([replace(one, place=_required_at(file, one.margin)) for one in error.failed]) from error
    except PathBeyondLimit as error:
        raise StudyFailed(file, _spelling(file, ("trajectory", "limits", error.limit)), error) from error
    except InvalidField as error:
        if (fault := refused_field(file, error)) is None:
            raise
        raise StudyError([fault]) from error
    except (*_OF_THE_PATH, *_OF_THE_LIMITS) as error:
        at_limits = isinstance(error, _OF_THE_LIMITS)
        raise StudyFailed(file, ("trajectory", "limits") if at_limits else travelled(file), error) from error


def refused_field(file: TomlFile, error: InvalidField, why: str = "") -> Fault | None:
    """The fault at the key of a refused field; None if a study does not fill that record.

    `why` is added to what was found.
    """
    if error.record not in _RECORDS:
        return None
    path = _spelling(file, (*_RECORDS[error.record], error.field))
    try:
        found = spelled(file.value(path))
    except LookupError:
        found = "nothing"
    return file.fault(path, " ".join(filter(None, (found, error.use, why))), error.expected)


def _spelling(file: TomlFile, path: KeyPath) -> KeyPath:
    """The key as the file spells it, perhaps with the suffix of a unit."""
    suffixed: list[KeyPath] = [(*path[:-1], f"{path[-1]}_{suffix}") for suffix in SUFFIX.values()]
    return next((key for key in (path, *suffixed) if key in file.lines), path)


def _required_at(file: TomlFile, margin: str) -> str:
    """File, line and key of the requirement of a margin, which may be named with where it fails; "" without one."""
    name, rows = margin.partition(" ")[0], file.data.get("requirement", [])
    number = next((i for i, row in enumerate(rows) if row.get("margin") == name), None)
    if number is None:
        return ""
    key: KeyPath = ("requirement", number, "at_most" if "at_most" in rows[number] else "at_least")
    return f"{file.path}:{file.line(key)}: {dotted(key)}"


def _of_home(file: TomlFile, error: HomeOutOfReach) -> StudyError:
    given = next((path for path in file.lines if path[0] == "home" and len(path) > 1), None)
    found = spelled(file.value(given)) if given else f"no home, so the default {error.shown}"
    return StudyError([file.fault(given or ("home",), found, f"a home in reach ({error.cause})")])


def travelled(file: TomlFile) -> KeyPath:
    """The key of the cycle or path; the region's if there is neither."""
    known: list[KeyPath] = [("trajectory", name) for name in ("cycle", "path")]
    return next((key for key in known if key in file.lines), ("region",))
