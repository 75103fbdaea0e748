"""Files that are whole or not there at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from kinematics.errors import LinkwrightError


class CannotWrite(LinkwrightError):
    """The output folder or a file in it cannot be written."""

    def __init__(self, path: Path, reason: str) -> None:
        self.path, self.reason = path, reason
        super().__init__(f"{path}: cannot write: {reason}")


def require_writable(folder: Path) -> None:
    """Try to make the folder and a file in it, before hours of work go into what it should hold; neither is left.

    Raises:
        CannotWrite: with the path and the system's reason.
    """
    if folder.is_file():
        raise CannotWrite(folder, "it is a file; expected a folder")
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise CannotWrite(folder, error.strerror or str(error)) from error
    finally:
        for path in missing:
            with suppress(OSError):  # not made, or in use by now
                path.rmdir()


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
