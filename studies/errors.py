"""What is wrong with a study file, and where."""

import json
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from kinematics import Bound, LinkwrightError

KeyPath = tuple[str | int, ...]  # ("requirement", 0, "margin"): table, row, key

_LONGEST_FOUND = 80  # characters


@dataclass(frozen=True)
class Fault:
    """One fault of a file: `key` at `line` holds `found`; `expected` says what would be right.

    `key` is "" and `line` is None if the whole file is at fault.
    """

    file: Path
    key: str
    line: int | None
    found: str
    expected: str

    def __str__(self) -> str:
        where = f"{self.file}" if self.line is None else f"{self.file}:{self.line}"
        what = f"{where}: {self.key}" if self.key else where
        return f"{what}: found {self.found}; expected {self.expected}"


class StudyError(LinkwrightError):
    """A study file cannot be used; `str()` gives a line for each fault.

    `faults` holds all faults in the order of lines; `file`, `key`, `line`, `found`, `expected` are those of the first.
    """

    def __init__(self, faults: Sequence[Fault]) -> None:
        super().__init__(faults)
        self.faults = tuple(sorted(faults, key=lambda fault: fault.line or 0))
        first = self.faults[0]
        self.file, self.key, self.line = first.file, first.key, first.line
        self.found, self.expected = first.found, first.expected

    def __str__(self) -> str:
        return "\n".join(map(str, self.faults))


@dataclass(frozen=True)
class Failed:
    """A requirement that is not met: the wanted bound, the worst value found, and its pose (empty if there is none).

    `when` is the time or the place on a path, in words; empty over a region. `place` is where the study asks for it:
    file, line and key; empty where no file does. `part` is the part of the robot that has the worst value, such as
    "limb 1"; None if there is no single one.
    """

    margin: str
    bound: Bound
    found: float
    pose: tuple[float, ...]
    place: str = ""
    part: str | None = None
    when: str = ""

    def as_data(self) -> dict[str, Any]:
        """Its fields, the bound by its word."""
        return {"margin": self.margin, self.bound.word: self.bound.value} | {
            name: getattr(self, name) for name in ("found", "pose", "place", "part", "when")
        }

    def __str__(self) -> str:
        where = f" at pose {_pose(self.pose)}" if self.pose else ""
        where += f", {self.when}" if self.when else ""
        found = f"{self.found:.6g}" if math.isfinite(self.found) else "no value, as a limb cannot reach,"
        words = self.bound.word.replace("_", " ")
        at = f"{self.place}: " if self.place else ""
        of_part = f" of {self.part}" if self.part else ""
        return f"{at}{self.margin}{of_part}: found {found}{where}; expected {words} {self.bound.value:g}"


class RequirementFailed(LinkwrightError):
    """The geometry does not meet its requirements; `failed` holds each one."""

    exit_status = 1

    def __init__(self, failed: Sequence[Failed]) -> None:
        self.failed = tuple(failed)
        super().__init__("requirements fail:\n  " + "\n  ".join(map(str, self.failed)))


class ApproachFailed(LinkwrightError):
    """There is no approach from `home` to `start` of the cycle. `cause` says why and gives the exit status."""

    def __init__(self, home: tuple[float, ...], start: tuple[float, ...], cause: LinkwrightError) -> None:
        self.home, self.start, self.cause = home, start, cause
        self.exit_status = cause.exit_status
        super().__init__(f"no approach from home {_pose(home)} to the start {_pose(start)}: {cause}")


class HomeOutOfReach(LinkwrightError):
    """The robot cannot reach its home `pose`; `cause` names the limb that cannot."""

    def __init__(self, pose: tuple[float, ...], cause: LinkwrightError) -> None:
        self.pose, self.cause = pose, cause
        super().__init__(f"home is out of reach: {cause}")

    @property
    def shown(self) -> str:
        """The pose for people."""
        return _pose(self.pose)


def _pose(pose: tuple[float, ...]) -> str:
    return f"({', '.join(f'{v:.6g}' for v in pose)})"


def dotted(path: KeyPath) -> str:
    """`path` as the file spells it. A row of an array of tables has no number here; its line tells it from others."""
    names = (part for part in path if isinstance(part, str))
    return _cut(".".join(name if re.fullmatch(r"[\w-]+", name) else json.dumps(name) for name in names))


def spelled(value: object) -> str:
    """A TOML value on one short line."""
    return _cut(_spelled(value))


def _spelled(value: object) -> str:
    match value:
        case str():
            return json.dumps(value, ensure_ascii=False)
        case bool():
            return str(value).lower()
        case int() if value.bit_length() > 64:
            return hex(value)  # Python refuses to print a very long integer in decimal
        case list():
            return f"[{', '.join(map(_spelled, value))}]"
        case dict():
            return "a table" if value else "an empty table"
        case _:
            return str(value)


def _cut(text: str) -> str:
    return text if len(text) <= _LONGEST_FOUND else f"{text[:_LONGEST_FOUND]}..."
