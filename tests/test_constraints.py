"""`constraints.txt` pins what an install takes: all of it, nothing else, and each one as pyproject.toml allows."""

import re
import tomllib
from importlib.metadata import requires
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]


def asked(*extras: str) -> list[Requirement]:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    optional = (text for extra in extras for text in project["optional-dependencies"][extra])
    return [Requirement(text) for text in (*project["dependencies"], *optional)]


def pinned() -> dict[str, str]:
    lines = (ROOT / "constraints.txt").read_text().split()
    pairs = [re.fullmatch(r"([\w.-]+)==([\w.]+)", line) for line in lines]
    assert all(pairs), lines
    pins = {canonicalize_name(pair[1]): pair[2] for pair in pairs if pair}
    assert len(pins) == len(lines)
    return pins


def needed(*extras: str) -> set[str]:
    """Names of all that an install takes, by what the installed distributions say that they require."""
    names: set[tuple[str, str]] = set()
    left = asked(*extras)
    while left:
        requirement = left.pop()
        for extra in ("", *requirement.extras):
            key = (canonicalize_name(requirement.name), extra)
            if key not in names:
                names.add(key)
                own = [Requirement(text) for text in requires(requirement.name) or ()]
                left += [r for r in own if r.marker is None or r.marker.evaluate({"extra": extra})]
    return {name for name, _ in names}


def test_an_install_for_the_tests_is_pinned_and_nothing_else_is() -> None:
    """What only the benchmarks compare with is pinned by its extra."""
    assert needed("test") == set(pinned())


def test_every_pin_is_a_version_that_the_project_allows() -> None:
    pins = pinned()
    for requirement in asked("test"):
        assert pins[canonicalize_name(requirement.name)] in requirement.specifier, requirement
