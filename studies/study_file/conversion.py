"""The keys of a file against those that are known: values in SI, and a finding for each key that is not right."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from studies.errors import KeyPath
from studies.study_file.keys import Key, Table
from studies.study_file.units import Dimension, unit_ending, value_in_si
from studies.study_file.unknown_keys import known_keys, spellings

SMALLEST, LARGEST = 1e-15, 1e15  # in SI: no real length, time, mass or limit of a machine is outside these


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
    reported: set[KeyPath] = field(default_factory=set)  # SI paths that are missing because of a finding

    def to_si(self, data: Mapping[str, Any], table: Table, path: KeyPath = ()) -> dict[str, Any]:
        """`data` in SI, with names without suffixes and tuples for arrays. Each wrong key becomes a finding."""
        converted: dict[str, Any] = {}
        for spelling, value in data.items():
            name, suffix = self._split(spelling, table, path)
            if name is None:
                continue
            if name in converted:
                self._report(path, spelling, f"{name} given twice", "only one spelling of it", [name])
                continue
            self.spelling[(*path, name)] = (*path, spelling)
            converted[name] = self._value(value, table.keys[name], suffix, (*path, name))
        return converted

    def _value(self, value: Any, node: Key | Table, suffix: str, path: KeyPath) -> Any:
        if isinstance(node, Key):
            converted = value_in_si(value, suffix)
            least = 0.0 if node.place or node.dimension in (Dimension.ANGLE, Dimension.FRAME) else SMALLEST
            odd = [number for number in _numbers(converted) if number and not least <= abs(number) <= LARGEST]
            if odd:
                sizes = f"from {SMALLEST:g} to {LARGEST:g}" if least else f"up to {LARGEST:g}"
                found, expected = f"{odd[0]:g} in SI", f"0, or a number whose size is {sizes}"
                self.findings.append(Finding(self.spelling[path], found, expected))
            return converted
        if isinstance(value, list):
            return tuple(self._value(row, node, "", (*path, i)) for i, row in enumerate(value))
        return self.to_si(value, node, path) if isinstance(value, dict) else value

    def _split(self, spelling: str, table: Table, path: KeyPath) -> tuple[str | None, str]:
        """The key's name and its suffix; the name is None if the key became a finding."""
        if spelling in table.keys:
            return spelling, ""
        name, suffix = unit_ending(spelling, table.keys)
        node = table.keys.get(name)
        if not isinstance(node, Key):
            expected, meant = known_keys(spelling, table)
            self._report(path, spelling, "an unknown key", expected, meant)
        elif suffix == node.suffix:
            return name, suffix
        else:
            self._report(path, spelling, f'unit suffix "_{suffix}"', spellings(name, node), [name])
        return None, ""

    def _report(self, path: KeyPath, spelling: str, found: str, expected: str, names: list[str]) -> None:
        self.findings.append(Finding((*path, spelling), found, expected))
        self.reported.update((*path, name) for name in names)


def _numbers(value: Any) -> Iterator[float]:
    """The finite numbers of a value."""
    if isinstance(value, tuple):
        for entry in value:
            yield from _numbers(entry)
    elif isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        yield value
