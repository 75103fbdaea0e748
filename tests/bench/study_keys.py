"""The keys of a study file, by its schema; `python -m tests.bench.study_keys` writes them into docs/study_file.md."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, get_args

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from kinematics import MATERIALS, MECHANISMS, Mechanism, Structure
from studies.building.against_mechanism import study_table
from studies.study_file.keys import Key, Table
from studies.study_file.study import Study
from tests.bench.page import ROOT, write_between

PAGE = ROOT / "docs" / "study_file.md"
NAME, BY = "keys", "python -m tests.bench.study_keys"
_OF_THE_MECHANISM = {  # the key, and what it holds
    "coordinates": ("a coordinate of the pose", "numbers"),
    "masses": ("a mass of the mechanism", "numbers"),
    "materials": ("a kind of member of the mechanism", "the name of a material"),
}

_SIGNED = "The method `robot.internal_determinant(poses)` keeps the sign; the margin of that name is its modulus."


def main() -> None:
    """Write the page's tables."""
    write_between(PAGE, NAME, tables(), BY)


def tables() -> str:
    """Markdown: the keys of each table of the file, then those that only a mechanism knows."""
    parts = [_section(heading, model) for heading, model in [("At the top", Study), *sections(Study, ())]]
    return "\n".join([*parts, _of_mechanisms(), _margins()])


def sections(model: type[BaseModel], path: tuple[str, ...]) -> Iterator[tuple[str, type[BaseModel]]]:
    """Every table below a model: its heading as the file spells it, and its model."""
    for name, field in model.model_fields.items():
        if not isinstance(node := _node(field), Table):
            continue
        for inner in _models(field.annotation):
            spelled = ".".join((*path, name))
            yield f"`[[{spelled}]]`" if node.rows else f"`[{spelled}]`", inner
            yield from sections(inner, (*path, name))


def _section(heading: str, model: type[BaseModel]) -> str:
    if "kind" in model.model_fields:
        heading += f' with `kind = "{get_args(model.model_fields["kind"].annotation)[0]}"`'
    fields = {name: f for name, f in model.model_fields.items() if _node(f) or name in _OF_THE_MECHANISM}
    rows = [f"| {_key(n, f)} | {_holds(n, f)} | {_default(f)} | {f.description or ''} |" for n, f in fields.items()]
    return "\n".join(
        [f"### {heading}", "", "| key | holds | default | meaning |", "| --- | --- | --- | --- |", *rows, ""]
    )


def _key(name: str, field: FieldInfo) -> str:
    node = _node(field)
    if node is None:
        return _OF_THE_MECHANISM[name][0]
    return f"`{name}`, `{name}_{node.suffix}`" if isinstance(node, Key) and node.suffix else f"`{name}`"


def _holds(name: str, field: FieldInfo) -> str:
    node = _node(field)
    if isinstance(node, Key):
        of_mechanism = node.expected.endswith(" of") and not node.choices
        return f"{node.describe()} those below" if of_mechanism else node.describe()
    return _OF_THE_MECHANISM[name][1] if node is None else "tables" if node.rows else "a table"


def _default(field: FieldInfo) -> str:
    if field.is_required() and _node(field):
        return "required"
    value = field.default
    if isinstance(value, list | tuple) and value:
        return f"`[{', '.join(map(_spelled, value))}]`"
    return f"`{_spelled(value)}`" if isinstance(value, str | int | float) else ""


def _spelled(value: object) -> str:
    return f'"{value}"' if isinstance(value, str) else f"{value}"


def _of_mechanisms() -> str:
    """What each mechanism's own keys are called, with their SI units or default materials."""
    lines = [
        "### Of each mechanism",
        "",
        "| mechanism | pose | `[geometry]` | `[inertia]` | `[structure]` | `[ranges]` | margins |",
    ]
    lines.append("| --- " * 7 + "|")
    for name, kind in MECHANISMS.items():
        keys = study_table(kind, {}).keys
        own = [_named(keys["geometry"]), _named(keys["inertia"]), _members(kind), _named(keys["ranges"])]
        lines.append(f"| {' | '.join([name, ', '.join(kind.pose_names), *own, ', '.join(kind.margins)])} |")
    return "\n".join(lines) + "\n"


def _members(mechanism: type[Mechanism]) -> str:
    """The kinds of members, each with its default material."""
    names = {material: name for name, material in MATERIALS.items()}
    return ", ".join(f"`{kind}` ({names[getattr(Structure(), kind)]})" for kind in mechanism.member_kinds())


def _margins() -> str:
    """Every margin of any mechanism, in its own words."""
    margins = {name: margin for kind in MECHANISMS.values() for name, margin in kind.margins.items()}
    rows = [f"| `{name}` | {margin.unit} | {margin.words} |" for name, margin in margins.items()]
    head = ["### The margins", "", "| margin | unit | what it is |", "| --- | --- | --- |"]
    return "\n".join([*head, *rows, "", _SIGNED, ""])


def _named(table: Key | Table) -> str:
    keys: Mapping[str, Key | Table] = table.keys if isinstance(table, Table) else {}
    return ", ".join(
        f"`{n}`" + (f" ({key.unit})" if key.unit else "") for n, key in keys.items() if isinstance(key, Key)
    )


def _node(field: FieldInfo) -> Key | Table | None:
    return next((m for m in field.metadata if isinstance(m, Key | Table)), None)


def _models(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for part in get_args(annotation) for model in _models(part)]


if __name__ == "__main__":
    main()
