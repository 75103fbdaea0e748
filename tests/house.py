"""The structure of the house as its imports show it; `python -m tests.house` writes its map into ARCHITECTURE.md.

A room is a folder of modules; its door is its `__init__`. Imports inside functions and for types count too.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "ARCHITECTURE.md"
FOLDERS = ("kinematics", "design", "trajectory", "studies")
MODULES = {
    ".".join(file.relative_to(ROOT).with_suffix("").parts): file
    for folder in FOLDERS
    for file in sorted((ROOT / folder).rglob("*.py"))
}


def targets(tree: ast.AST) -> Iterator[str]:
    """What a module imports: modules, or rooms where a name comes through their door."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, "a relative import"
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                yield whole if whole in MODULES else str(node.module)


def imports(name: str) -> list[str]:
    """The imports of a module, those from other projects too."""
    return [*targets(ast.parse(MODULES[name].read_text()))]


def ours(name: str) -> list[str]:
    """The imports of a module that stay in the house."""
    return [t for t in imports(name) if t.split(".")[0] in {*FOLDERS, "tests"}]


def is_door(name: str) -> bool:
    """Whether a module is the `__init__` of its room."""
    return name.endswith("__init__")


def room_of(name: str) -> str:
    """The folder that a module stands in, or the room itself if a name came through its door."""
    return name if f"{name}.__init__" in MODULES else name.rpartition(".")[0]


def rooms() -> dict[str, set[str]]:
    """Each room and the other rooms that its modules import from; doors only pass names on."""
    found: dict[str, set[str]] = {room_of(name): set() for name in MODULES}
    for name in MODULES:
        if not is_door(name):
            found[room_of(name)] |= {room_of(t) for t in ours(name)} - {room_of(name)}
    return found


def reached_rooms(*start: str) -> set[str]:
    """These rooms and all that their modules import, one by way of another."""
    graph, wanted, found = rooms(), list(start), set[str]()
    while wanted:
        room = wanted.pop()
        if room not in found:
            found.add(room)
            wanted += graph[room]
    return found


def table() -> str:
    """A row a room: what it holds, after its door's first line, and what it imports."""
    rows = ["| room | holds | imports |", "| --- | --- | --- |"]
    for room, used in sorted(rooms().items(), key=lambda item: (FOLDERS.index(item[0].split(".")[0]), item[0])):
        words = (ast.get_docstring(ast.parse(MODULES[f"{room}.__init__"].read_text())) or "").splitlines()[0]
        names = ", ".join(f"`{u}`" for u in sorted(used)) or "nothing of ours"
        rows.append(f"| `{room.replace('.', '/')}/` | {words} | {names} |")
    return "\n".join(rows) + "\n"


if __name__ == "__main__":
    from tests.bench.page import write_between

    write_between(PAGE, "rooms", table(), by="python -m tests.house")
