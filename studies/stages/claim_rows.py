"""One claim in a table: what was claimed, what was found, and by how much it holds."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from kinematics import Bound

AGREE = 1e-6  # relative: how much another machine's rounding may change a figure
ROUNDING = 1e-9  # m or rad: how much rounding may change a pose in the file, or a sum


@dataclass(frozen=True)
class Row:
    """One claim: its words, the expected and the found value, and the margin by which it holds.

    `margin` is negative if the claim fails.
    """

    what: str
    expected: str
    found: str
    margin: float
    where: str = ""

    @property
    def holds(self) -> bool:
        """Whether the claim stands; NaN never does."""
        return bool(self.margin >= 0.0)


def same(what: str, claimed: object, found: object) -> Row:
    """Expect the same value."""
    return Row(what, str(claimed), str(found), 0.0 if claimed == found else -1.0)


def same_digest(what: str, claimed: object, found: object) -> Row:
    """Expect the same digest; the row shows its first digits."""
    return replace(same(what, claimed, found), expected=str(claimed)[:12], found=str(found)[:12])


def agrees(what: str, claimed: object, found: float) -> Row:
    """Expect the same number, except for another machine's rounding."""
    if isinstance(claimed, bool) or not isinstance(claimed, float | int) or not math.isfinite(claimed):
        return Row(what, str(claimed), f"{found:.9g}", -1.0)
    off = abs(found - claimed)
    return Row(what, f"{claimed:.9g}", f"{found:.9g}", AGREE * max(abs(claimed), ROUNDING) - off)


def keeps(what: str, bound: Bound, found: float, pose: Any, part: str | None = None) -> Row:
    """Expect a value that keeps a bound; `pose` is where it was found, or None, and `part` which part it is."""
    where = "" if pose is None else shown_pose(pose, part)
    return Row(what, str(bound), f"{found:.9g}", bound.room(found), where)


def shown_pose(pose: Any, part: str | None = None) -> str:
    """A pose for people: short, and without negative zeros; with the part of the robot that is meant there."""
    shown = f"({', '.join(f'{round(float(v), 6) + 0.0:.4g}' for v in pose)})"
    return f"{shown}, {part}" if part else shown
