"""Newport XPS `.trj` for PVT execution of a MultipleAxes group (XPS-Q8 user's manual, "PVT trajectories").

Each line is one element: its duration [s], then displacement and end velocity of each positioner, in degrees or
millimetres. There is no header and there are no comments. The group must be at the first set-point at the start.
"""

from __future__ import annotations

import numpy as np

from kinematics import InvalidValue
from trajectory.drive_files.drive import Drive
from trajectory.drive_files.text import DECIMALS, decimal, in_degrees_or_mm
from trajectory.setpoints import Setpoints

MOST_AXES = 8  # most axes of a MultipleAxes group


def write(stem: str, setpoints: Setpoints, drive: Drive) -> dict[str, str | bytes]:  # noqa: ARG001
    """The file's content by name.

    Raises:
        InvalidValue: more axes than a group can have.
    """
    count = len(setpoints.joint_names)
    if count > MOST_AXES:
        raise InvalidValue("axes of an XPS trajectory", count, f"at most {MOST_AXES}")
    position, speed = in_degrees_or_mm(setpoints)
    # Take differences of rounded positions: the sum of rounded differences would drift.
    displacement = np.round(np.diff(position, axis=0), DECIMALS)
    period = np.format_float_positional(setpoints.header["period [s]"], trim="-")
    lines = [
        ", ".join([period, *(decimal(v) for pair in zip(moved, velocity, strict=True) for v in pair)])
        for moved, velocity in zip(displacement, speed[1:], strict=True)
    ]
    return {f"{stem}.xps.trj": "\n".join(lines) + "\n"}
