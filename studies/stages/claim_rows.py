"""One claim in a table: what was claimed, what was found, and by how much it holds."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

AGREE = 1e-6  # relative: what another machine's rounding may change in a figure
ROUNDING = 1e-9  # m or rad: of a pose in the file, and of a sum


@dataclass(frozen=True)
class Row:
    """One claim: what it is, what the file says or the study wants, what was found, and by how much it holds.

    `margin` is negative where the claim fails.
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
    """The very same."""
    return Row(what, str(claimed), str(found), 0.0 if claimed == found else -1.0)


def same_digest(what: str, claimed: object, found: object) -> Row:
    """The very same; the first digits are shown."""
    return replace(same(what, claimed, found), expected=str(claimed)[:12], found=str(found)[:12])


def agrees(what: str, claimed: object, found: float) -> Row:
    """The same number but for another machine's rounding."""
    if isinstance(claimed, bool) or not isinstance(claimed, float | int) or not math.isfinite(claimed):
        return Row(what, str(claimed), f"{found:.9g}", -1.0)
    off = abs(found - claimed)
    return Row(what, f"{claimed:.9g}", f"{found:.9g}", AGREE * max(abs(claimed), ROUNDING) - off)


def at_least(what: str, bound: float, found: float, pose: Any) -> Row:
    """No lower than a bound, at a pose where there is one."""
    where = "" if pose is None else shown_pose(pose)
    return Row(what, f">= {bound:g}", f"{found:.9g}", found - bound, where)


def shown_pose(pose: Any) -> str:
    """A pose for people: short, and without negative zeros."""
    return f"({', '.join(f'{round(float(v), 6) + 0.0:.4g}' for v in pose)})"
