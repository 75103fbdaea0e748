"""Requirements of a geometry at every pose of the region, and bounds of its variables."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Requirement:
    """A named margin of the mechanism must be at least a bound."""

    margin: str
    at_least: float


@dataclass(frozen=True)
class Bounds:
    """A design variable: one item of a geometry field between two bounds. Equal bounds fix it."""

    field: str
    item: int  # 0 for a plain number
    low: float
    high: float


@dataclass(frozen=True)
class SumLimit:
    """The sum of some geometry fields is at most a bound."""

    fields: tuple[str, ...]
    at_most: float

    def __str__(self) -> str:
        return f"{' + '.join(self.fields)} <= {self.at_most:g}"
