"""Files that drives and controllers read, one module for each format."""

from trajectory.drive_files.drive import Drive
from trajectory.drive_files.formats import FORMATS, Format, drive_files, format_named

__all__ = [
    "FORMATS",
    "Drive",
    "Format",
    "drive_files",
    "format_named",
]
