"""Waypoints as CSV: a header with the pose's names, then one pose in each row, in order.

A column has the name of its coordinate, in m or rad, or this name with `_mm` or `_deg`. A column `blend` (or
`blend_mm`) is the length that the corner at that pose takes off both of its legs. With 0, or an empty cell, the tool
stops there. An angle may be empty, except in the first and the last pose. Empty lines and lines with # are ignored.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path as FilePath

from kinematics import is_length
from trajectory.errors import InvalidPath, WaypointFileError
from trajectory.paths.rounded_path import RoundedPath
from trajectory.units import in_si

Column = tuple[str, str]  # coordinate and unit suffix, "" for SI
Row = tuple[
    int, dict[str, float | None], dict[str, tuple[str, str]]
]  # line, SI values and (column, cell) by coordinate
_BLEND = "blend"


def read_waypoints(file: FilePath | str, pose_names: Sequence[str]) -> RoundedPath:
    """The path that a file describes.

    Args:
        file: CSV.
        pose_names: (n,) of the robot that is to follow it.

    Raises:
        WaypointFileError: it names line and column, what was found and what would be right.
    """
    file = FilePath(file)
    try:
        text = file.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise WaypointFileError(file, 1, "", error.strerror or str(error), "a file of waypoints") from error
    except UnicodeDecodeError as error:
        raise WaypointFileError(file, 1, "", str(error), "UTF-8 text") from error
    lines = [(k, line) for k, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    if not lines:
        raise WaypointFileError(file, 1, "", "no header", f"a header with {', '.join(pose_names)}")
    columns = _header(file, *lines[0], pose_names)
    rows = [_row(file, number, line, columns) for number, line in lines[1:]]
    return _path(file, rows, tuple(pose_names))


def _cells(file: FilePath, number: int, line: str) -> list[str]:
    try:
        (cells,) = csv.reader([line], strict=True, skipinitialspace=True)
    except csv.Error as error:
        raise WaypointFileError(file, number, "", str(error), "comma-separated cells") from error
    return [cell.strip() for cell in cells]


def _header(file: FilePath, number: int, line: str, pose_names: Sequence[str]) -> list[Column]:
    columns: list[Column] = []
    spellings = {name: (name, "") for name in (*pose_names, _BLEND)}
    for name in (*pose_names, _BLEND):
        suffix = "mm" if is_length(name) or name == _BLEND else "deg"
        spellings[f"{name}_{suffix}"] = (name, suffix)
    for cell in _cells(file, number, line):
        if cell not in spellings:
            raise WaypointFileError(file, number, cell, "an unknown column", f"one of {', '.join(spellings)}")
        if spellings[cell][0] in (name for name, _ in columns):
            raise WaypointFileError(file, number, cell, "a coordinate given twice", "one column for each")
        columns.append(spellings[cell])
    missing = [name for name in pose_names if name not in (name for name, _ in columns)]
    if missing:
        raise WaypointFileError(file, number, missing[0], "no such column", f"all of {', '.join(pose_names)}")
    return columns


def _row(file: FilePath, number: int, line: str, columns: Sequence[Column]) -> Row:
    cells = _cells(file, number, line)
    if len(cells) != len(columns):
        raise WaypointFileError(file, number, "", f"{len(cells)} cells", f"{len(columns)}, as in the header")
    values: dict[str, float | None] = {}
    spelled = {}
    for cell, (name, suffix) in zip(cells, columns, strict=True):
        spelled[name] = (f"{name}_{suffix}" if suffix else name, cell)
        try:
            values[name] = _finite_in_si(cell, suffix) if cell else None
        except ValueError:
            raise WaypointFileError(file, number, spelled[name][0], cell, "a finite number") from None
    return number, values, spelled


def _finite_in_si(cell: str, suffix: str) -> float:
    """Raise ValueError where the cell is no finite number."""
    number = in_si(cell, suffix)
    if not math.isfinite(number):
        raise ValueError
    return number


def _path(file: FilePath, rows: Sequence[Row], pose_names: tuple[str, ...]) -> RoundedPath:
    if len(rows) < 2:
        line = rows[-1][0] if rows else 1
        raise WaypointFileError(file, line, "", f"{len(rows)} pose" if rows else "no poses", "at least 2")
    for number, values, spelled in (rows[0], rows[-1]):
        if values.get(_BLEND):
            raise WaypointFileError(file, number, *spelled[_BLEND], "no blend, as the path ends here")
    poses = tuple(tuple(values[name] for name in pose_names) for _, values, _ in rows)
    blends = tuple(values.get(_BLEND) or 0.0 for _, values, _ in rows[1:-1])
    try:
        return RoundedPath(pose_names, poses, blends)
    except InvalidPath as error:
        number, _, spelled = rows[error.pose - 1]
        column, cell = spelled.get(error.field, ("", f"the {error.field} {error.found}"))
        raise WaypointFileError(file, number, column, cell or "nothing", error.expected) from error
