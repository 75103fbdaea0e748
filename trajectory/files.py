"""Write files so that each is complete or does not appear at all."""

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
    """Check, before long work, that the folder and a file in it can be made. Both are removed again.

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
    """Write all files into a folder. Each replaces the old file at once. If one cannot be made, no file is changed.

    An interrupt waits until all files are written.

    Args:
        folder: the folder; it is made if needed.
        files: content by name. A name may begin with folders, which are made if needed.
        remove: names of files to remove after the others are written. Folders that become empty are removed too.

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
    """Write a temporary file beside the target, complete on the disk. If that fails, the file is removed."""
    handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name[:64]}.")
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content.encode() if isinstance(content, str) else content)
            stream.flush()
            os.fsync(stream.fileno())  # some systems report a full disk only here
        os.chmod(temporary, 0o644)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
    return temporary


def _make(folder: Path) -> list[Path]:
    """Make a folder; returns the folders that were missing, the innermost first."""
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        _unmake(missing)
        raise
    return missing


def _unmake(folders: Iterable[Path]) -> None:
    """Remove those of these folders that are empty."""
    for path in folders:
        with suppress(OSError):  # it was not made, or is in use
            path.rmdir()


@contextmanager
def _told(folder: Path) -> Iterator[None]:
    """Raise an error of the system as `CannotWrite`, with the path that the system names."""
    try:
        yield
    except (
        OSError,
        ValueError,
    ) as error:  # ValueError: a name that no system accepts, such as one with a null character
        path = getattr(error, "filename2", None) or getattr(error, "filename", None) or folder
        raise CannotWrite(Path(os.fsdecode(path)), getattr(error, "strerror", None) or str(error)) from error


@contextmanager
def _interrupts_wait() -> Iterator[None]:
    """Delay signals that would end the program until after the block."""
    if threading.current_thread() is not threading.main_thread():
        yield  # signal handlers run only in the main thread
        return
    came: list[int] = []
    handlers = {kind: signal.signal(kind, lambda n, _: came.append(n)) for kind in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for kind, handler in handlers.items():
            signal.signal(kind, handler or signal.SIG_DFL)  # None: the handler was not set by Python
        for number in came:
            signal.raise_signal(number)
