"""Find a study file by name or path."""

from __future__ import annotations

import difflib
from collections.abc import Callable
from pathlib import Path

from kinematics import LinkwrightError
from studies.errors import spelled

FOLDER = Path(__file__).parents[1]
FILE = "study.toml"


class UnknownStudy(LinkwrightError):
    """The argument is neither a study's name nor a path to a study."""

    def __init__(self, found: str, known: list[str]) -> None:
        self.found, self.known = found, known
        near = difflib.get_close_matches(found[:64], known, n=1)  # a longer word is not a misspelt name
        hint = f" (did you mean {near[0]}?)" if near else ""
        what = f", a folder without {FILE}" if found and _is(Path.is_dir, Path(found)) else ""
        super().__init__(
            f"study: found {spelled(found)}{what}; expected one of {', '.join(known)}, or a path to a {FILE}{hint}"
        )


def study_names() -> list[str]:
    """The studies that come with Linkwright."""
    return sorted(path.parent.name for path in FOLDER.glob(f"*/{FILE}"))


def study_path(given: str) -> Path:
    """The study file that a name, a folder or a path means.

    Raises:
        UnknownStudy: there is no such study.
    """
    if given in study_names():
        return FOLDER / given / FILE
    path = Path(given)
    if given and _is(Path.is_dir, path) and (path / FILE).is_file():
        return path / FILE
    if _is(Path.is_file, path) or path.suffix == ".toml":
        return path
    raise UnknownStudy(given, study_names())


def _is(kind: Callable[[Path], bool], path: Path) -> bool:
    """Whether a path is of a kind. A name that the system does not accept, such as one too long, is of none."""
    try:
        return kind(path)
    except (OSError, ValueError):
        return False
