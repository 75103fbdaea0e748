"""Files that are whole or not there at all."""

from __future__ import annotations

import os
import signal
import tempfile
import threading
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from kinematics import LinkwrightError


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
    with _told(folder):
        if folder.exists() and not folder.is_dir():
            raise CannotWrite(folder, "it is a file; expected a folder")
        made = _make(folder)
        try:
            with tempfile.TemporaryFile(dir=folder):
                pass
        finally:
            _unmake(made)


def write_files(folder: Path, files: Mapping[str, str | bytes], remove: Iterable[str] = ()) -> list[Path]:
    """Write all files into a folder; each replaces its predecessor at once, and none is touched if one cannot be made.

    An interrupt waits until all are written.

    Args:
        folder: made where it does not exist.
        files: content by name; a name may begin with folders, which are made.
        remove: names of files to remove once the others are written; folders that this leaves empty go too.

    Raises:
        CannotWrite: with the path and the system's reason.
    """
    with _interrupts_wait(), _told(folder):
        made: list[Path] = []
        prepared: list[tuple[str, Path]] = []
        try:
            for name, content in files.items():
                target = folder / name
                if target.is_dir():
                    raise CannotWrite(target, "it is a folder")
                made += _make(target.parent)
                prepared.append((_beside(target, content), target))
            for temporary, target in prepared:
                os.replace(temporary, target)
        finally:
            for temporary, _ in prepared:
                Path(temporary).unlink(missing_ok=True)
            _unmake(made)
        for name in remove:
            (folder / name).unlink(missing_ok=True)
            _unmake([(folder / parent) for parent in Path(name).parents if parent.name])
    return [target for _, target in prepared]


def _beside(target: Path, content: str | bytes) -> str:
    """A temporary file beside the target, on the disk with all of the content; nothing where that fails."""
    handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name[:64]}.")
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content.encode() if isinstance(content, str) else content)
            stream.flush()
            os.fsync(stream.fileno())  # a full disk may be told only here
        os.chmod(temporary, 0o644)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
    return temporary


def _make(folder: Path) -> list[Path]:
    """Make a folder; those that were missing, the innermost first."""
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        _unmake(missing)
        raise
    return missing


def _unmake(folders: Iterable[Path]) -> None:
    """Remove these folders, as far as they are empty."""
    for path in folders:
        with suppress(OSError):  # not made, or in use by now
            path.rmdir()


@contextmanager
def _told(folder: Path) -> Iterator[None]:
    """An error of the system as one of ours, with the path that the system names."""
    try:
        yield
    except (OSError, ValueError) as error:  # ValueError: a name that no system takes, such as one with a null in it
        path = getattr(error, "filename2", None) or getattr(error, "filename", None) or folder
        raise CannotWrite(Path(os.fsdecode(path)), getattr(error, "strerror", None) or str(error)) from error


@contextmanager
def _interrupts_wait() -> Iterator[None]:
    """Signals that would end the program take effect after the block."""
    if threading.current_thread() is not threading.main_thread():
        yield  # their handlers run in the main thread only
        return
    came: list[int] = []
    handlers = {kind: signal.signal(kind, lambda n, _: came.append(n)) for kind in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for kind, handler in handlers.items():
            signal.signal(kind, handler or signal.SIG_DFL)  # None: set by other than Python
        for number in came:
            signal.raise_signal(number)
