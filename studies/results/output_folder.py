"""A folder of results, and the list of what this program wrote there.

The list, `linkwright_files.json`, has the SHA-256 of each file. A file that still has this content belongs to the
program: it may be replaced, and it is removed when files of its kind are written for another question. Any other file
belongs to the user.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path, PurePosixPath

from kinematics import LinkwrightError
from trajectory import CannotWrite, require_writable, write_files

try:
    import fcntl
except ImportError:  # on Windows nothing stops two commands from writing to one folder at once
    fcntl = None  # type: ignore[assignment]

LIST = "linkwright_files.json"
_FORMAT = "linkwright files 1"

Contents = Mapping[str, str | bytes]  # by the file's name in the folder


class FileInTheWay(LinkwrightError):
    """A file of the user has the name of a result."""

    def __init__(self, path: Path) -> None:
        self.path = path
        super().__init__(
            f"{path}: found a file that this program did not write, or that changed since; "
            "expected no such file, or --force to replace it"
        )


@dataclass(frozen=True)
class Own:
    """One file of the list: its kind, the digest of the question that it answers, and the SHA-256 of its content."""

    kind: str
    made_for: str
    sha256: str


@dataclass(frozen=True)
class Written:
    """The files that a command wrote or removed, and those of earlier commands that answer another question."""

    files: tuple[Path, ...] = ()
    removed: tuple[Path, ...] = ()
    left: tuple[Path, ...] = ()

    def __add__(self, other: Written) -> Written:
        return Written(self.files + other.files, self.removed + other.removed, self.left + other.left)


@dataclass(frozen=True)
class OutputFolder:
    """A folder that commands write into. With `force`, files of the user are replaced too; they are never removed."""

    path: Path
    force: bool = False

    def require(self, names: Iterable[str] = ()) -> None:
        """Check before the work that files of these names can be written.

        Raises:
            FileInTheWay: one is the user's.
            CannotWrite: the folder or the list cannot be used.
        """
        require_writable(self.path)
        self._require_free(names, self._list())

    def owns(self, name: str) -> bool:
        """Whether a file still has the content that this program wrote.

        Raises:
            CannotWrite: the list cannot be used.
        """
        return self._unchanged(name, self._list())

    def write(self, files: Mapping[str, Contents], made_for: str) -> Written:
        """Write files, and remove the program's own files of the same kinds that answer another question.

        Args:
            files: by kind.
            made_for: digest of the question that the files answer.

        Raises:
            FileInTheWay: a file of the user is in the way; nothing is written then.
            CannotWrite: the folder cannot be written to.
        """
        contents = {name: content for kind in files.values() for name, content in kind.items()}
        with self._alone():
            known = self._list()
            self._require_free(
                (n for n, content in contents.items() if not _has(self.path / n, _sha256(content))), known
            )
            old = [n for n, own in known.items() if n not in contents and own.made_for != made_for]
            stale = [n for n in old if known[n].kind in files and self._unchanged(n, known)]
            left = [n for n in old if n not in stale and os.path.lexists(self.path / n)]
            entries = {n: own for n, own in known.items() if n not in stale and os.path.lexists(self.path / n)}
            entries |= {n: Own(kind, made_for, _sha256(c)) for kind, of in files.items() for n, c in of.items()}
            written = write_files(self.path, {**contents, LIST: _listed(entries)}, remove=stale)
        return Written(tuple(written[:-1]), self._paths(stale), self._paths(left))

    def _paths(self, names: Iterable[str]) -> tuple[Path, ...]:
        return tuple(self.path / name for name in names)

    def _require_free(self, names: Iterable[str], known: Mapping[str, Own]) -> None:
        for name in names:
            if not self._unchanged(name, known):
                require_free(self.path / name, self.force)

    def _unchanged(self, name: str, known: Mapping[str, Own]) -> bool:
        return name in known and _has(self.path / name, known[name].sha256)

    @contextmanager
    def _alone(self) -> Iterator[None]:
        """Keep other commands from writing into the folder meanwhile. A folder that stays empty is removed again."""
        missing = [path for path in (self.path, *self.path.parents) if not path.exists()]
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            handle = None if fcntl is None else os.open(self.path, os.O_RDONLY)
        except OSError as error:
            raise CannotWrite(self.path, error.strerror or str(error)) from error
        try:
            if handle is not None:
                fcntl.flock(handle, fcntl.LOCK_EX)
            yield
        finally:
            if handle is not None:
                os.close(handle)
            for path in missing:
                with suppress(OSError):  # not empty
                    path.rmdir()

    def _list(self) -> dict[str, Own]:
        file = self.path / LIST
        if not file.exists():
            return {}
        try:
            data = json.loads(file.read_bytes())
            entries = {name: Own(**entry) for name, entry in data["files"].items()}
            if data["format"] != _FORMAT or not all(map(_inside, entries)):
                raise ValueError
            if not all(isinstance(v, str) for own in entries.values() for v in asdict(own).values()):
                raise ValueError
        except (OSError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
            raise CannotWrite(
                file, "this is not a list of files by Linkwright; expected the list unchanged, or no such file"
            ) from None
        return entries


def require_free(file: Path, force: bool, content: str | bytes | None = None) -> None:
    """Check that a file can be written.

    Args:
        force: a file that is there may be replaced.
        content: what will be written; a file that already has it is accepted.

    Raises:
        FileInTheWay: there is a file with other content.
        CannotWrite: it is a folder, or the system does not accept the name.
    """
    try:
        if file.is_dir():
            raise CannotWrite(file, "it is a folder")
    except OSError as error:  # the system does not accept the name
        raise CannotWrite(file, error.strerror or str(error)) from error
    if os.path.lexists(file) and not force and not (content is not None and _has(file, _sha256(content))):
        raise FileInTheWay(file)


def _has(file: Path, sha256: str) -> bool:
    """Whether the file is there, is no link to another one, and has this content."""
    try:
        return file.is_file() and not file.is_symlink() and _sha256(file.read_bytes()) == sha256
    except OSError:
        return False


def _inside(name: str) -> bool:
    """Whether a name stays in its folder."""
    path = PurePosixPath(name)
    return bool(path.parts) and not path.is_absolute() and ".." not in path.parts


def _listed(entries: Mapping[str, Own]) -> str:
    files = {name: asdict(entries[name]) for name in sorted(entries)}
    return json.dumps({"format": _FORMAT, "files": files}, indent=2) + "\n"


def _sha256(content: str | bytes) -> str:
    return hashlib.sha256(content.encode() if isinstance(content, str) else content).hexdigest()
