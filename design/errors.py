"""Errors of `design`. Each names what was found and what would be right."""

from __future__ import annotations

from pathlib import Path

from kinematics import LinkwrightError, plain


class InvalidRegion(LinkwrightError):
    """A region is empty, unbounded, or not in the mechanism's coordinates."""

    def __init__(self, key: str, found: object, expected: str) -> None:
        self.key, self.found, self.expected = key, found, expected
        super().__init__(f"region, {key}: found {plain(found)}; expected {expected}")


class InvalidSection(LinkwrightError):
    """The region has no such plane."""

    def __init__(self, key: str, found: object, expected: str) -> None:
        self.key, self.found, self.expected = key, found, expected
        super().__init__(f"section, {key}: found {plain(found)}; expected {expected}")


class OutOfTime(LinkwrightError):
    """A search found no first answer within its time."""

    exit_status = 1

    def __init__(self, what: str, seconds: float, reached: str) -> None:
        self.what, self.seconds, self.reached = what, seconds, reached
        super().__init__(
            f"{what}: found no answer in {seconds:g} s, reached {reached}; expected more time, or an easier question"
        )


class OtherCertificate(LinkwrightError):
    """A certificate was made for another question."""

    exit_status = 1

    def __init__(self, what: str, found: object, expected: object) -> None:
        self.what, self.found, self.expected = what, found, expected
        super().__init__(f"certificate, {what}: made for {plain(found)}; expected {plain(expected)}")


class BrokenCertificate(LinkwrightError):
    """A certificate does not prove its claim."""

    exit_status = 1

    def __init__(self, reason: str, box: object = None) -> None:
        self.reason, self.box = reason, box
        super().__init__(f"certificate: {reason}{f', box {plain(box)}' if box is not None else ''}")


class UnreadableCertificate(BrokenCertificate):
    """The file `path` holds no certificate."""

    exit_status = 2

    def __init__(self, path: Path, found: object) -> None:
        self.path, self.found = path, found
        super().__init__(f"{path} cannot be read: found {found}; expected a file that `save_certificate` wrote")
