"""Errors of paths, timing and files; each carries its data."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path as FilePath

from kinematics.errors import LinkwrightError


class RoughPath(LinkwrightError):
    """The path's tangent is not of unit length, or it jumps: a cusp or a kink cannot be passed at speed."""

    def __init__(self, at: float, what: str, found: float, bound: float) -> None:
        self.at, self.what, self.found, self.bound = at, what, found, bound
        super().__init__(
            f"path at s = {at:.6g} m: {what} is {found:.4g}, expected at most {bound:.4g}; "
            "split a path where it reverses and time each piece from rest to rest, round its corner, or refine the grid"
        )


class TimingFailed(LinkwrightError):
    """No time law was found for what was asked."""

    exit_status = 1

    def __init__(self, law: str, asked: Mapping[str, object], found: str) -> None:
        self.law, self.asked, self.found = law, dict(asked), found
        what = ", ".join(f"{name} {value}" for name, value in self.asked.items())
        super().__init__(f"{law} law: {found}; asked for {what}")


class LimitsExceeded(LinkwrightError):
    """A motion breaks a limit by more than may be repaired."""

    exit_status = 1

    def __init__(self, failures: Mapping[str, float], bound: float) -> None:
        self.failures, self.bound = dict(failures), bound
        what = ", ".join(f"{name} at {value:.6g}" for name, value in self.failures.items())
        super().__init__(f"verification: {what} of its limit; expected at most {bound:.6g}")


class SetpointFileError(LinkwrightError):
    """A set-point file is not what the writer writes."""

    def __init__(self, file: FilePath, line: int, found: str, expected: str) -> None:
        self.file, self.line, self.found, self.expected = file, line, found, expected
        super().__init__(f"{file}, line {line}: found {found}; expected {expected}")
