"""What a robot must not touch besides itself: a floor, boxes such as a conveyor or a frame, and what its tool holds."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np

from kinematics.errors import InvalidField
from kinematics.machine.geometry_record import numbers_of
from kinematics.machine.members import Plate, Tube

Place = tuple[float, float, float]
_SIDES = 8  # of the polygon around a flat payload


@dataclass(frozen=True)
class Obstacle:
    """A box along the axes of the base.

    Attributes:
        name: what people call it, such as "conveyor".
        low, high: two opposite corners (x, y, z) [m].
        inside: whether the robot must stay inside, as in a frame; else it must stay outside.

    Raises:
        InvalidValue: it names the field.
    """

    name: str
    low: Place
    high: Place
    inside: bool = False

    def __post_init__(self) -> None:
        what = f"Obstacle {self.name!r}" if self.name else "Obstacle"
        if not self.name:
            raise InvalidField(what, "name", self.name, "a name")
        for name in ("low", "high"):
            numbers = numbers_of(getattr(self, name))
            if numbers is None or numbers.shape != (3,) or not abs(numbers).max() < float("inf"):
                raise InvalidField(what, name, getattr(self, name), "three finite coordinates")
            object.__setattr__(self, name, tuple(numbers.tolist()))
        if not all(low < high for low, high in zip(self.low, self.high, strict=True)):
            raise InvalidField(what, "high", self.high, f"above low, {self.low}, in each coordinate")


@dataclass(frozen=True)
class PayloadHull:
    """What the tool holds: a round body along the axis of the tool, with a round rim.

    A tall one is a capsule. A flat one is a plate: all points within half of its height of a regular octagon around
    its circle.

    Attributes:
        radius: [m].
        low, high: where it starts and ends along the tool's z axis, from the tool point [m].

    Raises:
        InvalidValue: it names the field.
    """

    radius: float
    low: float
    high: float

    def __post_init__(self) -> None:
        for name in ("radius", "low", "high"):
            number = numbers_of(getattr(self, name))
            if number is None or number.ndim or not abs(number) < float("inf"):
                raise InvalidField("PayloadHull", name, getattr(self, name), "a finite number")
            object.__setattr__(self, name, float(number))
        if self.radius <= 0.0:
            raise InvalidField("PayloadHull", "radius", self.radius, "a number > 0")
        if self.high <= self.low:
            raise InvalidField("PayloadHull", "high", self.high, f"above low, {self.low:g} m")

    def shape(self, point: ca.SX, axes: ca.SX) -> Tube | Plate:
        """The hull on a tool whose point (3,) and axes (3, 3) are given."""
        half = (self.high - self.low) / 2
        if half >= self.radius:
            low, high = (point + axes[:, 2] * z for z in (self.low + self.radius, self.high - self.radius))
            return Tube(low, high, ca.SX(self.radius), ca.SX(self.radius))
        angles = (np.arange(_SIDES) + 0.5) * 2 * np.pi / _SIDES
        around = (self.radius - half) / np.cos(np.pi / _SIDES) * np.array([np.cos(angles), np.sin(angles)])
        level = np.full((1, _SIDES), self.low + half)
        return Plate(ca.repmat(point, 1, _SIDES) + axes @ ca.DM(np.vstack([around, level])), ca.SX(2 * half))


@dataclass(frozen=True)
class Surroundings:
    """What the margin `clearance` looks at besides the robot itself.

    Attributes:
        floor: the height that the robot stays above [m]; None for none.
        obstacles: boxes with different names.
        payload_hull: what the tool holds; None for nothing.

    Raises:
        InvalidValue: it names the field.
    """

    floor: float | None = None
    obstacles: tuple[Obstacle, ...] = ()
    payload_hull: PayloadHull | None = None

    def __post_init__(self) -> None:
        if self.floor is not None:
            number = numbers_of(self.floor)
            if number is None or number.ndim or not abs(number) < float("inf"):
                raise InvalidField("Surroundings", "floor", self.floor, "a finite height, or None")
            object.__setattr__(self, "floor", float(number))
        object.__setattr__(self, "obstacles", tuple(self.obstacles))
        if not all(isinstance(obstacle, Obstacle) for obstacle in self.obstacles):
            raise InvalidField("Surroundings", "obstacles", self.obstacles, "Obstacle records")
        names = [obstacle.name for obstacle in self.obstacles]
        if len(set(names)) < len(names):
            raise InvalidField("Surroundings", "obstacles", names, "a different name for each")
        if not isinstance(self.payload_hull, PayloadHull | None):
            raise InvalidField("Surroundings", "payload_hull", self.payload_hull, "a PayloadHull, or None")
