"""Read a TOML file and find the line of each key.

`tomllib` decides what is valid, but it keeps no positions. A second, simple pass over the valid text finds the lines.
A key that this pass misses gets the line of its table.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from studies.errors import Fault, KeyPath, StudyError, dotted

_TOKEN = re.compile(
    r"""
      (?P<text>\"{3}(?:\\[\s\S]|[^\\])*?\"{3,5} | '{3}[\s\S]*?'{3,5} | "(?:\\.|[^"\\\n])*" | '[^'\n]*')
    | (?P<comment>\#[^\n]*)
    | (?P<newline>\n)
    | (?P<mark>[\[\]{}=,.])
    | (?P<bare>[^\s\[\]{}=,.\#"']+)
    """,
    re.VERBOSE,
)


@dataclass(frozen=True)
class TomlFile:
    """A parsed TOML file: its data and the line of each key."""

    path: Path
    data: dict[str, Any]
    lines: Mapping[KeyPath, int]

    def value(self, path: KeyPath) -> object:
        """The value at `path`; raises LookupError if there is none."""
        node: object = self.data
        for part in path:
            match part, node:
                case str(), dict():
                    node = node[part]
                case int(), list():
                    node = node[part]
                case _:
                    raise LookupError(dotted(path))
        return node

    def line(self, path: KeyPath) -> int:
        """The line (from 1) of `path`, or of the nearest table around it that is in the file."""
        known = (self.lines[path[:n]] for n in range(len(path), 0, -1) if path[:n] in self.lines)
        return next(known, 1)

    def fault(self, path: KeyPath, found: str, expected: str) -> Fault:
        """A `Fault` at `path`."""
        return Fault(self.path, dotted(path), self.line(path), found, expected)


def read_toml(path: Path) -> TomlFile:
    """Read and parse `path`.

    Raises StudyError if the file cannot be read, is not UTF-8, or is not TOML.
    """
    text = _read_text(path)
    try:
        data = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # a 5000-digit integer raises another ValueError
        raise StudyError([_syntax_fault(path, text, error)]) from None
    return TomlFile(path, data, key_lines(text))


def _read_text(path: Path) -> str:
    try:
        if path.exists() and not path.is_file() and not path.is_dir():
            raise OSError(0, "a device or a pipe, not a file")  # reading it might never end
        raw = path.read_bytes()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise StudyError([Fault(path, "", None, reason.lower(), "a readable TOML file")]) from None
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise StudyError([Fault(path, "", line, f"byte 0x{raw[error.start]:02x}", "UTF-8 text")]) from None


def _syntax_fault(path: Path, text: str, error: Exception) -> Fault:
    if isinstance(error, RecursionError):
        return Fault(path, "", None, "values nested too deeply", "valid TOML")
    reason, _, place = str(error).partition(" (at ")
    line = re.match(r"line (\d+)", place)
    last = text.rstrip().count("\n") + 1
    at = int(line[1]) if line else last if place else None
    return Fault(path, "", at, f"a syntax error ({reason.lower()})", "valid TOML")


def key_lines(text: str) -> dict[KeyPath, int]:
    """The line (from 1) of each table, key and array entry of a valid TOML text."""
    scan = _Scan()
    for kind, token, line in _tokens(text + "\n"):
        if kind == "newline":
            scan.end_line()
        elif kind != "comment":
            scan.take(kind, token, line)
    return scan.lines


def _tokens(text: str) -> Iterator[tuple[str, str, int]]:
    line, counted = 1, 0
    for match in _TOKEN.finditer(text):
        line += text.count("\n", counted, match.start())
        counted = match.start()
        yield match.lastgroup or "", match[0], line


@dataclass
class _Open:
    """An array or inline table that is not closed yet."""

    path: KeyPath
    is_array: bool
    index: int = 0

    @property
    def entry(self) -> KeyPath:
        return (*self.path, self.index) if self.is_array else self.path


@dataclass
class _Scan:
    """Follows the tokens of a valid text; `lines` is the result."""

    lines: dict[KeyPath, int] = field(default_factory=dict)
    table: KeyPath = ()
    rows: dict[KeyPath, int] = field(default_factory=dict)  # entries of each array of tables so far
    open: list[_Open] = field(default_factory=list)
    key: list[str] = field(default_factory=list)
    value_path: KeyPath | None = None  # None while a key is being read
    header: int = 0  # the number of brackets that opened the header

    def take(self, kind: str, token: str, line: int) -> None:
        mark = token if kind == "mark" else ""
        if self.value_path is not None:
            self._take_value(mark, line)
        elif mark == "=":
            self.value_path = self._place(self._base(), line)
        elif mark == "[" and not self.key:
            self.header += 1
        elif mark == "]":
            self._close_header(line)
        elif mark == "}":
            self._close()
        elif not mark:
            self.key.append(_unquoted(kind, token))

    def end_line(self) -> None:
        if not self.open:
            self.key, self.value_path, self.header = [], None, 0

    def _base(self) -> KeyPath:
        return self.open[-1].entry if self.open else self.table

    def _place(self, path: KeyPath, line: int) -> KeyPath:
        """Record the dotted key that was read, under `path`; returns the whole path."""
        for part in self.key:
            path = (*path, part)
            self.lines.setdefault(path, line)
            if path in self.rows:
                path = (*path, self.rows[path] - 1)
        self.key = []
        return path

    def _close_header(self, line: int) -> None:
        if not self.key:  # the second bracket of ]]
            return
        *parents, last = self.key
        self.key = parents
        self.table = (*self._place((), line), last)
        self.lines.setdefault(self.table, line)
        if self.header == 2:
            self.rows[self.table] = self.rows.get(self.table, 0) + 1
        if self.table in self.rows:
            self.table = (*self.table, self.rows[self.table] - 1)
            self.lines.setdefault(self.table, line)

    def _take_value(self, mark: str, line: int) -> None:
        inside = self.open[-1] if self.open else None
        if mark == "," and inside:
            inside.index += 1
            self.value_path = inside.entry if inside.is_array else None
        elif mark in {"]", "}"} and inside:
            self._close()
        elif self.value_path is not None:
            self.lines.setdefault(self.value_path, line)
            if mark == "[":
                self.open.append(_Open(self.value_path, is_array=True))
                self.value_path = self.open[-1].entry
            elif mark == "{":
                self.open.append(_Open(self.value_path, is_array=False))
                self.value_path = None

    def _close(self) -> None:
        if self.open:
            self.value_path = self.open.pop().path


def _unquoted(kind: str, token: str) -> str:
    """The key that a token spells. A quoted key with a bad escape is kept as it is, as the file is not valid TOML."""
    if kind != "text":
        return token
    try:
        return str(tomllib.loads(f"key = {token}")["key"])
    except ValueError:
        return token
