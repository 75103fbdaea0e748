"""The statement that is proved or refuted: a margin of a robot keeps a bound."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinematics import Array, Bound, ClaimSymbols, FviBounds, InvalidValue, Mechanism, finite, positive


@dataclass(frozen=True)
class Statement:
    """The statement that `margin` of `robot` keeps `bound`.

    Attributes:
        robot: the mechanism with its geometry and ranges.
        margin: one of `robot.margins`.
        bound: in the margin's unit.
        bounds, length: what the FVI is measured with; the characteristic length in metres.

    Raises:
        InvalidValue: the margin is unknown, the bound is not finite, of the wrong sense or (for `reach`) below 0, or
            the length is not above 0.
    """

    robot: Mechanism
    margin: str
    bound: Bound
    bounds: FviBounds
    length: float

    def __post_init__(self) -> None:
        self.robot.margin_named(self.margin).bound(**{self.bound.word: self.bound.value})
        finite(f"{self.bound.word} of {self.margin}", self.bound.value, "a finite number, in the margin's unit")
        if self.margin == "reach" and self.bound.value < 0.0:
            raise InvalidValue(
                "at_least of reach", self.bound.value, "0 m or more, as every claim includes that the pose is in reach"
            )
        positive("characteristic_length", self.length, "a finite length > 0 m")

    @classmethod
    def of(
        cls,
        robot: Mechanism,
        margin: str,
        bound: Bound,
        bounds: FviBounds | None = None,
        characteristic_length: float | None = None,
    ) -> Statement:
        """The statement; if no FVI bounds or length are given, the robot's own are used."""
        length = robot.characteristic_length if characteristic_length is None else characteristic_length
        return cls(robot, margin, bound, bounds or robot.fvi_bounds, length)

    @property
    def numbers(self) -> list[float]:
        """The values of `ClaimSymbols`."""
        return ClaimSymbols.values(self.bound.value, self.bounds, self.length)

    def value(self, poses: Array) -> Array:
        """(..., n) -> (...,) the margin in plain arithmetic; NaN where a limb cannot reach, even for `reach` itself."""
        values = self.robot.margin(self.margin, poses, self.bounds, self.length)
        return np.where(self.robot.margin("reach", poses) >= 0.0, values, np.nan)
