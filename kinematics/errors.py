"""The errors of this project; each keeps its data beside its message."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


def plain(value: Any) -> Any:
    """The same value for a message: numbers and arrays of numpy as Python's own, in tuples and lists too."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if type(value) in (list, tuple):
        return type(value)(map(plain, value))
    return value


class LinkwrightError(Exception):
    """Base of every error that Linkwright raises on purpose.

    `exit_status` is the command line's: 2 where the input is wrong, 1 where a requirement fails.
    """

    exit_status = 2


class InvalidGeometry(LinkwrightError):
    """A geometry field has an impossible value."""

    def __init__(self, mechanism: str, field: str, found: object, expected: str) -> None:
        self.mechanism, self.field, self.found, self.expected = mechanism, field, found, expected
        super().__init__(f"{mechanism} geometry, {field}: found {plain(found)}; expected {expected}")


class InvalidShape(LinkwrightError):
    """An array's last axis does not match the names that it stands for."""

    def __init__(self, what: str, names: Sequence[str], found: tuple[int, ...]) -> None:
        self.what, self.names, self.found = what, tuple(names), found
        super().__init__(f"{what}: found an array of shape {found}; expected (..., {len(names)}) for {names}")


class UnreachablePose(LinkwrightError):
    """A limb cannot reach the pose."""

    def __init__(self, pose: Sequence[float], limb: int, margin: float) -> None:
        self.pose, self.limb, self.margin = tuple(float(v) for v in pose), limb, margin
        where = ", ".join(f"{v:.6g}" for v in self.pose)
        super().__init__(
            f"pose ({where}): limb {limb} cannot reach it, its reach margin is {margin:.6g} m; "
            "expected a margin of at least 0"
        )


class InvalidValue(LinkwrightError):
    """An argument has a value outside what it can mean."""

    def __init__(self, what: str, found: object, expected: str) -> None:
        self.what, self.found, self.expected = what, found, expected
        super().__init__(f"{what}: found {plain(found)}; expected {expected}")


class InvalidField(InvalidValue):
    """A field of a record has a value that it cannot have; `use` says for what it cannot, "" for anything."""

    def __init__(self, record: str, field: str, found: object, expected: str, use: str = "") -> None:
        self.record, self.field, self.use = record, field, use
        super().__init__(" ".join(filter(None, (record, field, use))), found, expected)
