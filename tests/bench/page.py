"""Tables that stand in a Markdown page between two markers."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).parents[2]


def write_between(page: Path, name: str, table: str, by: str = "make bench") -> None:
    """Put a table, which ends in a new line, into a page of the repository where its markers are."""
    start, end = f"<!-- {name}: written by `{by}` -->", f"<!-- /{name} -->"
    before, rest = page.read_text().split(start)
    page.write_text(f"{before}{start}\n{table}{end}{rest.split(end)[1]}")
    print(table)
