"""What the command line prints: tables for people on a terminal or in a pipe, one JSON object for machines."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Column, Table
from rich.text import Text

from studies.results import Written
from studies.stages import Lasting


@contextmanager
def progress() -> Iterator[Callable[[str], None]]:
    """Show progress on standard error: on a terminal a spinner with the current step, in a pipe the `Lasting` lines.

    On a terminal each step leaves a line. Of steps with the same text before the colon, only the first leaves one.
    """
    console = Console(stderr=True, log_path=False)
    if not console.is_terminal:
        yield lambda step: print(step, file=sys.stderr, flush=True) if isinstance(step, Lasting) else None
        return
    with console.status("starting") as status:
        last, shown = "", set[str]()

        def tell(step: str) -> None:
            nonlocal last
            if isinstance(step, Lasting) and step in shown:
                return
            status.update(escape(step))
            if (head := step.partition(":")[0]) != last:
                console.log(escape(step), highlight=False)
                shown.add(step)
            last = head

        yield tell


def print_json(data: dict[str, Any]) -> None:
    """Print one object on standard output. A number that is not finite becomes null: JSON has no other way."""
    sys.stdout.write(json.dumps(_plain(data), indent=2) + "\n")


def print_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table on standard output. In a pipe it is as wide as its contents."""
    console = Console()
    table = Table(
        *(Column(Text(c)) for c in columns),
        title=Text(title),
        title_justify="left",
        box=None,
        pad_edge=False,
        highlight=False,
    )
    for row in rows:
        table.add_row(*(Text(str(cell)) for cell in row))
    width = None if console.is_terminal else max(console.width, 240)
    Console(width=width).print(table, soft_wrap=not console.is_terminal)
    Console().print()


def print_files(written: Written, as_json: bool = False) -> None:
    """Print which files were written, removed, or kept from an earlier command that answered another question."""
    if as_json:
        print_json(files_data(written))
        return
    for file in written.files:
        print(f"wrote {file}")
    for file in written.removed:
        print(f"removed {file}: it answered another question")
    for file in written.left:
        print(f"kept {file}: an earlier command wrote it for another question")


def files_data(written: Written) -> dict[str, list[Path]]:
    """The same as plain data. Empty lists are left out, except that of the files written."""
    return {name: list(files) for name, files in vars(written).items() if files or name == "files"}


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return str(value) if isinstance(value, Path) else value
