"""Errors of paths, timing and files. Each holds its data."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path as FilePath
from typing import NamedTuple

from kinematics import InvalidValue, LinkwrightError


def _place(at: float, pose: Sequence[float] | None, waypoint: int | None) -> str:
    """A place on a path, in words."""
    of_pose = "" if pose is None else f", pose ({', '.join(f'{v:.6g}' for v in pose)})"
    near = "" if waypoint is None else f", nearest to waypoint {waypoint}"
    return f"path at s = {at:.6g} m{of_pose}{near}"


class RoughPath(LinkwrightError):
    """The path's tangent is not of unit length, or it jumps: a cusp or a kink cannot be passed at speed."""

    def __init__(self, at: float, what: str, found: float, bound: float, waypoint: int | None = None) -> None:
        self.at, self.what, self.found, self.bound, self.waypoint = at, what, found, bound, waypoint
        super().__init__(
            f"{_place(at, None, waypoint)}: found {what} of {found:.4g}; expected at most {bound:.4g}: "
            "a stop where the path reverses (a corner without a blend), or a larger blend"
        )


class InvalidPath(InvalidValue):
    """A pose does not fit into its path; poses count from 1."""

    def __init__(self, pose: int, field: str, found: object, expected: str) -> None:
        self.pose, self.field = pose, field
        super().__init__(f"{field} of pose {pose} of the path", found, expected)


class UnsuitedPath(InvalidValue):
    """A timing law cannot use a path of this kind."""

    def __init__(self, law: str, found: str, expected: str) -> None:
        self.law = law
        super().__init__(f"path of the {law} law", found, expected)


class PathRefused(LinkwrightError):
    """A path has a pose where a limb cannot reach or the robot is singular, or it could not be proved that it has none.

    `at` is the arc length [m]. `place` is where the margin is smallest, such as "limb 1"; None means all limbs
    together. If the margin fails, `bound` is its upper bound there; if it is undecided, `bound` is its best lower
    bound. `waypoint` is the nearest one.
    """

    def __init__(
        self,
        margin: str,
        at: float,
        pose: Sequence[float],
        place: str | None,
        bound: float,
        proved: bool,
        waypoint: int | None = None,
    ) -> None:
        self.margin, self.at, self.place, self.bound, self.proved = margin, at, place, bound, proved
        self.pose, self.waypoint = tuple(float(v) for v in pose), waypoint
        where = _place(at, self.pose, waypoint)
        of_place = "" if place is None else f" of {place}"
        found = f"at most {bound:.6g}" if proved else f"undecided (only at least {bound:.6g} is proved)"
        super().__init__(f"{where}: the {margin} margin{of_place} is {found}; expected above 0")


class PathBeyondLimit(LinkwrightError):
    """A path has a pose that breaks a limit at any speed.

    `limit` is the field of the limits and `at` the arc length [m]. `found` is the joint's value outside `allowed` in
    SI: its position or, with `of_torque`, the torque for the weight at rest. `waypoint` is the nearest one, counted
        from 1.
    """

    exit_status = 1

    def __init__(
        self,
        limit: str,
        of_torque: bool,
        joint: str,
        at: float,
        pose: Sequence[float],
        found: float,
        allowed: tuple[float, float],
        unit: str,
        waypoint: int | None = None,
    ) -> None:
        self.limit, self.of_torque, self.joint, self.at = limit, of_torque, joint, at
        self.found, self.allowed = found, allowed
        self.pose, self.waypoint = tuple(float(v) for v in pose), waypoint
        what = (
            f"holding the weight at rest needs a torque at {joint} of" if of_torque else f"the position of {joint} is"
        )
        super().__init__(
            f"{_place(at, self.pose, waypoint)}: {what} {found:.6g} {unit}; "
            f"expected from {allowed[0]:.6g} to {allowed[1]:.6g}"
        )


class MoveRefused(LinkwrightError):
    """A move passes a pose that is not allowed. `found` says why, `time` is when [s]; NaN if that is not known yet."""

    exit_status = 1

    def __init__(self, found: str, time: float, pose: Sequence[float]) -> None:
        self.found, self.time, self.pose = found, time, tuple(float(v) for v in pose)
        when = "" if math.isnan(time) else f" at t = {time:.6g} s"
        super().__init__(
            f"move{when}, about pose ({', '.join(f'{v:.6g}' for v in self.pose)}): found {found}; "
            "expected every pose within reach and within the ranges, and no singular pose"
        )


class TimingFailed(LinkwrightError):
    """No time law was found."""

    exit_status = 1

    def __init__(self, law: str, asked: Mapping[str, object], found: str) -> None:
        self.law, self.asked, self.found = law, dict(asked), found
        what = ", ".join(f"{name} {value}" for name, value in self.asked.items() if name != "path")
        super().__init__(f"{law} law: {found}; asked for {what}")


class JointPeak(NamedTuple):
    """Where a limited quantity is largest over its limit: the joint, the time [s], the value and the limit in SI.

    `ratio` is the value over the limit.
    """

    joint: str
    time: float
    value: float
    limit: float
    ratio: float

    def __str__(self) -> str:
        return f"{self.joint} at t = {self.time:.6g} s: {self.value:.6g}, limit {self.limit:.6g}"


class LimitsExceeded(LinkwrightError):
    """A motion breaks a limit by more than may be repaired. `peaks` says where, if it is known."""

    exit_status = 1

    def __init__(
        self, failures: Mapping[str, float], bound: float, peaks: Mapping[str, JointPeak] | None = None
    ) -> None:
        self.failures, self.bound, self.peaks = dict(failures), bound, dict(peaks or {})

        def told(name: str, value: float) -> str:
            where = f" ({self.peaks[name]})" if name in self.peaks else ""
            return f"{name} at {value:.6g}{where}"

        what = ", ".join(told(name, value) for name, value in self.failures.items())
        super().__init__(f"the motion has {what} of its limit; expected at most {bound:.6g}")

    @classmethod
    def of_peaks(cls, peaks: Mapping[str, JointPeak]) -> LimitsExceeded:
        """The error for those peaks of a motion that are above their limits."""
        return cls({name: peak.ratio for name, peak in peaks.items()}, 1.0, peaks)


class SetpointFileError(LinkwrightError):
    """A set-point file is not as `write_setpoints` writes it."""

    def __init__(self, file: FilePath, line: int, found: str, expected: str) -> None:
        self.file, self.line, self.found, self.expected = file, line, found, expected
        super().__init__(f"{file}, line {line}: found {found}; expected {expected}")


class WaypointFileError(LinkwrightError):
    """A file of waypoints cannot be used; `column` is "" if a whole line is at fault."""

    def __init__(self, file: FilePath, line: int, column: str, found: str, expected: str) -> None:
        self.file, self.line, self.column, self.found, self.expected = file, line, column, found, expected
        where = f"{file}, line {line}" + (f", column {column}" if column else "")
        super().__init__(f"{where}: found {found}; expected {expected}")
