"""Where the studies are."""

from __future__ import annotations

import difflib
from pathlib import Path

from kinematics.errors import LinkwrightError

FOLDER = Path(__file__).parent
FILE = "study.toml"


class UnknownStudy(LinkwrightError):
    """Neither a study's name nor a path to one."""

    def __init__(self, found: str, known: list[str]) -> None:
        self.found, self.known = found, known
        if Path(found).is_dir():
            found = f"{found}, a folder without {FILE},"
        near = difflib.get_close_matches(found, known, n=1)
        hint = f" (did you mean {near[0]}?)" if near else ""
        super().__init__(f"study: found {found}; expected one of {', '.join(known)}, or a path to a {FILE}{hint}")


def study_names() -> list[str]:
    """The studies that come with Linkwright."""
    return sorted(path.parent.name for path in FOLDER.glob(f"*/{FILE}"))


def study_path(given: str) -> Path:
    """The study file that a name, a folder or a path means.

    Raises:
        UnknownStudy: none of these.
    """
    if given in study_names():
        return FOLDER / given / FILE
    path = Path(given)
    if path.is_dir() and (path / FILE).is_file():
        return path / FILE
    if path.is_file() or path.suffix == ".toml":
        return path
    raise UnknownStudy(given, study_names())
