"""Errors of design: each names what was asked, what was found and where."""

from __future__ import annotations

from pathlib import Path

from kinematics import LinkwrightError, plain


class InvalidRegion(LinkwrightError):
    """A region that is empty, unbounded, or not in the mechanism's coordinates."""

    def __init__(self, key: str, found: object, expected: str) -> None:
        self.key, self.found, self.expected = key, found, expected
        super().__init__(f"region, {key}: found {plain(found)}; expected {expected}")


class InvalidSection(LinkwrightError):
    """A plane that the region does not have."""

    def __init__(self, key: str, found: object, expected: str) -> None:
        self.key, self.found, self.expected = key, found, expected
        super().__init__(f"section, {key}: found {plain(found)}; expected {expected}")


class OutOfTime(LinkwrightError):
    """A search that could not come to a first answer within its time."""

    exit_status = 1

    def __init__(self, what: str, seconds: float, reached: str) -> None:
        self.what, self.seconds, self.reached = what, seconds, reached
        super().__init__(f"{what}: {seconds:g} s were used up at {reached}; expected more time, or a coarser question")


class OtherCertificate(LinkwrightError):
    """A certificate that was made for something else than what is asked."""

    exit_status = 1

    def __init__(self, what: str, found: object, expected: object) -> None:
        self.what, self.found, self.expected = what, found, expected
        super().__init__(f"certificate, {what}: made for {plain(found)}; expected {plain(expected)}")


class BrokenCertificate(LinkwrightError):
    """A certificate that does not prove what it says."""

    exit_status = 1

    def __init__(self, reason: str, box: object = None) -> None:
        self.reason, self.box = reason, box
        super().__init__(f"certificate: {reason}{f', box {plain(box)}' if box is not None else ''}")


class UnreadableCertificate(BrokenCertificate):
    """A file that holds no certificate; `path` names it."""

    exit_status = 2

    def __init__(self, path: Path, found: object) -> None:
        self.path, self.found = path, found
        super().__init__(f"{path} cannot be read: found {found}; expected what `save_certificate` wrote")
