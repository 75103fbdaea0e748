"""Errors of design: each names what was asked, what was found and where."""

from __future__ import annotations

from kinematics.errors import LinkwrightError


class InvalidRegion(LinkwrightError):
    """A region that is empty, unbounded, or not in the mechanism's coordinates."""

    def __init__(self, key: str, found: object, expected: str) -> None:
        self.key, self.found, self.expected = key, found, expected
        super().__init__(f"region, {key}: found {found}; expected {expected}")


class SynthesisFailed(LinkwrightError):
    """The optimisation has no answer to stand by."""

    exit_status = 1

    def __init__(self, reason: str, status: str) -> None:
        self.reason, self.status = reason, status
        super().__init__(f"no optimum: {reason} (solver status: {status})")
