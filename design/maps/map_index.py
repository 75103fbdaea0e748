"""What is mapped: a margin of a robot, measured in one way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kinematics import Array, FviBounds, Mechanism, Value


@dataclass(frozen=True, eq=False)
class Index(Value):
    """A number at each pose, the larger the better.

    Attributes:
        name: of the margin.
        unit: of its numbers; empty where it has none.
        words: what it is, for people.
        value: (..., n) poses -> (...,), NaN out of reach.
        least: a value that every pose within reach keeps; -inf where NaN alone tells which these are.
    """

    name: str
    value: Callable[[Array], Array]
    unit: str = ""
    words: str = ""
    least: float = -np.inf

    def goodness(self, poses: Array) -> Array:
        """(...,) the value; -inf out of reach."""
        values = self.value(poses)
        return np.where(np.isnan(values), -np.inf, values)


def index_of(
    robot: Mechanism, name: str, bounds: FviBounds | None = None, characteristic_length: float | None = None
) -> Index:
    """A margin as an index.

    Args:
        name: one of `robot.margins`.
        bounds, characteristic_length: as in `Mechanism.margin`.

    Raises:
        InvalidValue: the mechanism has no such margin.
    """
    margin = robot.margin_named(name)
    return Index(
        name,
        lambda poses: robot.margin(name, poses, bounds, characteristic_length),
        margin.unit,
        margin.words,
        0.0 if margin.beyond_reach else -np.inf,
    )
