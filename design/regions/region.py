"""Regions of the pose space.

A region is a map from the unit cube to poses. The faces of the cube are the region's boundary. Grids, random samples
and local searches all use this map.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np

from design.errors import InvalidRegion
from kinematics import Array, is_length

ROUNDING = 1e-12  # relative to the largest number between the bounds
_FEW = 4  # up to so many coordinates, three values of each make few poses
CHUNK = 1 << 15  # poses: enough work for all threads, and the chunk stays in the second-level cache


def unit_grid(counts: Sequence[int], chunk: int = CHUNK) -> Iterator[Array]:
    """(k, d) points of a regular grid of the unit cube, k <= chunk at a time; the last coordinate changes fastest."""
    axes = [np.linspace(0.0, 1.0, c) if c > 1 else np.array([0.5]) for c in counts]
    total = math.prod(counts)
    for first in range(0, total, chunk):
        place = np.arange(first, min(first + chunk, total))
        unit = np.empty((len(place), len(axes)))
        for column in reversed(range(len(axes))):
            above = place // len(axes[column])  # far faster than divmod
            unit[:, column] = axes[column][place - above * len(axes[column])]
            place = above
        yield unit


class Region(ABC):
    """A bounded set of poses."""

    @property
    @abstractmethod
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Bounds of each coordinate by its name; equal bounds fix it."""

    @abstractmethod
    def from_unit(self, unit: Array, names: Sequence[str]) -> Array:
        """(..., k) in [0, 1] -> (..., n) poses in the order of `names`."""

    @property
    @abstractmethod
    def dimension(self) -> int:
        """k, how many coordinates are free."""

    @abstractmethod
    def room(self, poses: Array, names: Sequence[str]) -> Array:
        """(..., n) -> (...,) distance of each pose inside the nearest boundary, negative outside [m or rad]."""

    @abstractmethod
    def grown(self, share: float) -> Region:
        """The region with each bound further out: an angle by `share` radians, a length by `share` times `size`."""

    @property
    def size(self) -> float:
        """The largest distance of a bound of x, y or z from 0 [m]. Tolerances scale with it."""
        bounds = [bound for name, pair in self.intervals.items() if is_length(name) for bound in pair]
        return float(np.abs(bounds).max(initial=0.0))

    @abstractmethod
    def narrowed(self, given: Mapping[str, Array]) -> dict[str, tuple[Array | float, Array | float]]:
        """Bounds of each coordinate that is not given, at these values (...,) of the given ones."""

    @abstractmethod
    def inset(self, given: Mapping[str, Array]) -> Array:
        """(...,) distance of the given coordinates (...,) inside a curved boundary [m]; infinity without one."""

    @abstractmethod
    def outline(self) -> list[Array]:
        """Edges of the region's x, y, z part as polylines (k, 3), for drawing."""

    @abstractmethod
    def contains(self, poses: Array, names: Sequence[str], slack: float = ROUNDING) -> Array:
        """(..., n) -> (...,) whether each pose is inside.

        Args:
            slack: a coordinate may be outside a bound by this share of the larger size of its two bounds.
        """

    def check(self, names: Sequence[str]) -> None:
        """Check that the region has exactly these coordinates.

        Raises:
            InvalidRegion: a coordinate is missing or unknown.
        """
        for name in names:
            if name not in self.intervals:
                raise InvalidRegion(name, "no bounds", f"bounds for each of {', '.join(names)}")
        for name in self.intervals:
            if name not in names:
                raise InvalidRegion(name, "an unknown coordinate", f"one of {', '.join(names)}")

    def complete(self, given: Mapping[str, Array], unit: Array, names: Sequence[str]) -> Array:
        """Poses from some coordinates and a point of the unit cube for the others.

        Args:
            given: values (...,) by name.
            unit: (..., k) in [0, 1], one column for each other coordinate that is not fixed, in the order of `names`.

        Returns:
            (..., n). The map of the others is affine, so a uniform `unit` does not give uniform volume.
        """
        pose = np.empty((*unit.shape[:-1], len(names)))
        bounds, column = self.narrowed(given), 0
        for i, name in enumerate(names):
            if name in given:
                pose[..., i] = given[name]
                continue
            low, high = bounds[name]
            pose[..., i] = low
            if self.is_free(name):
                pose[..., i] += (high - low) * unit[..., column]
                column += 1
        return pose

    def is_free(self, name: str) -> bool:
        """Whether a coordinate is not fixed."""
        low, high = self.intervals[name]
        return low < high

    def grid(self, names: Sequence[str], counts: Sequence[int]) -> Array:
        """(prod counts, n) poses on a regular grid of the unit cube, including its faces."""
        return np.concatenate(list(self.walk(names, counts)))

    def walk(self, names: Sequence[str], counts: Sequence[int], chunk: int = CHUNK) -> Iterator[Array]:
        """The poses of `grid` in its order, (k, n) with k <= chunk at a time; memory never holds all of them."""
        return (self.from_unit(unit, names) for unit in unit_grid(counts, chunk))

    def spread(self, names: Sequence[str]) -> Array:
        """(k, n) a few distinct poses on every side of the region, including its corners and its middle."""
        if self.dimension <= _FEW:
            return np.unique(self.grid(names, (3,) * self.dimension), axis=0)
        k = self.dimension  # corners, the middle of each side, and the middle of the whole
        sides = np.concatenate([np.full((1, k), 0.5), 0.5 + 0.5 * np.eye(k), 0.5 - 0.5 * np.eye(k)])
        unit = np.concatenate([np.array(list(product((0.0, 1.0), repeat=k))), sides])
        return np.unique(self.from_unit(unit, names), axis=0)

    def extent(self, names: Sequence[str]) -> Array:
        """(n,) widths of the coordinates' intervals."""
        return np.array([self.intervals[name][1] - self.intervals[name][0] for name in names])

    def random(self, names: Sequence[str], count: int, rng: np.random.Generator) -> Array:
        """(count, n) poses, uniform over the region's volume."""
        return self.from_unit(rng.random((count, self.dimension)), names)
