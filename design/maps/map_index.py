"""The indices that can be mapped: every margin of the mechanism, and v_w, f_w and the condition number beside them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kinematics import Array, FviBounds, InvalidValue, Mechanism

BESIDE_MARGINS = ("v_w", "f_w", "condition_number")


@dataclass(frozen=True)
class Index:
    """A number at each pose.

    Attributes:
        name: as in `index_names`.
        value: (..., n) poses -> (...,), NaN out of reach.
        smaller_is_better: only of the condition number; its worst is the largest.
        least: a value that every pose within reach keeps; -inf where NaN alone tells which these are.
    """

    name: str
    value: Callable[[Array], Array]
    smaller_is_better: bool = False
    least: float = -np.inf

    @property
    def sign(self) -> float:
        """Times the value, the larger the better."""
        return -1.0 if self.smaller_is_better else 1.0

    def goodness(self, poses: Array) -> Array:
        """(...,) the value with its sign, so that the worst is the lowest; -inf out of reach."""
        values = self.sign * self.value(poses)
        return np.where(np.isnan(values), -np.inf, values)


def index_names(robot: Mechanism | type[Mechanism]) -> tuple[str, ...]:
    """What `index_of` knows for a mechanism."""
    return (*robot.margins, *BESIDE_MARGINS)


def index_of(
    robot: Mechanism, name: str, bounds: FviBounds | None = None, characteristic_length: float | None = None
) -> Index:
    """An index by its name.

    Args:
        bounds, characteristic_length: as in `Mechanism.margin`.

    Raises:
        InvalidValue: the mechanism has no such index.
    """
    length = characteristic_length
    if name in robot.margins:
        least = 0.0 if name == "reach" else -np.inf
        return Index(name, lambda poses: robot.margin(name, poses, bounds, length), least=least)
    if name in ("v_w", "f_w"):
        which = 0 if name == "v_w" else 1
        return Index(name, lambda poses: robot.isotropic(poses, length)[which])
    if name == "condition_number":
        return Index(name, lambda poses: robot.condition_number(poses, length), smaller_is_better=True)
    raise InvalidValue(f"{type(robot).__name__} index", name, f"one of {', '.join(index_names(robot))}")
