"""Position-velocity-time CSV in the layout of Zaber's PVT editor.

The axes must already be at the first row, at time 0. The time of each later row is relative to the row before.
The layout has no comments. Between rows the controller interpolates by cubics.
"""

from __future__ import annotations

import numpy as np

from trajectory.drive_files.drive import Drive
from trajectory.drive_files.text import decimal, in_degrees_or_mm
from trajectory.setpoints import Setpoints

_SYMBOLS = {"rad": "°", "m": "mm"}


def write(stem: str, setpoints: Setpoints, drive: Drive) -> dict[str, str | bytes]:
    """The file's content by name.

    Raises:
        InvalidValue: names do not fit.
    """
    names = drive.names(tuple(f"Axis {k + 1}" for k in range(len(setpoints.joint_names))))
    columns = ["Time (s)"]
    for name, unit in zip(names, setpoints.joint_units, strict=True):
        columns += [f"{name} Position ({_SYMBOLS[unit]})", f"{name} Velocity ({_SYMBOLS[unit]}/s)"]
    lines = [",".join(columns)]
    period = np.format_float_positional(setpoints.header["period [s]"], trim="-")
    for k, (position, speed) in enumerate(zip(*in_degrees_or_mm(setpoints), strict=True)):
        pairs = (decimal(v) for pair in zip(position, speed, strict=True) for v in pair)
        lines.append(",".join([period if k else "0", *pairs]))
    return {f"{stem}.zaber.csv": "\n".join(lines) + "\n"}
