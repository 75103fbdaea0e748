"""The reader's tables keep up with the code: what they name exists, no cell is empty, no equation is left out."""

import ast
import importlib
import pkgutil
import re
from functools import cache
from pathlib import Path
from typing import get_type_hints

import pytest

import kinematics
from kinematics import MECHANISMS

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "docs" / "equations"
INDEX = FOLDER / "index.md"
PAGES = sorted(set(FOLDER.glob("*.md")) - {INDEX})
EACH_PAGE = pytest.mark.parametrize("page", [INDEX, *PAGES], ids=lambda page: page.stem)
CODE = re.compile(r"`([^`]+)`")
TEST = re.compile(r"^(?:(?P<file>[\w/]+\.py): )?(?P<name>test_\w+)$")
PART = r"[A-Za-z_]\w*(?:\([^)]*\)|\[[^]]*\])?"
NAME = re.compile(rf"\.?{PART}(?:\.{PART})*")


def tables(text: str) -> list[list[dict[str, str]]]:
    """The rows of each table, by the names in its header."""
    found = []
    for block in re.split(r"\n(?!\|)", text):
        lines = [line for line in block.splitlines() if line.startswith("|")]
        if lines:
            cells = [[c.strip() for c in re.split(r"(?<!\\)\|", line.strip()[1:-1])] for line in lines]
            header, rule, *rows = cells
            assert set("".join(rule)) <= set("-: "), f"not a table's second line: {rule}"
            assert all(len(row) == len(header) for row in rows), [row for row in rows if len(row) != len(header)]
            found.append([dict(zip(header, row, strict=True)) for row in rows])
    return found


def rows_with(page: Path, column: str) -> list[dict[str, str]]:
    return [row for table in tables(page.read_text()) for row in table if column in row]


@cache
def known_tests() -> dict[str, list[str]]:
    """Every test function and the files that hold it, by their paths."""
    found: dict[str, list[str]] = {}
    for file in sorted((ROOT / "tests").rglob("test_*.py")):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
                found.setdefault(node.name, []).append(file.relative_to(ROOT).as_posix())
    return found


@cache
def names() -> dict[str, object]:
    """Every room of kinematics and every public name in a module."""
    found = [m.name for m in pkgutil.walk_packages(kinematics.__path__, "kinematics.")]
    modules = {name: importlib.import_module(name) for name in found}
    rooms = {name.rpartition(".")[2]: module for name, module in modules.items() if hasattr(module, "__path__")}
    own = {n: v for m in modules.values() for n, v in vars(m).items() if not n.startswith("_")}
    return {**own, **rooms}


def attribute(owner: object, part: str) -> object | None:
    """An attribute; of a call, `f(...)`, the type that it returns; of `d["key"]`, the item."""
    bare = re.split(r"[(\[]", part)[0]
    value = getattr(owner, bare, None) if owner is not names() else names().get(bare)
    if value is not None and part.endswith(")"):
        return get_type_hints(value)["return"]
    if value is not None and part.endswith("]"):
        return value.get(ast.literal_eval(part[len(bare) + 1 : -1]))
    return value


def resolved(name: str, owners: list[object]) -> object | None:
    """What a dotted name means on any of these, or None."""
    for owner in owners:
        value: object | None = owner
        for part in re.findall(PART, name):
            value = attribute(value, part) if value is not None else None
        if value is not None:
            return value
    return None


def mechanisms_of(page: Path) -> list[type]:
    """Those that the page names, or else all."""
    named = set(re.findall(r"\w+", page.read_text()))
    return [kind for name, kind in MECHANISMS.items() if name in named] or list(MECHANISMS.values())


def unknown_functions(cell: str, page: Path) -> list[str]:
    """Names in a cell that are no attribute of the page's mechanisms, no margin and nothing in kinematics.

    `.this` after `Class.that` is another attribute of the same class.
    """
    kinds, unknown, before = mechanisms_of(page), [], None
    margins = {margin for kind in kinds for margin in kind.margins}
    for code in CODE.findall(cell):
        if not NAME.fullmatch(code):
            unknown.append(code)
            continue
        name = f"{before}{code}" if code.startswith(".") else code
        before = name.rpartition(".")[0]
        if resolved(name, [names(), *kinds]) is None and not (code in margins and "margin" in cell):
            unknown.append(name)
    return unknown


@EACH_PAGE
def test_no_cell_is_empty(page):
    found = tables(page.read_text())
    assert sum(map(len, found)) > 3
    for row in (row for table in found for row in table):
        assert all(re.search(r"\w", cell) for cell in row.values()), row


@EACH_PAGE
def test_every_function_exists(page):
    for row in rows_with(page, "function"):
        assert CODE.search(row["function"]), row
        assert unknown_functions(row["function"], page) == [], row


@EACH_PAGE
def test_every_test_exists_in_the_file_named_for_it(page):
    for row in rows_with(page, "test"):
        assert any(TEST.match(code) for code in CODE.findall(row["test"])), row
        files = re.findall(r"[\w/]+\.py", row["test"])
        for code in CODE.findall(" ".join(row.values())):
            if match := TEST.match(code):
                places = known_tests().get(match["name"], [])
                assert places, f"{match['name']}: no such test"
                near = [match["file"]] if match["file"] else files
                assert not near or any(place.endswith(file) for place in places for file in near), (code, near)


@EACH_PAGE
def test_every_table_names_its_tests(page):
    for table in tables(page.read_text()):
        assert "test" in table[0] or page == INDEX, table[0]


def test_the_index_links_every_page_and_nothing_else():
    linked = re.findall(r"\]\((\w+\.md)\)", INDEX.read_text())
    assert sorted(linked) == [page.name for page in PAGES]


def test_every_erratum_stands_on_its_mechanisms_page_with_the_same_test():
    errata = rows_with(INDEX, "printed")
    page_of = {
        name: re.findall(r"\((\w+\.md)\)", row["rows"])[0]
        for row in rows_with(INDEX, "rows")
        for name in CODE.findall(row["mechanism"])
    }
    assert {row["source"] for row in errata} == set(page_of) & {"Heli4", "Redundant3T1R", "Peppermill", "GoughStewart"}
    for row in errata:
        text = (FOLDER / page_of[row["source"]]).read_text()
        assert [name for name in CODE.findall(row["test"]) if name not in text] == []


@pytest.mark.parametrize(
    ("page", "equation", "last"),
    [
        ("heli4.md", r"\((\d+)\)", 59),
        ("redundant_3t1r.md", r"\((\d+)\)", 40),
        ("peppermill.md", r"\((\d+)\)", 48),
        ("peppermill.md", r"\(A\.(\d)\)", 5),
        ("gough_stewart.md", r"\[8\.(\d+)\]", 26),
    ],
)
def test_no_equation_is_left_out(page, equation, last):
    covered = set()
    for row in rows_with(FOLDER / page, "equation"):
        for first, other in re.findall(rf"{equation}(?:[-\u2013]{equation})?", row["equation"]):
            covered |= set(range(int(first), int(other or first) + 1))
    assert covered == set(range(1, last + 1))


@pytest.mark.parametrize(
    ("cell", "unknown"),
    [
        ("`Heli4.inverse`, `.forward`", []),
        ("`inverse`, margin `det_J_x`", []),
        ("`heli4.forward.plates`, `Plates.positions`", []),
        ("`Heli4.Geometry.pitch`, `block_triangular(...).j_int`", []),
        ('`mobility.architectures.ARCHITECTURES["Delta R-(RR)-(RR)"]`', []),
        ("`block_triangular(...).j_out`", ["block_triangular(...).j_out"]),
        ("`Heli4.invers`, `.forwards`", ["Heli4.invers", "Heli4.forwards"]),
        ("`det_J_x`", ["det_J_x"]),
        ("`q' = J_m t`", ["q' = J_m t"]),
    ],
)
def test_a_name_that_does_not_exist_is_seen(cell, unknown):
    assert unknown_functions(cell, FOLDER / "heli4.md") == unknown


def test_a_row_with_a_cell_too_few_is_seen():
    with pytest.raises(AssertionError):
        tables("| a | b |\n| --- | --- |\n| 1 |")
