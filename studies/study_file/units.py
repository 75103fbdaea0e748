"""Units of keys: a key may end in `_mm`, `_deg` or `_rpm`. The converted values are in SI and radians."""

import math
import re
from collections.abc import Iterable
from enum import StrEnum
from typing import Any

from trajectory import in_si


class Dimension(StrEnum):
    """The quantity of a key. The fields of a mechanism's geometry use the first five."""

    NONE = "none"
    FRAME = "frame"
    LENGTH = "length"
    ANGLE = "angle"
    LENGTH_PER_TURN = "length_per_turn"
    JOINT_SPEED = "joint_speed"


SI_UNIT = {
    Dimension.LENGTH: "m",
    Dimension.ANGLE: "rad",
    Dimension.LENGTH_PER_TURN: "m per turn",
    Dimension.JOINT_SPEED: "rad/s, or m/s on a rail",
}
SUFFIX = {
    Dimension.LENGTH: "mm",
    Dimension.ANGLE: "deg",
    Dimension.LENGTH_PER_TURN: "mm",
    Dimension.JOINT_SPEED: "rpm",
}
_UNIT_WORD = re.compile(
    "deg(rees?)?|rad(s|ians?)?|grad|turns?|rev|rp[ms]|hz|[cdkmnu]?m|micron|in(ch(es)?)?|ft|feet|mil"
    "|[mu]?s|sec|min|h|[km]?n|nmm|k?g|lbs?|per"
)


def unit_ending(spelling: str, names: Iterable[str]) -> tuple[str, str]:
    """The longest of `names` that `spelling` begins with, and the units after it; ("", "") if there is none."""
    for name in sorted(names, key=len, reverse=True):
        ending = spelling.removeprefix(f"{name}_")
        if ending != spelling and all(map(_UNIT_WORD.fullmatch, ending.lower().split("_"))):
            return name, ending
    return "", ""


def value_in_si(value: Any, suffix: str) -> Any:
    """A number, or a list of lists of numbers, in SI; anything else as it is. A suffix "" is SI already."""
    if isinstance(value, list):
        return tuple(value_in_si(entry, suffix) for entry in value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    try:
        number = float(value)
    except OverflowError:
        number = math.inf if value > 0 else -math.inf
    if suffix:
        return in_si(number, suffix)
    return value if math.isfinite(number) else number
