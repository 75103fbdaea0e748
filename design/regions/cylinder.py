"""Cylinders of poses."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from design.errors import InvalidRegion
from design.regions.bounds import LARGEST, Interval, number
from design.regions.box import Box
from design.regions.region import ROUNDING, Region
from kinematics import Array


class Cylinder(Region):
    """Poses with x and y inside a circle about the z axis, and the other coordinates in intervals.

    Raises:
        InvalidRegion: the radius is not positive, or of two bounds the lower one is not first.
    """

    def __init__(self, radius: float, **coordinates: Interval) -> None:
        self.radius = number(radius)
        if not self.radius >= 1.0 / LARGEST:
            raise InvalidRegion("radius", radius, "a length > 0 m whose square is a number")
        for name in ("x", "y"):
            if name in coordinates:
                raise InvalidRegion(name, coordinates[name], "no bounds, as the radius bounds x and y")
        self._rest = Box(**coordinates)

    def __repr__(self) -> str:
        return f"Cylinder(radius={self.radius}, {repr(self._rest)[4:]}"

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Bounds by name; those of x and y are plus and minus the radius."""
        side = (-self.radius, self.radius)
        return {"x": side, "y": side} | self._rest.intervals

    @property
    def dimension(self) -> int:
        """Two for the disc, and the number of other coordinates that are not fixed."""
        return 2 + self._rest.dimension

    def from_unit(self, unit: Array, names: Sequence[str]) -> Array:
        """The first two columns are polar coordinates that keep ratios of areas. The others are mapped affinely."""
        radius, azimuth = self.radius * np.sqrt(unit[..., 0]), 2.0 * math.pi * unit[..., 1]
        others = [name for name in names if name not in ("x", "y")]
        pose = np.empty((*unit.shape[:-1], len(names)))
        pose[..., names.index("x")] = radius * np.cos(azimuth)
        pose[..., names.index("y")] = radius * np.sin(azimuth)
        pose[..., [names.index(name) for name in others]] = self._rest.from_unit(unit[..., 2:], others)
        return pose

    def spread(self, names: Sequence[str]) -> Array:
        """The axis and eight directions at the edge, at three values of each other coordinate."""
        disc = [(0.0, 0.0), *((1.0, k / 8) for k in range(8))]
        rest = product((0.0, 0.5, 1.0), repeat=self._rest.dimension)
        return self.from_unit(np.array([(*d, *r) for r in rest for d in disc]), names)

    def room(self, poses: Array, names: Sequence[str]) -> Array:
        """Distance to the circle, or to the nearest bound of another coordinate."""
        x, y = poses[..., names.index("x")], poses[..., names.index("y")]
        others = [name for name in names if name not in ("x", "y")]
        rest = self._rest.room(poses[..., [names.index(name) for name in others]], others)
        result: Array = np.minimum(rest, self.radius - np.hypot(x, y))
        return result

    def grown(self, share: float) -> Cylinder:
        """The cylinder with its bounds further out; lengths grow by `share` of the largest of radius and heights."""
        by = share * self.size
        return Cylinder(self.radius + by, **self._rest.grown_by(share, self.size).intervals)

    def contains(self, poses: Array, names: Sequence[str], slack: float = ROUNDING) -> Array:
        """Whether poses are inside the circle and between the other bounds."""
        x, y = poses[..., names.index("x")], poses[..., names.index("y")]
        others = [name for name in names if name not in ("x", "y")]
        rest = self._rest.contains(poses[..., [names.index(name) for name in others]], others, slack)
        result: Array = rest & (np.hypot(x, y) <= self.radius * (1.0 + slack))
        return result

    def complete(self, given: Mapping[str, Array], unit: Array, names: Sequence[str]) -> Array:
        """As in the base. If neither x nor y is given, the first two columns are polar coordinates in the disc."""
        if "x" not in given and "y" not in given:
            radius, azimuth = self.radius * np.sqrt(unit[..., 0]), 2.0 * math.pi * unit[..., 1]
            given = {**given, "x": radius * np.cos(azimuth), "y": radius * np.sin(azimuth)}
            unit = unit[..., 2:]
        return super().complete(given, unit, names)

    def narrowed(self, given: Mapping[str, Array]) -> dict[str, tuple[Array | float, Array | float]]:
        """Bounds of x or y on the chord at the other one's value; one of them must be given."""
        bounds = self._rest.narrowed(given)
        for name, other in (("x", "y"), ("y", "x")):
            if name not in given:
                half = np.sqrt(np.maximum(self.radius**2 - given[other] ** 2, 0.0))
                bounds[name] = (-half, half)
        return bounds

    def inset(self, given: Mapping[str, Array]) -> Array:
        """Distance inside the circle, if x or y or both are given."""
        return self.radius - np.hypot(given.get("x", 0.0), given.get("y", 0.0))

    def outline(self) -> list[Array]:
        """The circles at both ends."""
        turn = np.linspace(0.0, 2.0 * math.pi, 97)
        ring = self.radius * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
        return [np.column_stack([ring, np.full(97, z)]) for z in self._rest.intervals.get("z", (0.0,))]
