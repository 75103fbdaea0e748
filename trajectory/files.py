"""Files that are whole or not there at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path

from kinematics.errors import LinkwrightError


class CannotWrite(LinkwrightError):
    """The output folder or a file in it cannot be written."""

    def __init__(self, path: Path, reason: str) -> None:
        self.path, self.reason = path, reason
        super().__init__(f"{path}: cannot write: {reason}")


def require_writable(folder: Path) -> None:
    """Make the folder and try it, before hours of work go into what it should hold.

    Raises:
        CannotWrite: with the path and the system's reason.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise CannotWrite(folder, error.strerror or str(error)) from error


def write_files(folder: Path, files: Mapping[str, str | bytes]) -> list[Path]:
    """Write all files into a folder; each replaces its predecessor at once, and none is touched if one cannot be made.

    A name may begin with folders, which are made.

    Raises:
        CannotWrite: with the path and the system's reason.
    """
    prepared: list[tuple[str, Path]] = []
    try:
        for name, content in files.items():
            data, target = content.encode() if isinstance(content, str) else content, folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
            prepared.append((temporary, target))
            with os.fdopen(handle, "wb") as stream:
                stream.write(data)
            os.chmod(temporary, 0o644)
        for temporary, target in prepared:
            os.replace(temporary, target)
    except OSError as error:
        raise CannotWrite(folder, error.strerror or str(error)) from error
    finally:
        for temporary, _ in prepared:
            Path(temporary).unlink(missing_ok=True)
    return [target for _, target in prepared]
