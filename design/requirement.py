"""Requirements of a geometry at every pose of the region, and bounds of its variables."""

from __future__ import annotations

from dataclasses import dataclass

from kinematics import Bound, InvalidValue


@dataclass(frozen=True)
class Requirement:
    """A named margin of the mechanism must be at least a bound, or at most one where a smaller number is better.

    Raises:
        InvalidValue: not exactly one bound is given.
    """

    margin: str
    at_least: float | None = None
    at_most: float | None = None

    def __post_init__(self) -> None:
        if (self.at_least is None) == (self.at_most is None):
            found = "no bound" if self.at_least is None else "two bounds"
            raise InvalidValue(f"requirement of {self.margin}", found, "at_least or at_most")

    @property
    def bound(self) -> Bound:
        """The value that the margin must reach."""
        if self.at_least is not None:
            return Bound(self.at_least)
        assert self.at_most is not None
        return Bound(self.at_most, -1)


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
