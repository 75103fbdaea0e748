"""The kinds of a geometry's fields: a length, an angle, a screw's pitch, a ratio, a frame; and what each may hold."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

Vector = np.ndarray
Points = tuple[tuple[float, ...], ...]  # rows of numbers
TURN = 2.0 * math.pi


@dataclass(frozen=True)
class FieldKind:
    """What a field measures and which numbers it may hold.

    Attributes:
        dimension: length, angle, length_per_turn, none or frame.
        above: every number is larger than this [SI]; None allows any sign.
        zero: whether a number may be zero.
        expected: which numbers are right, in the words of an error.
    """

    dimension: str
    expected: str = "finite numbers"
    above: float | None = None
    zero: bool = True

    def allows(self, low: Any, high: Any) -> bool:
        """Whether the field may hold every number from `low` to `high`, each a number or an array of them [SI]."""
        low, high = np.asarray(low), np.asarray(high)
        without_zero = self.zero or not np.any((low <= 0.0) & (high >= 0.0))
        return bool(without_zero and (self.above is None or np.all(low > self.above)))

    @property
    def condition(self) -> str:
        """What `allows` asks of a number, as the end of a sentence; "" where it allows every number."""
        return self._above or ("" if self.zero else " other than 0")

    @property
    def condition_on_pairs(self) -> str:
        """What `allows` asks of the interval from low to high, as the end of a sentence."""
        return self._above or ("" if self.zero else ", with no 0 from low to high")

    @property
    def _above(self) -> str:
        unit = " m" if self.above and self.dimension == "length" else ""
        return "" if self.above is None else f", above {self.above:g}{unit}"


def length(default: float | tuple[float, ...] | Points, *, minimum: float | None = 0.0, doc: str) -> Any:
    """A length in metres, greater than `minimum` (None: any sign)."""
    expected = "finite numbers" if minimum is None else f"a length > {minimum:g} m"
    return _field(default, FieldKind("length", expected, minimum), doc)


def angle(default: float | tuple[float, ...], *, doc: str) -> Any:
    """An angle in radians."""
    return _field(default, FieldKind("angle"), doc)


def screw_pitch(default: float | tuple[float, ...], *, doc: str) -> Any:
    """A screw's pitch (its lead) in metres per turn, of either hand; never zero."""
    return _field(default, FieldKind("length_per_turn", "a pitch other than 0 m/turn", zero=False), doc)


def ratio(default: float, *, doc: str) -> Any:
    """A number > 0 without unit."""
    return _field(default, FieldKind("none", "a number > 0", 0.0), doc)


def frame(*, doc: str) -> Any:
    """A homogeneous transform (4, 4), rotation without unit and translation in metres; the identity by default."""
    identity = tuple(tuple(float(i == j) for j in range(4)) for i in range(4))
    return _field(identity, FieldKind("frame"), doc)


def _field(default: Any, kind: FieldKind, doc: str) -> Any:
    return field(default=default, metadata={"kind": kind, "doc": doc})
