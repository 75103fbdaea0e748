"""The two questions of a study, each with a digest: which geometry is best, and how fast its cycle can be.

Masses, materials and loads belong to the first only if a margin that it asks for depends on them. Keys that decide
neither answer, such as the title, the budget or the formats of the drive files, belong to no question. The claims to be
proved are compared separately.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from studies.study_file.study import Study

DESIGN = frozenset(
    (
        "mechanism",
        "code",
        "geometry",
        "ranges",
        "surroundings",
        "region",
        "home",
        "fvi",
        "optimise",
        "dense_sample",
        "requirement",
    )
)
CYCLE = frozenset(("inertia", "material", "structure", "trajectory"))
_OF_RECORDS = {  # their tables
    "inertia": ("inertia",),
    "structure": ("material", "structure"),
    "load": ("load",),
    "surroundings": ("surroundings",),
}
_NO_MATTER = {"trajectory": {"files": True, "drive": True, "path": {"file": True}}}  # they do not change the motion
_GATHERED = ("coordinates", "masses", "materials")  # fields of the models that no file has
_FEW = 12  # up to so many waypoints are written one by one

Question = dict[
    str, Any
]  # value by key, as a study file has it in SI: "region.z"; rows by their number: "requirement.1"


def design_question(study: Study) -> Question:
    """All keys that decide the geometry and its figures, to 12 digits. Defaults are left out."""
    margins = [study.mechanism_class.margins[row.margin] for row in study.requirement]
    more = {table for margin in margins for record in margin.records for table in _OF_RECORDS[record]}
    return _flat(study.model_dump(include=set(DESIGN) | more, exclude_defaults=True, exclude_none=True))


def cycle_question(study: Study) -> Question:
    """All keys that decide the cycle of a given geometry; empty without a cycle."""
    if study.trajectory is None:
        return {}
    exclude: Any = _NO_MATTER
    asked = study.model_dump(include=set(CYCLE), exclude=exclude, exclude_defaults=True, exclude_none=True)
    path = asked["trajectory"].get("path", {})
    if len(waypoints := path.get("waypoint", ())) > _FEW:
        path["waypoint"] = f"{len(waypoints)} poses, sha256 {digest_of({'waypoint': plain(waypoints)})}"
    return _flat(asked)


def digest_of(question: Mapping[str, Any]) -> str:
    """The SHA-256 of a question (hex)."""
    return hashlib.sha256(json.dumps(question, sort_keys=True).encode()).hexdigest()


def changes(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, tuple[Any, Any]]:
    """The keys whose values differ, each with its value before and after; None for a missing one."""
    keys = dict.fromkeys([*before, *after])
    return {key: (before.get(key), after.get(key)) for key in keys if before.get(key) != after.get(key)}


def _flat(data: Mapping[str, Any]) -> Question:
    return dict(_leaves(plain(data)))


def _leaves(node: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    rows = isinstance(node, list) and bool(node) and all(isinstance(row, dict) for row in node)
    if not (rows or isinstance(node, dict)):
        yield path, node
        return
    for key, value in enumerate(node, 1) if rows else node.items():
        yield from _leaves(value, path if key in _GATHERED else f"{path}.{key}".lstrip("."))


def plain(value: Any) -> Any:
    """The data with lists for tuples and numbers of twelve digits, so that the rounding of a unit changes nothing."""
    match value:
        case float():
            return float(f"{value:.12g}") + 0.0  # no negative zero
        case dict():
            return {str(key): plain(entry) for key, entry in value.items()}
        case list() | tuple():
            return [plain(entry) for entry in value]
        case _:
            return value
