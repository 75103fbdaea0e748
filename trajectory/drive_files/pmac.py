"""PMAC motion program in PVT mode: `PVT{ms}`, then `{axis}{position}:{velocity}` of each axis, a line a period.

Turbo PMAC software reference, "PVT{data}": 12 bits of whole and 12 of fractional milliseconds with I42 = 0, whole ones
with I42 = 1 and on older controllers. Positions in degrees or millimetres as the axis definitions' user units,
velocities by Isx90 = 1000, its default: in a second. The axes must stand at the first set-point.
"""

from __future__ import annotations

from kinematics import InvalidField, InvalidValue
from trajectory.drive_files.drive import Drive
from trajectory.drive_files.text import decimal, header_lines, in_degrees_or_mm, unit_names
from trajectory.setpoints import Setpoints

LETTERS = tuple("XYZABCUVW")
FRACTIONS = 4096  # of a millisecond
MOST_MS = 4096 - 1 / FRACTIONS


def write(stem: str, setpoints: Setpoints, drive: Drive) -> dict[str, str | bytes]:
    """The file's content by name.

    Raises:
        InvalidValue: a period that the controller would round, more axes than letters, or names that are no letters.
    """
    names = _letters(setpoints, drive)
    period = _milliseconds(setpoints.header["period [s]"])
    needs = "any PMAC" if "." not in period else "a Turbo PMAC with I42 = 0"
    position, speed = in_degrees_or_mm(setpoints)
    start = [f"{name}{decimal(v)}" for name, v in zip(names, position[0], strict=True)]
    program = {
        "axes": list(names),
        "axis units": unit_names(setpoints),
        "needs": f"Isx90 = 1000, {needs}, and the axes at rest at {' '.join(start)}",
    }
    lines = [*header_lines(setpoints.header, ";"), *header_lines(program, ";")]
    lines += ["CLOSE", "OPEN PROG 1 CLEAR", "ABS", f"PVT{period}"]
    for row in zip(position[1:], speed[1:], strict=True):
        lines.append(" ".join(f"{n}{decimal(p)}:{decimal(v)}" for n, p, v in zip(names, *row, strict=True)))
    return {f"{stem}.pmac": "\n".join([*lines, "CLOSE"]) + "\n"}


def _letters(setpoints: Setpoints, drive: Drive) -> tuple[str, ...]:
    count = len(setpoints.joint_names)
    if count > len(LETTERS):
        raise InvalidValue("axes of a PMAC program", count, f"at most {len(LETTERS)}")
    names = drive.names(LETTERS[:count])
    if not set(names) <= set(LETTERS):
        raise InvalidField("Drive", "axes", names, f"letters out of {' '.join(LETTERS)}", "of a PMAC program")
    return names


def _milliseconds(period: float) -> str:
    parts = period * 1e3 * FRACTIONS
    if not (1 <= round(parts) <= MOST_MS * FRACTIONS and abs(parts - round(parts)) <= 1e-9 * parts):
        expected = f"whole 1/{FRACTIONS} ms, up to {MOST_MS:.4f} ms, such as 0.001 or 0.0005: it would be rounded"
        raise InvalidValue("period of a PMAC program", period, expected)
    return f"{period * 1e3:.12g}"
