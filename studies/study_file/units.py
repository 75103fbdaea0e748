"""Unit suffixes: a key may end in `_mm`, `_deg` or `_rpm`; all that follows is in SI and radians."""

import difflib
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any

from studies.errors import KeyPath
from trajectory import in_si


class Dimension(StrEnum):
    """What a key measures; the first five are also said by a mechanism's geometry."""

    NONE = "none"
    FRAME = "frame"
    LENGTH = "length"
    ANGLE = "angle"
    LENGTH_PER_TURN = "length_per_turn"
    JOINT_SPEED = "joint_speed"


_SI_UNIT = {
    Dimension.LENGTH: "m",
    Dimension.ANGLE: "rad",
    Dimension.LENGTH_PER_TURN: "m per turn",
    Dimension.JOINT_SPEED: "rad/s, or m/s on a rail",
}
_SUFFIX = {
    Dimension.LENGTH: "mm",
    Dimension.ANGLE: "deg",
    Dimension.LENGTH_PER_TURN: "mm",
    Dimension.JOINT_SPEED: "rpm",
}
_UNIT_WORD = re.compile(
    "deg(rees?)?|rad(s|ians?)?|grad|turns?|rev|rp[ms]|hz|[cdkmnu]?m|micron|in(ch(es)?)?|ft|feet|mil"
    "|[mu]?s|sec|min|h|[km]?n|nmm|k?g|lbs?|per"
)


SMALLEST, LARGEST = 1e-15, 1e15  # in SI: beyond these no length, time, mass or limit of a machine is meant


@dataclass(frozen=True)
class Key:
    """What a key may hold: `expected` in words, and the dimension that decides its suffix.

    Where `choices` are given, the words name them. A `place` may be at 0, and so anywhere close to it: what rounding
    leaves of a 0 is not too small a number there. Nor is it of angles and frames.
    """

    expected: str
    dimension: Dimension = Dimension.NONE
    choices: tuple[str, ...] = ()
    place: bool = False

    @property
    def unit(self) -> str:
        """In SI; "" where the words say it, or there is none."""
        return _SI_UNIT.get(self.dimension, "")

    @property
    def suffix(self) -> str:
        """What a spelling in the other unit ends in; "" where there is none."""
        return _SUFFIX.get(self.dimension, "")

    def describe(self, suffix: str = "", found: object = None) -> str:
        """The words of an error, in the unit of a key spelled with `suffix`."""
        unit = suffix or self.unit
        words = f"{self.expected} ({unit})" if unit else self.expected
        if not self.choices:
            return words
        wrong = [f for f in (found if isinstance(found, list) else [found]) if f not in self.choices]
        return f"{words} {', '.join(self.choices)}{_hint(closest(wrong, self.choices))}"


@dataclass(frozen=True)
class Table:
    """The keys of a table; with `rows`, of each table of an array; `other` is one that stands in its place."""

    keys: "Mapping[str, Key | Table]"
    rows: bool = False
    other: str = ""

    def updated(self, keys: "Mapping[str, Key | Table]") -> "Table":
        """This table with `keys` added or replaced."""
        return replace(self, keys={**self.keys, **keys})

    def describe(self, found: object = None) -> str:
        """The words of an error where there is no such table, or where it must not be."""
        if self.other and isinstance(found, dict):
            return f"no such table beside {self.other}: only one of the two"
        keys = f"one or more of {', '.join(self.keys)}"
        instead = f", or {self.other} in its place" if self.other else ""
        return f"an array of tables, each with {keys}" if self.rows else f"a table with {keys}{instead}"


@dataclass(frozen=True)
class Finding:
    """A fault of a key: `path` as the file spells it."""

    path: KeyPath
    found: str
    expected: str


@dataclass
class Conversion:
    """Converts a file's data to SI, and remembers how the file spelled each key."""

    findings: list[Finding] = field(default_factory=list)
    spelling: dict[KeyPath, KeyPath] = field(default_factory=dict)
    reported: set[KeyPath] = field(default_factory=set)  # SI paths whose absence a finding explains

    def to_si(self, data: Mapping[str, Any], table: Table, path: KeyPath = ()) -> dict[str, Any]:
        """`data` with SI values, no suffixes and tuples for arrays; faulty keys become findings."""
        converted: dict[str, Any] = {}
        for spelling, value in data.items():
            name, suffix = self._split(spelling, table, path)
            if name is None:
                continue
            if name in converted:
                self._report(path, spelling, f"{name} given twice", "one spelling of it", [name])
                continue
            self.spelling[(*path, name)] = (*path, spelling)
            converted[name] = self._value(value, table.keys[name], suffix, (*path, name))
        return converted

    def _value(self, value: Any, node: Key | Table, suffix: str, path: KeyPath) -> Any:
        if isinstance(node, Key):
            converted = _in_si(value, suffix)
            least = 0.0 if node.place or node.dimension in (Dimension.ANGLE, Dimension.FRAME) else SMALLEST
            odd = [number for number in _numbers(converted) if number and not least <= abs(number) <= LARGEST]
            if odd:
                sizes = f"from {SMALLEST:g} to {LARGEST:g}" if least else f"of at most {LARGEST:g}"
                found, expected = f"{odd[0]:g} in SI", f"0, or a number of a size {sizes}"
                self.findings.append(Finding(self.spelling[path], found, expected))
            return converted
        if isinstance(value, list):
            return tuple(self._value(row, node, "", (*path, i)) for i, row in enumerate(value))
        return self.to_si(value, node, path) if isinstance(value, dict) else value

    def _split(self, spelling: str, table: Table, path: KeyPath) -> tuple[str | None, str]:
        """The key's name and its suffix; the name is None for a key that became a finding."""
        if spelling in table.keys:
            return spelling, ""
        name, suffix = _unit_ending(spelling, table.keys)
        node = table.keys.get(name)
        if isinstance(node, Key):
            if suffix == node.suffix:
                return name, suffix
            self._report(path, spelling, f'unit suffix "_{suffix}"', _spellings(name, node), [name])
        else:
            near = closest([spelling], _all_spellings(table))
            known = f"one of {', '.join(sorted(table.keys))}{_hint(near)}"
            meant = near if near is None or near in table.keys else near.rsplit("_", 1)[0]
            self._report(path, spelling, "an unknown key", known, [meant] if meant else [])
        return None, ""

    def _report(self, path: KeyPath, spelling: str, found: str, expected: str, names: list[str]) -> None:
        self.findings.append(Finding((*path, spelling), found, expected))
        self.reported.update((*path, name) for name in names)


def closest(wrong: Iterable[object], choices: Iterable[str]) -> str | None:
    """The choice that the first misspelt word most likely means; capitals do not count."""
    word = next((w for w in wrong if isinstance(w, str)), "")
    # A word much longer than any name is no slip of the pen, and costly to compare.
    lowered = {choice.lower(): choice for choice in choices}
    near = difflib.get_close_matches(word[:64].lower(), list(lowered), n=1)
    return lowered[near[0]] if near else None


def _hint(near: str | None) -> str:
    return f" (did you mean {near}?)" if near else ""


def _unit_ending(spelling: str, names: Iterable[str]) -> tuple[str, str]:
    """The longest of `names` that `spelling` adds units to, and these; ("", "") if none."""
    for name in sorted(names, key=len, reverse=True):
        ending = spelling.removeprefix(f"{name}_")
        if ending != spelling and all(map(_UNIT_WORD.fullmatch, ending.lower().split("_"))):
            return name, ending
    return "", ""


def _spellings(name: str, key: Key) -> str:
    return f"{name} ({key.unit}) or {name}_{key.suffix}" if key.suffix else f"{name}, which takes no suffix"


def _all_spellings(table: Table) -> list[str]:
    suffixed = [f"{name}_{key.suffix}" for name, key in table.keys.items() if isinstance(key, Key) and key.suffix]
    return [*table.keys, *suffixed]


def _numbers(value: Any) -> Iterator[float]:
    """The finite numbers of a value."""
    if isinstance(value, tuple):
        for entry in value:
            yield from _numbers(entry)
    elif isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        yield value


def _in_si(value: Any, suffix: str) -> Any:
    if isinstance(value, list):
        return tuple(_in_si(entry, suffix) for entry in value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    try:
        number = float(value)
    except OverflowError:
        number = math.inf if value > 0 else -math.inf
    if suffix:
        return in_si(number, suffix)
    return value if math.isfinite(number) else number
