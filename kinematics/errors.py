"""The errors of this project. Each holds its data and its message."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


def plain(value: Any) -> Any:
    """The same value for a message: numbers and arrays of numpy become Python's own, also inside tuples and lists."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if type(value) in (list, tuple):
        return type(value)(map(plain, value))
    return value


class LinkwrightError(Exception):
    """Base of every error that Linkwright raises on purpose.

    `exit_status` is that of the command line: 2 if the input is wrong, 1 if a requirement fails.
    """

    exit_status = 2


class InvalidGeometry(LinkwrightError):
    """A geometry field has an impossible value."""

    def __init__(self, mechanism: str, field: str, found: object, expected: str) -> None:
        self.mechanism, self.field, self.found, self.expected = mechanism, field, found, expected
        super().__init__(f"{mechanism} geometry, {field}: found {plain(found)}; expected {expected}")


class InvalidShape(LinkwrightError):
    """An array's last axis does not have one entry for each name."""

    def __init__(self, what: str, names: Sequence[str], found: tuple[int, ...]) -> None:
        self.what, self.names, self.found = what, tuple(names), found
        super().__init__(f"{what}: found an array of shape {found}; expected (..., {len(names)}) for {names}")


class UnreachablePose(LinkwrightError):
    """A limb cannot reach the pose."""

    def __init__(self, pose: Sequence[float], limb: int, margin: float) -> None:
        self.pose, self.limb, self.margin = tuple(float(v) for v in pose), limb, margin
        where = ", ".join(f"{v:.6g}" for v in self.pose)
        super().__init__(
            f"pose ({where}): limb {limb} cannot reach it: found a reach margin of {margin:.6g} m; "
            "expected a margin of at least 0"
        )


class InvalidValue(LinkwrightError):
    """An argument has an impossible value."""

    def __init__(self, what: str, found: object, expected: str) -> None:
        self.what, self.found, self.expected = what, found, expected
        super().__init__(f"{what}: found {plain(found)}; expected {expected}")


class InvalidField(InvalidValue):
    """A field of a record has an impossible value; `use` says for which use it is impossible, "" for any."""

    def __init__(self, record: str, field: str, found: object, expected: str, use: str = "") -> None:
        self.record, self.field, self.use = record, field, use
        super().__init__(" ".join(filter(None, (record, field, use))), found, expected)
