"""CiA 402 cyclic synchronous position: the target position 0x607A of each drive, one row for each SYNC.

A CSV of whole increments (INTEGER32) below commented lines: 0x60C2:01 (UNSIGNED8) times ten to the 0x60C2:02
(INTEGER8) is the interpolation time period in seconds (CiA 402-2, IEC 61800-7-201). Zero is the model's zero. The
drive's home offset 0x607C must be set on the machine.
"""

from __future__ import annotations

import json

import numpy as np

from kinematics import Array, InvalidValue
from trajectory.drive_files.drive import Drive
from trajectory.drive_files.text import header_lines
from trajectory.setpoints import Setpoints

_INT32 = np.iinfo(np.int32)
_SLOWEST, _FASTEST = 0, -9  # powers of ten of a second


def write(stem: str, setpoints: Setpoints, drive: Drive) -> dict[str, str | bytes]:
    """The file's content by name.

    Raises:
        InvalidValue: increments are missing, 32 bits overflow, 0x60C2 cannot express the period, or names do not fit.
    """
    names = drive.names(setpoints.joint_names)
    per_unit = drive.increments_per_unit(setpoints.joint_units)
    targets = _targets(setpoints, per_unit, names)
    value, exponent = interpolation_time(setpoints.header["period [s]"])
    objects = {
        "0x60C2:01": value,
        "0x60C2:02": exponent,
        "axes": list(names),
        "increments for a rad or m of the actuator": per_unit.tolist(),
        "rounding to increments [rad or m]": (0.5 / np.abs(per_unit)).tolist(),
    }
    lines = [*header_lines(setpoints.header, "#"), *header_lines(objects, "#")]
    lines.append(",".join(f"{name} 0x607A" for name in names))
    lines += [json.dumps(row, separators=(",", ":"))[1:-1] for row in targets.tolist()]
    return {f"{stem}.cia402.csv": "\n".join(lines) + "\n"}


def interpolation_time(period: float) -> tuple[int, int]:
    """0x60C2:01 and :02 for a period [s].

    Raises:
        InvalidValue: the period is no whole number up to 255 times a power of ten.
    """
    for exponent in range(_SLOWEST, _FASTEST - 1, -1):
        value = period / 10.0**exponent
        if 1 <= round(value) <= 255 and abs(value - round(value)) <= 1e-9 * value:
            return round(value), exponent
    raise InvalidValue(
        "period of 0x60C2", period, "1 to 255 times a power of ten of a second, such as 0.001 or 0.00025"
    )


def _targets(setpoints: Setpoints, per_unit: Array, names: tuple[str, ...]) -> Array:
    """(k, m) whole increments."""
    targets = np.rint(setpoints.joints * per_unit)
    over = (targets < _INT32.min) | (targets > _INT32.max)
    if over.any():
        row, axis = (int(k) for k in np.argwhere(over)[0])
        expected = f"{_INT32.min} to {_INT32.max}: fewer increments, a smaller encoder_gear, or another zero"
        raise InvalidValue(f"0x607A of {names[axis]}, set-point {row}", int(targets[row, axis]), expected)
    result: Array = targets.astype(np.int32)
    return result
