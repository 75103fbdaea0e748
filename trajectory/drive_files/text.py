"""Functions for all text formats: comments that state how a file was made, numbers in degrees and millimetres."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from kinematics import Array
from trajectory.setpoints import Setpoints

DECIMALS = 9  # of a degree or a millimetre: 2e-11 rad, 1e-12 m


def header_lines(header: Mapping[str, Any], mark: str) -> list[str]:
    """`name: JSON value` of each entry, after the format's comment mark.

    Raises:
        ValueError: the header holds a number that is not finite.
    """
    return [f"{mark} {name}: {json.dumps(value, allow_nan=False)}" for name, value in header.items()]


def unit_names(setpoints: Setpoints) -> list[str]:
    """(m,) the unit of each actuator in the file: deg or mm."""
    return ["deg" if unit == "rad" else "mm" for unit in setpoints.joint_units]


def in_degrees_or_mm(setpoints: Setpoints) -> tuple[Array, Array]:
    """Positions (k, m) [deg or mm] and speeds [deg/s or mm/s], rounded to `DECIMALS`."""
    factor = np.array([math.degrees(1.0) if unit == "rad" else 1e3 for unit in setpoints.joint_units])
    return np.round(setpoints.joints * factor, DECIMALS), np.round(setpoints.speed * factor, DECIMALS)


def decimal(value: float) -> str:
    """A number with a point and no exponent (some controllers read none), and no more digits than needed."""
    text = f"{value:.{DECIMALS}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
