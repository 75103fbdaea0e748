"""Bounds of a margin's number: at least a value where larger is better, at most a value where smaller is better."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from kinematics.printed_bounds import rounded_down, rounded_up

_BEYOND = 1e9  # m, rad or kg: no machine is so far off, or so heavy


@dataclass(frozen=True)
class Bound:
    """The value that a margin must reach.

    Attributes:
        value: in the margin's unit.
        sense: 1 if the margin must be at least the value, -1 if it must be at most the value.
    """

    value: float
    sense: int = 1

    @classmethod
    def weakest(cls, sense: int) -> Bound:
        """The bound that says least: a margin is not negative, or is finite."""
        return cls(0.0 if sense > 0 else _BEYOND, sense)

    @property
    def word(self) -> str:
        """`at_least` or `at_most`, as in a study."""
        return "at_least" if self.sense > 0 else "at_most"

    def room(self, values: Any) -> Any:
        """By how much numbers, arrays or expressions keep the bound; negative where they do not, NaN for NaN."""
        return self.sense * (values - self.value)

    def eased(self, by: float) -> Bound:
        """The bound that is weaker by so much."""
        return Bound(self.value - self.sense * by, self.sense)

    def shown(self, digits: int) -> str:
        """The bound as text with so many digits; never stronger than it is."""
        return f"{self.sign} {(rounded_down if self.sense > 0 else rounded_up)(self.value, digits)}"

    @property
    def sign(self) -> str:
        """`>=` or `<=`."""
        return ">=" if self.sense > 0 else "<="

    def __str__(self) -> str:
        return f"{self.sign} {self.value:g}"
