"""Boxes of poses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from design.regions.bounds import Interval, interval
from design.regions.region import ROUNDING, Region
from kinematics import LENGTHS, Array, is_length


class Box(Region):
    """An axis-aligned box, such as `Box(x=0.0, y=(-0.25, 0.25), ...)`; a single number fixes a coordinate.

    Raises:
        InvalidRegion: bounds are not finite, or the lower one is not first.
    """

    def __init__(self, **coordinates: Interval) -> None:
        self._intervals = {name: interval(name, value) for name, value in coordinates.items()}

    def __repr__(self) -> str:
        return f"Box({', '.join(f'{k}={v}' for k, v in self._intervals.items())})"

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Bounds by name."""
        return dict(self._intervals)

    @property
    def dimension(self) -> int:
        """Number of coordinates that are not fixed."""
        return sum(low < high for low, high in self._intervals.values())

    def from_unit(self, unit: Array, names: Sequence[str]) -> Array:
        """An affine map, in the order of `names`. Fixed coordinates have no column in `unit`."""
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
        """Distance to the nearest bound of a coordinate."""
        low, high = np.array([self._intervals[name] for name in names]).T
        result: Array = np.minimum(poses - low, high - poses).min(axis=-1)
        return result

    def grown(self, share: float) -> Box:
        """The box with its bounds further out; lengths grow by `share` of the box's own `size`."""
        return self.grown_by(share, self.size)

    def grown_by(self, share: float, size: float) -> Box:
        """As `grown`, with the `size` of a region that this box is a part of [m]."""
        by = {name: share * (size if is_length(name) else 1.0) for name in self._intervals}
        return Box(**{name: (low - by[name], high + by[name]) for name, (low, high) in self._intervals.items()})

    def contains(self, poses: Array, names: Sequence[str], slack: float = ROUNDING) -> Array:
        """Whether poses are between all bounds."""
        low, high = np.array([self._intervals[name] for name in names]).reshape(-1, 2).T
        beyond = slack * np.maximum(np.abs(low), np.abs(high))
        result: Array = ((poses >= low - beyond) & (poses <= high + beyond)).all(axis=-1)
        return result

    def narrowed(self, given: Mapping[str, Array]) -> dict[str, tuple[Array | float, Array | float]]:
        """The bounds of the other coordinates, which do not depend on those given."""
        return {name: interval for name, interval in self._intervals.items() if name not in given}

    def inset(self, given: Mapping[str, Array]) -> Array:
        """Infinity, as no boundary is curved."""
        return np.full(np.broadcast_shapes(*(np.shape(v) for v in given.values())), np.inf)

    def outline(self) -> list[Array]:
        """The box's edges."""
        sides = [self._intervals.get(name, (0.0, 0.0)) for name in LENGTHS]
        vertices = np.array(list(product(*sides)))
        return [vertices[[i, j]] for i in range(8) for j in range(i + 1, 8) if (i ^ j) in (1, 2, 4)]
