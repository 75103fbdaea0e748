"""What a study's robot must not touch besides itself, and whether the robot fits there at home."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from kinematics import (
    InvalidField,
    InvalidValue,
    Obstacle,
    PayloadHull,
    Surroundings,
    free_name,
    require_room,
    taken_names,
)
from studies.building.hardware import subtable
from studies.errors import KeyPath, StudyError, spelled
from studies.study_file import Conversion, Finding

if TYPE_CHECKING:
    from kinematics import Mechanism
    from studies.study_file import Study, TomlFile


def surroundings_of(study: Study) -> Surroundings:
    """The floor, the obstacles and the payload's hull of the study."""
    table = study.surroundings
    hull = None if table.payload_hull is None else PayloadHull(**table.payload_hull.model_dump())
    return Surroundings(table.floor, tuple(Obstacle(**row.model_dump()) for row in table.obstacle), hull)


def name_faults(data: Mapping[str, Any], mechanism: type[Mechanism]) -> Iterator[tuple[KeyPath, str | int]]:
    """The path of each obstacle's name that something else has: the row of the obstacle that has it, or its name."""
    rows = subtable(data, "surroundings").get("obstacle")
    first: dict[str, int] = {}
    for i, row in enumerate(rows if isinstance(rows, tuple) else ()):
        name = row.get("name") if isinstance(row, dict) else None
        if not isinstance(name, str):
            continue
        path: KeyPath = ("surroundings", "obstacle", i, "name")
        if name in first:
            yield path, first[name]
        elif name in taken_names(mechanism):
            yield path, name
        first.setdefault(name, i)


def names_told(file: TomlFile, conversion: Conversion, data: Mapping[str, Any], mechanism: type[Mechanism]) -> None:
    """Add a finding for each obstacle's name that another thing has."""
    for path, other in name_faults(data, mechanism):
        key, found = conversion.spelling[path], spelled(file.value(conversion.spelling[path]))
        if isinstance(other, int):
            line = file.line(conversion.spelling[(*path[:2], other, "name")])
            found, expected = f"{found}, as on line {line}", "a name, different from those of the other obstacles"
        else:
            expected = free_name(mechanism)
        conversion.findings.append(Finding(key, found, expected))


def require_room_in(robot: Mechanism, file: TomlFile) -> None:
    """Check that the base is above the floor, and that the payload is not inside what carries it.

    Raises:
        StudyError: at the key of the floor or of the hull.
    """
    try:
        require_room(robot)
    except InvalidField as error:
        table: KeyPath = ("payload_hull",) if error.record == "PayloadHull" else ()
        key = _spelled(file, ("surroundings", *table, error.field))
        raise StudyError([file.fault(key, spelled(file.value(key)), error.expected)]) from error
    except InvalidValue as error:  # of a mechanism whose tool's member does not exist
        raise StudyError([file.fault(("mechanism",), f"{error.what} {error.found}", error.expected)]) from error


def _spelled(file: TomlFile, path: KeyPath) -> KeyPath:
    in_mm = (*path[:-1], f"{path[-1]}_mm")
    return in_mm if in_mm in file.lines else path
