"""A plane through a region: two pose coordinates are the axes; each other one has fixed values or its interval."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from design.errors import InvalidSection
from design.regions import Region
from kinematics import Array

_ROUNDING = 1e-12  # relative to the largest number between the bounds


@dataclass(frozen=True)
class Section:
    """The poses that belong to each point of a map.

    Attributes:
        region: bounds of all coordinates.
        axes: the two coordinates that are mapped.
        at: values of other coordinates by name [m or rad]. Of several values the worst counts, as for the paper's nine
            angles. For a coordinate that is neither here nor an axis, the worst over its whole interval counts.
    """

    region: Region
    axes: tuple[str, str]
    at: Mapping[str, Sequence[float]] = field(default_factory=dict)

    def check(self, names: Sequence[str]) -> None:
        """Check the section against the robot's coordinates.

        Raises:
            InvalidRegion: the region does not have these coordinates.
            InvalidSection: an axis is given twice, unknown or fixed; a value is outside the region; the plane is empty.
        """
        self.region.check(names)
        if len(self.axes) != 2 or self.axes[0] == self.axes[1]:
            raise InvalidSection("axes", ", ".join(self.axes), f"two different coordinates of {', '.join(names)}")
        for name in self.axes:
            if name not in names:
                raise InvalidSection("axes", name, f"one of {', '.join(names)}")
            if not self.region.is_free(name):
                value = self.region.intervals[name][0]
                raise InvalidSection("axes", f"{name}, which the region fixes at {value:g}", "coordinates that vary")
        for name, values in self.at.items():
            self._check_values(name, values, names)
        for one in self.listed():
            if self.region.inset({name: np.asarray(value) for name, value in one.items()}) < 0.0:
                raise InvalidSection(
                    "at", ", ".join(f"{n} = {v:g}" for n, v in one.items()), f"a pose in {self.region}"
                )

    def _check_values(self, name: str, values: Sequence[float], names: Sequence[str]) -> None:
        if name not in names or name in self.axes:
            others = [n for n in names if n not in self.axes]
            raise InvalidSection("at", name, f"one of {', '.join(others)}")
        low, high = self.region.intervals[name]
        if not len(values):
            raise InvalidSection(f"at {name}", "no value", "at least one")
        slack = _ROUNDING * max(abs(low), abs(high))
        for value in values:
            if not low - slack <= value <= high + slack:
                raise InvalidSection(f"at {name}", f"{value:g}", f"a value in the region, {low:g} to {high:g}")

    def rest(self, names: Sequence[str]) -> list[str]:
        """The coordinates over which the worst value is searched."""
        return [n for n in names if n not in self.axes and n not in self.at and self.region.is_free(n)]

    def listed(self) -> list[dict[str, float]]:
        """Every combination of the values in `at`; one empty combination if `at` is empty."""
        return [dict(zip(self.at, values, strict=True)) for values in product(*self.at.values())]

    def inset(self, points: Array) -> Array:
        """(..., 2) -> (...,) distance of points inside the region's curved boundary [m], for all listed values."""
        plane = {name: points[..., i] for i, name in enumerate(self.axes)}
        every = [self.region.inset({**plane, **{n: np.asarray(v) for n, v in one.items()}}) for one in self.listed()]
        return np.broadcast_to(np.min(every, axis=0), points.shape[:-1])

    def poses(self, points: Array, listed: Mapping[str, float], unit: Array, names: Sequence[str]) -> Array:
        """Poses that belong to points of the plane.

        Args:
            points: (..., 2).
            listed: one of `listed()`.
            unit: (..., k) in [0, 1], the place of the other coordinates in the region.

        Returns:
            (..., n).
        """
        given = {name: points[..., i] for i, name in enumerate(self.axes)}
        given |= {name: np.asarray(value) for name, value in listed.items()}
        return self.region.complete(given, unit, names)

    def __str__(self) -> str:
        parts = [f"{name} = {', '.join(f'{v:g}' for v in values)}" for name, values in self.at.items()]
        return f"{self.axes[0]}, {self.axes[1]}" + (f" at {'; '.join(parts)}" if parts else "")
