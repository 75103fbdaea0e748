"""What a key or a table of a study file may hold, in words, and which name a misspelt word most likely means."""

import difflib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from studies.study_file.units import SI_UNIT, SUFFIX, Dimension


@dataclass(frozen=True)
class Key:
    """The values that a key may have: `expected` in words, and the dimension that decides its suffix.

    If there are `choices`, the words name them. A `place`, an angle and a frame may be 0 or any small number, such as
    the rounding error of a 0. Other numbers that small are refused.
    """

    expected: str
    dimension: Dimension = Dimension.NONE
    choices: tuple[str, ...] = ()
    place: bool = False

    @property
    def unit(self) -> str:
        """The SI unit; "" if `expected` names it, or if there is none."""
        return SI_UNIT.get(self.dimension, "")

    @property
    def suffix(self) -> str:
        """The ending of the key in its other unit; "" if there is no other unit."""
        return SUFFIX.get(self.dimension, "")

    def describe(self, suffix: str = "", found: object = None) -> str:
        """The words of an error, in the unit of `suffix`."""
        unit = suffix or self.unit
        words = f"{self.expected} ({unit})" if unit else self.expected
        if not self.choices:
            return words
        wrong = [f for f in (found if isinstance(found, list) else [found]) if f not in self.choices]
        return f"{words} {', '.join(self.choices)}{hint(closest(wrong, self.choices))}"


@dataclass(frozen=True)
class Table:
    """The keys of a table, or with `rows` of each table of an array; `other` is a table that may replace it."""

    keys: "Mapping[str, Key | Table]"
    rows: bool = False
    other: str = ""

    def updated(self, keys: "Mapping[str, Key | Table]") -> "Table":
        """This table with `keys` added or replaced."""
        return replace(self, keys={**self.keys, **keys})

    def describe(self, found: object = None) -> str:
        """The words of an error if the table is missing, or if it is not allowed."""
        if self.other and isinstance(found, dict):
            return f"only one of this table and {self.other}"
        keys = f"one or more of {', '.join(self.keys)}"
        instead = f", or {self.other} instead" if self.other else ""
        return f"an array of tables, each with {keys}" if self.rows else f"a table with {keys}{instead}"


def closest(wrong: Iterable[object], choices: Iterable[str]) -> str | None:
    """The choice that is closest to the first misspelt word; capital letters do not matter."""
    word = next((w for w in wrong if isinstance(w, str)), "")
    # Only the start is compared: a very long word is not a misspelt name, and comparing it takes long.
    lowered = {choice.lower(): choice for choice in choices}
    near = difflib.get_close_matches(word[:64].lower(), list(lowered), n=1)
    return lowered[near[0]] if near else None


def hint(near: str | None) -> str:
    """The words that an error ends in."""
    return f" (did you mean {near}?)" if near else ""
