"""The formats of drive files by name: what a study's `files` and the command line's `--format` choose from."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from kinematics import InvalidValue
from trajectory.drive_files import cia402, pmac, ros2, xps, zaber
from trajectory.drive_files.drive import Drive
from trajectory.setpoints import Setpoints, setpoints_text

Writer = Callable[[str, Setpoints, Drive], dict[str, str | bytes]]


@dataclass(frozen=True)
class Format:
    """A format.

    Attributes:
        title: for people.
        write: (stem of the name, set-points, drive) -> content of each file by its name.
        interpolation: what such a drive does between set-points; None where that is open.
    """

    title: str
    write: Writer
    interpolation: str | None


def _csv(stem: str, setpoints: Setpoints, drive: Drive) -> dict[str, str | bytes]:  # noqa: ARG001
    return {f"{stem}.csv": setpoints_text(setpoints)}


FORMATS = {
    "csv": Format("all of each set-point, SI", _csv, None),
    "ros2": Format("ROS 2 JointTrajectory, YAML and MCAP", ros2.write, "quintic"),
    "cia402": Format("CiA 402 cyclic synchronous position, increments", cia402.write, "linear"),
    "zaber": Format("PVT CSV of Zaber's layout", zaber.write, "cubic"),
    "xps": Format("Newport XPS PVT trajectory", xps.write, "cubic"),
    "pmac": Format("PMAC PVT motion program", pmac.write, "cubic"),
}


def drive_files(
    stem: str, setpoints: Setpoints, formats: Iterable[str] = ("csv",), drive: Drive | None = None
) -> dict[str, str | bytes]:
    """Content of each file by its name, for `write_files`.

    Args:
        stem: what the files' names start with.
        setpoints: of a whole cycle or move.
        formats: out of `FORMATS`.
        drive: names and encoders of the axes.

    Raises:
        InvalidValue: an unknown format, a set-point that is not finite, or what a format cannot say.
    """
    setpoints.require_finite()
    files: dict[str, str | bytes] = {}
    for name in formats:
        files |= format_named(name).write(stem, setpoints, drive or Drive())
    return files


def format_named(name: str) -> Format:
    """One of `FORMATS`.

    Raises:
        InvalidValue: there is none of this name; all are listed.
    """
    if name not in FORMATS:
        known = ", ".join(f"{known} ({form.title})" for known, form in FORMATS.items())
        raise InvalidValue("format of a drive file", name, f"one of {known}")
    return FORMATS[name]
