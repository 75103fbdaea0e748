"""Regions of the pose space, all coordinates continuous.

A region is a map from the unit cube: one parametrisation serves grids, random samples and local searches, and its
faces are the region's boundary.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from numbers import Real

import numpy as np

from design.errors import InvalidRegion
from kinematics import Array

Interval = float | tuple[float, float]
_ROUNDING = 1e-12  # relative to the largest number between the bounds
_LARGEST = 1e100  # of a bound: squares of it must stay numbers
_FEW = 4  # coordinates up to which three values of each are few poses
CHUNK = 1 << 15  # poses: enough for all threads, and a chunk stays in the second cache


def unit_grid(counts: Sequence[int], chunk: int = CHUNK) -> Iterator[Array]:
    """(k, d) points of a regular grid of the unit cube, k <= chunk at a time; the last coordinate runs fastest."""
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
        """(..., n) -> (...,) how far each pose is inside the nearest boundary, negative beyond it [m or rad]."""

    @abstractmethod
    def grown(self, share: float) -> Region:
        """With each bound further out, of an angle by `share` radians, of a length by that share of `size`."""

    @property
    def size(self) -> float:
        """The largest distance of a bound of x, y or z from 0 [m]: what makes a distance large or small here."""
        bounds = [bound for name, pair in self.intervals.items() if name in ("x", "y", "z") for bound in pair]
        return float(np.abs(bounds).max(initial=0.0))

    @abstractmethod
    def narrowed(self, given: Mapping[str, Array]) -> dict[str, tuple[Array | float, Array | float]]:
        """Bounds of each coordinate that is not given, where those that are have these values (...,)."""

    @abstractmethod
    def inset(self, given: Mapping[str, Array]) -> Array:
        """(...,) how far the given coordinates (...,) are inside a curved boundary [m]; infinity without one."""

    @abstractmethod
    def outline(self) -> list[Array]:
        """Edges of the region's x, y, z part as polylines (k, 3), for drawing."""

    @abstractmethod
    def contains(self, poses: Array, names: Sequence[str], slack: float = _ROUNDING) -> Array:
        """(..., n) -> (...,) whether each pose is inside.

        Args:
            slack: a coordinate may be beyond a bound by this part of the larger of both bounds, without their signs.
        """

    def check(self, names: Sequence[str]) -> None:
        """Check that the region speaks of exactly these coordinates.

        Raises:
            InvalidRegion: one is missing or unknown.
        """
        for name in names:
            if name not in self.intervals:
                raise InvalidRegion(name, "nothing", f"bounds for each of {', '.join(names)}")
        for name in self.intervals:
            if name not in names:
                raise InvalidRegion(name, "a coordinate", f"one of {', '.join(names)}")

    def complete(self, given: Mapping[str, Array], unit: Array, names: Sequence[str]) -> Array:
        """Poses from some coordinates and a point of the unit cube for the others.

        Args:
            given: values (...,) by name.
            unit: (..., k) in [0, 1], one column for each other coordinate that is not fixed, in the order of `names`.

        Returns:
            (..., n); affine in the others, so not uniform over their volume.
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
        """(prod counts, n) poses on a regular grid of the unit cube, its faces included."""
        return np.concatenate(list(self.walk(names, counts)))

    def walk(self, names: Sequence[str], counts: Sequence[int], chunk: int = CHUNK) -> Iterator[Array]:
        """The poses of `grid` in its order, (k, n) with k <= chunk at a time, so that no list of them is in memory."""
        return (self.from_unit(unit, names) for unit in unit_grid(counts, chunk))

    def spread(self, names: Sequence[str]) -> Array:
        """(k, n) few distinct poses that reach every side of the region, corners and middle included."""
        if self.dimension <= _FEW:
            return np.unique(self.grid(names, (3,) * self.dimension), axis=0)
        k = self.dimension  # corners, and the middle of each side and of the whole
        sides = np.concatenate([np.full((1, k), 0.5), 0.5 + 0.5 * np.eye(k), 0.5 - 0.5 * np.eye(k)])
        unit = np.concatenate([np.array(list(product((0.0, 1.0), repeat=k))), sides])
        return np.unique(self.from_unit(unit, names), axis=0)

    def extent(self, names: Sequence[str]) -> Array:
        """(n,) widths of the coordinates' intervals."""
        return np.array([self.intervals[name][1] - self.intervals[name][0] for name in names])

    def random(self, names: Sequence[str], count: int, rng: np.random.Generator) -> Array:
        """(count, n) poses, uniform over the region's volume."""
        return self.from_unit(rng.random((count, self.dimension)), names)


class Box(Region):
    """An axis-aligned box: `Box(x=0.0, y=(-0.25, 0.25), ...)`; a number fixes a coordinate.

    Raises:
        InvalidRegion: bounds that are not finite or not in rising order.
    """

    def __init__(self, **coordinates: Interval) -> None:
        self._intervals = {name: _interval(name, value) for name, value in coordinates.items()}

    def __repr__(self) -> str:
        return f"Box({', '.join(f'{k}={v}' for k, v in self._intervals.items())})"

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Bounds by name."""
        return dict(self._intervals)

    @property
    def dimension(self) -> int:
        """Coordinates that are not fixed."""
        return sum(low < high for low, high in self._intervals.values())

    def from_unit(self, unit: Array, names: Sequence[str]) -> Array:
        """Affine, in the order of `names`; fixed coordinates take no column of `unit`."""
        pose = np.empty((*unit.shape[:-1], len(names)))
        column = 0
        for i, name in enumerate(names):
            low, high = self._intervals[name]
            if low < high:
                pose[..., i] = low + (high - low) * unit[..., column]
                column += 1
            else:
                pose[..., i] = low
        return pose

    def room(self, poses: Array, names: Sequence[str]) -> Array:
        """To the nearest bound of a coordinate."""
        low, high = np.array([self._intervals[name] for name in names]).T
        return np.minimum(poses - low, high - poses).min(axis=-1)

    def grown(self, share: float) -> Box:
        """By the largest of its own lengths."""
        return self._grown(share, self.size)

    def _grown(self, share: float, size: float) -> Box:
        by = {name: share * (size if name in ("x", "y", "z") else 1.0) for name in self._intervals}
        return Box(**{name: (low - by[name], high + by[name]) for name, (low, high) in self._intervals.items()})

    def contains(self, poses: Array, names: Sequence[str], slack: float = _ROUNDING) -> Array:
        """Between all bounds."""
        low, high = np.array([self._intervals[name] for name in names]).reshape(-1, 2).T
        beyond = slack * np.maximum(np.abs(low), np.abs(high))
        return ((poses >= low - beyond) & (poses <= high + beyond)).all(axis=-1)

    def narrowed(self, given: Mapping[str, Array]) -> dict[str, tuple[Array | float, Array | float]]:
        """The others' own bounds."""
        return {name: interval for name, interval in self._intervals.items() if name not in given}

    def inset(self, given: Mapping[str, Array]) -> Array:
        """No boundary is curved."""
        return np.full(np.broadcast_shapes(*(np.shape(v) for v in given.values())), np.inf)

    def outline(self) -> list[Array]:
        """The box's edges."""
        sides = [self._intervals.get(name, (0.0, 0.0)) for name in ("x", "y", "z")]
        vertices = np.array(list(product(*sides)))
        return [vertices[[i, j]] for i in range(8) for j in range(i + 1, 8) if (i ^ j) in (1, 2, 4)]


class Cylinder(Region):
    """x and y inside a circle about the z axis, the other coordinates in intervals.

    Raises:
        InvalidRegion: a radius that is not positive, or bounds not in rising order.
    """

    def __init__(self, radius: float, **coordinates: Interval) -> None:
        self.radius = _number(radius)
        if not self.radius >= 1.0 / _LARGEST:
            raise InvalidRegion("radius", radius, "a length > 0 m whose square is a number")
        for name in ("x", "y"):
            if name in coordinates:
                raise InvalidRegion(name, coordinates[name], "only the radius for x and y")
        self._rest = Box(**coordinates)

    def __repr__(self) -> str:
        return f"Cylinder(radius={self.radius}, {repr(self._rest)[4:]}"

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Bounds by name; x and y those of the circle's square."""
        side = (-self.radius, self.radius)
        return {"x": side, "y": side} | self._rest.intervals

    @property
    def dimension(self) -> int:
        """The disc's two, and the rest."""
        return 2 + self._rest.dimension

    def from_unit(self, unit: Array, names: Sequence[str]) -> Array:
        """Area-true polar coordinates in the first two columns, affine in the rest."""
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
        """To the circle, or to the nearest bound of another coordinate."""
        x, y = poses[..., names.index("x")], poses[..., names.index("y")]
        others = [name for name in names if name not in ("x", "y")]
        rest = self._rest.room(poses[..., [names.index(name) for name in others]], others)
        return np.minimum(rest, self.radius - np.hypot(x, y))

    def grown(self, share: float) -> Cylinder:
        """By the largest of the radius and the heights."""
        by = share * self.size
        return Cylinder(self.radius + by, **self._rest._grown(share, self.size).intervals)

    def contains(self, poses: Array, names: Sequence[str], slack: float = _ROUNDING) -> Array:
        """Within the circle and between the other bounds."""
        x, y = poses[..., names.index("x")], poses[..., names.index("y")]
        others = [name for name in names if name not in ("x", "y")]
        rest = self._rest.contains(poses[..., [names.index(name) for name in others]], others, slack)
        return rest & (np.hypot(x, y) <= self.radius * (1.0 + slack))

    def complete(self, given: Mapping[str, Array], unit: Array, names: Sequence[str]) -> Array:
        """Where neither x nor y is given, the first two columns are polar coordinates in the disc."""
        if "x" not in given and "y" not in given:
            radius, azimuth = self.radius * np.sqrt(unit[..., 0]), 2.0 * math.pi * unit[..., 1]
            given = {**given, "x": radius * np.cos(azimuth), "y": radius * np.sin(azimuth)}
            unit = unit[..., 2:]
        return super().complete(given, unit, names)

    def narrowed(self, given: Mapping[str, Array]) -> dict[str, tuple[Array | float, Array | float]]:
        """x or y in the chord that the other leaves; one of them has to be given."""
        bounds = self._rest.narrowed(given)
        for name, other in (("x", "y"), ("y", "x")):
            if name not in given:
                half = np.sqrt(np.maximum(self.radius**2 - given[other] ** 2, 0.0))
                bounds[name] = (-half, half)
        return bounds

    def inset(self, given: Mapping[str, Array]) -> Array:
        """From the circle, where x and y are given or one of them is."""
        return self.radius - np.hypot(given.get("x", 0.0), given.get("y", 0.0))

    def outline(self) -> list[Array]:
        """The circles at both ends."""
        turn = np.linspace(0.0, 2.0 * math.pi, 97)
        ring = self.radius * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
        return [np.column_stack([ring, np.full(97, z)]) for z in self._rest.intervals.get("z", (0.0,))]


def _interval(name: str, value: object) -> tuple[float, float]:
    pair = tuple(value) if isinstance(value, list | tuple) else (value, value)
    low, high = (_number(v) for v in pair) if len(pair) == 2 else (math.nan, math.nan)
    if not low <= high:
        raise InvalidRegion(name, value, "a number whose square is one too, or two with the lower first")
    return low, high


def _number(value: object) -> float:
    """The value as a float; NaN where it is no number of a usual size."""
    number = float(value) if isinstance(value, Real) and not isinstance(value, bool) else math.nan
    return number if abs(number) <= _LARGEST else math.nan
