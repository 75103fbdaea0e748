"""What a key or a table of a study file may hold, in words, and which name a misspelt word most likely means."""

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from studies.study_file.units import SI_UNIT, SUFFIX, Dimension


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
        return SI_UNIT.get(self.dimension, "")

    @property
    def suffix(self) -> str:
        """What a spelling in the other unit ends in; "" where there is none."""
        return SUFFIX.get(self.dimension, "")

    def describe(self, suffix: str = "", found: object = None) -> str:
        """The words of an error, in the unit of a key spelled with `suffix`."""
        unit = suffix or self.unit
        words = f"{self.expected} ({unit})" if unit else self.expected
        if not self.choices:
            return words
        wrong = [f for f in (found if isinstance(found, list) else [found]) if f not in self.choices]
        return f"{words} {', '.join(self.choices)}{hint(closest(wrong, self.choices))}"


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


def closest(wrong: Iterable[object], choices: Iterable[str]) -> str | None:
    """The choice that the first misspelt word most likely means; capitals do not count."""
    word = next((w for w in wrong if isinstance(w, str)), "")
    # A word much longer than any name is no slip of the pen, and costly to compare.
    lowered = {choice.lower(): choice for choice in choices}
    near = difflib.get_close_matches(word[:64].lower(), list(lowered), n=1)
    return lowered[near[0]] if near else None


def hint(near: str | None) -> str:
    """The words that an error ends in."""
    return f" (did you mean {near}?)" if near else ""
