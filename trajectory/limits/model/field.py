"""The fields of `Limits`, each with its unit, its words and its allowed values."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from kinematics import InvalidField

SPEED_UNIT = "rad/s or m/s"


@dataclass(frozen=True)
class LimitField(ABC):
    """One field.

    Attributes:
        name: the name in the record, and the key in a study.
        words: a description for people.
        expected: the allowed values, in words.
        unit: SI unit, for joints that turn and joints that slide.
        required: whether it must be set.
    """

    name: str
    words: str
    expected: str
    unit: str = ""
    required: bool = False

    def unit_for(self, joint_units: Sequence[str]) -> str:
        """The unit, of joints that all turn or all slide; else both units."""
        turning, _, sliding = self.unit.partition(" or ")
        kinds = set(joint_units)
        return {frozenset({"rad"}): turning, frozenset({"m"}): sliding or turning}.get(frozenset(kinds), self.unit)

    @abstractmethod
    def checked(self, value: Any) -> Any:
        """The value as the record keeps it.

        Raises:
            InvalidValue: the value is not as `expected`.
        """


class JointField(LimitField):
    """A number > 0 for all joints, or one a joint."""

    def checked(self, value: Any) -> float | tuple[float, ...]:
        """A float, or a tuple of floats."""
        numbers = _positive(self.name, value)
        return numbers[0] if isinstance(value, int | float) else numbers


class ToolField(LimitField):
    """One number > 0."""

    def checked(self, value: Any) -> float:
        """A float."""
        numbers = _positive(self.name, value)
        if not isinstance(value, int | float):
            raise InvalidField("Limits", self.name, value, "one number")
        return numbers[0]


class RangeField(LimitField):
    """low < high for all joints, or one such pair a joint."""

    def checked(self, value: Any) -> Any:
        """(low, high), or a tuple of such pairs."""
        try:
            pairs = np.array(value, dtype=float)
            if pairs.ndim not in (1, 2) or pairs.shape[-1] != 2 or not pairs.size:
                raise ValueError
        except (ValueError, TypeError):
            raise InvalidField("Limits", self.name, value, "low < high, or one such pair a joint") from None
        if not (np.isfinite(pairs).all() and (pairs[..., 0] < pairs[..., 1]).all()):
            raise InvalidField("Limits", self.name, value, "finite numbers, low < high")
        return tuple(tuple(row) for row in pairs.tolist()) if pairs.ndim == 2 else tuple(pairs.tolist())


def _positive(name: str, value: Any) -> tuple[float, ...]:
    items = np.atleast_1d(np.asarray(value, dtype=object)).tolist()
    numbers = [v for v in items if isinstance(v, int | float | np.integer | np.floating) and not isinstance(v, bool)]
    if not items or len(numbers) < len(items) or not all(np.isfinite(v) and v > 0 for v in numbers):
        raise InvalidField("Limits", name, value, "a finite number > 0")
    return tuple(float(v) for v in numbers)
