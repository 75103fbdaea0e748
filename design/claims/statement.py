"""The statement that is proved or refuted: a margin of a robot is at least a bound."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinematics import Array, ClaimSymbols, FviBounds, InvalidValue, Mechanism, finite, positive


@dataclass(frozen=True)
class Statement:
    """The statement `margin` of `robot` >= `at_least`.

    Attributes:
        robot: the mechanism with its geometry and ranges.
        margin: one of `robot.margins`.
        at_least: the bound, in the margin's unit.
        bounds, length: what the FVI is measured with; the characteristic length in metres.

    Raises:
        InvalidValue: the margin is unknown, the bound is not finite or (for `reach`) below 0, or the length is not
            above 0.
    """

    robot: Mechanism
    margin: str
    at_least: float
    bounds: FviBounds
    length: float

    def __post_init__(self) -> None:
        if self.margin not in self.robot.margins:
            known = ", ".join(self.robot.margins)
            raise InvalidValue(f"{type(self.robot).__name__} margin", self.margin, f"one of {known}")
        finite(f"at_least of {self.margin}", self.at_least, "a finite number, in the margin's unit")
        if self.margin == "reach" and self.at_least < 0.0:
            raise InvalidValue(
                "at_least of reach", self.at_least, "0 m or more, as every claim includes that the pose is in reach"
            )
        positive("characteristic_length", self.length, "a finite length > 0 m")

    @classmethod
    def of(
        cls,
        robot: Mechanism,
        margin: str,
        at_least: float,
        bounds: FviBounds | None = None,
        characteristic_length: float | None = None,
    ) -> Statement:
        """The statement; if no FVI bounds or length are given, the robot's own are used."""
        length = robot.characteristic_length if characteristic_length is None else characteristic_length
        return cls(robot, margin, at_least, bounds or robot.fvi_bounds, length)

    @property
    def numbers(self) -> list[float]:
        """The values of `ClaimSymbols`."""
        return ClaimSymbols.values(self.at_least, self.bounds, self.length)

    def value(self, poses: Array) -> Array:
        """(..., n) -> (...,) the margin in plain arithmetic; NaN where a limb cannot reach, even for `reach` itself."""
        values = self.robot.margin(self.margin, poses, self.bounds, self.length)
        return np.where(self.robot.margin("reach", poses) >= 0.0, values, np.nan)
