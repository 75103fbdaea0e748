"""Set-points as CSV: commented header lines of `name: JSON value`, the columns' names, then one row for each period.

Numbers have enough digits to be read back exactly. A file appears complete or not at all: it is written beside its
final place and then moved there.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from kinematics import Array, InvalidValue
from trajectory.errors import SetpointFileError
from trajectory.files import write_files
from trajectory.setpoints.setpoints import Setpoints

FORMAT = "linkwright set-points 1"
_ROUNDING = 1e-9  # of the period


def write_setpoints(file: FilePath | str, setpoints: Setpoints) -> None:
    """Write the CSV file, atomically: on failure, a file that was there stays as it was.

    Raises:
        InvalidValue: a set-point is not finite.
        ValueError: the header holds a number that is not finite.
        CannotWrite: the folder cannot be written to.
    """
    file = FilePath(file)
    write_files(file.parent, {file.name: setpoints_text(setpoints)})


def setpoints_text(setpoints: Setpoints) -> str:
    """The CSV file's content.

    Raises:
        InvalidValue: a set-point is not finite.
        ValueError: the header holds a number that is not finite.
    """
    setpoints.require_finite()
    names = {"pose": list(setpoints.pose_names), "joints": list(setpoints.joint_names)}
    header = {**setpoints.header, **names, "units": list(setpoints.units)}
    lines = [f"# {FORMAT}", *(f"# {name}: {json.dumps(value, allow_nan=False)}" for name, value in header.items())]
    lines.append(",".join(setpoints.columns))
    lines.extend(",".join(map(repr, row)) for row in setpoints.table().tolist())
    return "\n".join(lines) + "\n"


def read_setpoints(file: FilePath | str) -> Setpoints:
    """Read a file that `write_setpoints` wrote. Any difference from its format is an error.

    Raises:
        SetpointFileError: it names the line, what was found and what was expected.
    """
    file = FilePath(file)
    try:
        lines = file.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError as error:
        raise SetpointFileError(file, 1, str(error), "UTF-8 text") from error
    first = lines[0] if lines else "an empty file"
    if first != f"# {FORMAT}":
        raise SetpointFileError(file, 1, first, f"# {FORMAT}")
    header = _read_header(file, lines)
    pose_names, names, units = (header.pop(name) for name in ("pose", "joints", "units"))
    above = len(header) + 4  # the format's line, pose, joints and units
    joint_units = units[1 + len(pose_names) :][: len(names)]
    width = 1 + len(pose_names) + 4 * len(names)
    try:
        empty = Setpoints.of_table(np.zeros((0, width)), pose_names, names, joint_units, header)
    except InvalidValue as error:
        raise SetpointFileError(file, above, f"units {units}", error.expected) from error
    if units != list(empty.units):
        raise SetpointFileError(file, above, f"units {units}", str(list(empty.units)))
    found = lines[above] if len(lines) > above else "the end of the file"
    if found != ",".join(empty.columns):
        raise SetpointFileError(file, above + 1, found, ",".join(empty.columns))
    table = np.array(
        [_read_row(file, above + 2 + k, line, len(empty.columns)) for k, line in enumerate(lines[above + 1 :])]
    )
    _require_periods(file, above + 2, table, header)
    return Setpoints.of_table(table, pose_names, names, joint_units, header)


def _read_header(file: FilePath, lines: list[str]) -> dict[str, Any]:
    header: dict[str, Any] = {}
    for number, line in enumerate(lines[1:], start=2):
        if not line.startswith("#"):
            break
        name, separator, value = line.removeprefix("# ").partition(": ")
        if not separator or name in header:
            raise SetpointFileError(file, number, line, "a new '# name: value'")
        try:
            header[name] = json.loads(value)
        except json.JSONDecodeError as error:
            raise SetpointFileError(file, number, value, f"a JSON value ({error.msg})") from error
    for name, (right, what) in _NEEDED.items():
        if name not in header or not right(header[name]):
            raise SetpointFileError(file, 1, f"{name}: {header.get(name)} in the header", what)
    return header


def _are(kind: type, values: object) -> bool:
    return isinstance(values, list) and bool(values) and all(type(v) is kind for v in values)


_NEEDED: dict[str, tuple[Callable[[Any], bool], str]] = {
    "period [s]": (lambda v: type(v) is float and 0.0 < v < math.inf, "a finite time > 0"),
    "periods": (lambda v: _are(int, v) and min(v) > 0, "counts > 0"),
    "pose": (lambda v: _are(str, v), "names"),
    "joints": (lambda v: _are(str, v), "names"),
    "units": (lambda v: _are(str, v), "units"),
}


def _read_row(file: FilePath, number: int, line: str, count: int) -> list[float]:
    cells = line.split(",")
    if len(cells) != count:
        raise SetpointFileError(file, number, f"{len(cells)} cells", f"{count} cells")
    try:
        row = [float(cell) for cell in cells]
    except ValueError as error:
        raise SetpointFileError(file, number, str(error), "numbers") from error
    if not np.isfinite(row).all():
        raise SetpointFileError(file, number, "a number that is not finite", "finite numbers")
    return row


def _require_periods(file: FilePath, first: int, table: Array, header: dict[str, Any]) -> None:
    period, expected = header["period [s]"], sum(header["periods"]) + 1
    if len(table) != expected:
        raise SetpointFileError(file, first + len(table), f"{len(table)} rows", f"{expected} rows")
    off = np.abs(table[:, 0] - np.arange(expected) * period) > _ROUNDING * period
    if off.any():
        row = int(np.argmax(off))
        raise SetpointFileError(file, first + row, f"t = {table[row, 0]!r}", f"{row} periods of {period} s")
