"""The number that is mapped: a margin of a robot, with the data that it is measured with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kinematics import Array, FviBounds, Mechanism, Value


@dataclass(frozen=True, eq=False)
class Index(Value):
    """A number at each pose.

    Attributes:
        name: the margin's name.
        unit: the unit of its numbers; empty if there is none.
        words: a description for people.
        value: (..., n) poses -> (...,), NaN out of reach.
        sense: 1 if a larger number is better, -1 if a smaller one is.
        least: a lower bound of the value at every pose in reach; -inf if only NaN marks poses out of reach.
    """

    name: str
    value: Callable[[Array], Array]
    unit: str = ""
    words: str = ""
    sense: int = 1
    least: float = -np.inf

    def goodness(self, poses: Array) -> Array:
        """(...,) the value, negative if smaller is better; -inf out of reach."""
        values = self.sense * self.value(poses)
        return np.where(np.isnan(values), -np.inf, values)


def index_of(
    robot: Mechanism, name: str, bounds: FviBounds | None = None, characteristic_length: float | None = None
) -> Index:
    """Make a margin into an index.

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
        margin.sense,
        0.0 if margin.beyond_reach else -np.inf,
    )
