"""A path through points: straight legs, G3 corners of chosen blend, angles that follow the arc length.

A corner passes inside its point; its middle is nearest to the point. Between the points that give an angle, the angle
changes monotonically by the septic smoothstep of the arc length. So it has exactly the given value at a point (in the
middle of its corner), and never leaves the range of the given values.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from kinematics import Array, InvalidValue, evaluate
from trajectory.errors import InvalidPath
from trajectory.paths.angles import Angle
from trajectory.paths.corner import QUINTIC_MOST, quintic, tangent_program, turned
from trajectory.paths.knots import interval_of
from trajectory.paths.legs_and_blends import Layout, laid_out, turning_in_place
from trajectory.paths.path import PathBox, checked_arc_length, places

_SLACK = 1e-12  # relative: far more than what evaluation in double arithmetic is off by


@dataclass(frozen=True)
class RoundedPath:
    """Poses in order, joined by straight legs with rounded corners.

    Attributes:
        pose_names: (n,) names of the pose's coordinates, those of the tool point first.
        poses: (k, n) with k >= 2. An angle that is None is interpolated between its neighbours.
        blends: (k - 2,) length that each corner takes off both of its legs [m]. With 0 the tool stops there, unless the
            path goes straight on (see `legs`).

    Two poses in a row at the same place turn the tool there, from stop to stop. Both must give all their angles.

    Raises:
        InvalidPath: a value is not finite, two poses in a row are equal, a reversal has a blend, or corners overlap;
            the message names the pose, counted from 1.
        InvalidValue: the numbers of poses, coordinates or blends do not fit together.
    """

    pose_names: tuple[str, ...]
    poses: tuple[tuple[float | None, ...], ...]
    blends: tuple[float, ...]

    def __post_init__(self) -> None:
        _require_complete(self)
        self._layout  # noqa: B018  raises where the corners do not fit

    @property
    def length(self) -> float:
        """Arc length [m]."""
        return float(self._layout.edges[-1])

    @cached_property
    def knots(self) -> tuple[float, ...]:
        """As `Path.knots`: the ends of legs and corners, and where an angle is given."""
        return tuple(np.unique(np.concatenate([self._layout.edges, *(angle.at for angle in self._angles)])).tolist())

    @property
    def stops(self) -> tuple[float, ...]:
        """As `Path.stops`: the corners without a blend."""
        return self._layout.stops

    def waypoint(self, s: float) -> int | None:
        """As `Path.waypoint`."""
        return int(np.argmin(np.abs(self._layout.at - s))) + 1

    def as_dict(self) -> dict[str, object]:
        """The fields, as lists."""
        return {
            "coordinates": list(self.pose_names),
            "poses": [list(pose) for pose in self.poses],
            "blends": list(self.blends),
        }

    def evaluate(self, s: Array, order: int = 3) -> tuple[Array, ...]:
        """As `Path.evaluate`."""
        s = checked_arc_length(s, self.length, order)
        layout = self._layout
        piece, u = self._within(s)
        rate, alpha = 1 / layout.lengths[piece], layout.alphas[piece]
        along, across = layout.along[piece], layout.across[piece]
        c, d = turned(u, alpha)
        found = [layout.starts[piece] + layout.lengths[piece, None] * (c[..., None] * along + d[..., None] * across)]
        if order:
            tangents = evaluate(tangent_program(), *(v[..., None] for v in (u, rate, alpha)))
            found += [t[..., :1] * along + t[..., 1:] * across for t in tangents[:order]]
        angles = [angle.evaluate(s, order) for angle in self._angles]
        return tuple(np.concatenate([place, *(angle[k] for angle in angles)], axis=-1) for k, place in enumerate(found))

    def enclose(self, low: Array, high: Array) -> PathBox:
        """As `Path.enclose`: unit tangents that turn by a known angle, and angles that change monotonically."""
        middle = 0.5 * low + 0.5 * high
        pose, first = self.evaluate(middle, 1)
        count = places(self.pose_names)
        tangent = self._tangent_bounds(first[:, :count], middle, low, high)
        reach = np.maximum(high - middle, middle - low)[:, None] * np.abs(tangent).max(axis=0)
        bounds = [np.stack([pose[:, :count] - reach, pose[:, :count] + reach])]
        rates = [tangent]
        for angle in self._angles:
            value, rate = angle.bounds(low, high)
            bounds.append(value[..., None])
            rates.append(rate[..., None])
        (least, most), (slowest, fastest) = (np.concatenate(v, axis=-1) for v in (bounds, rates))
        size = np.where(np.arange(len(self.pose_names)) < count, self.length, 1.0)
        slack, rate_slack = _SLACK * (size + np.abs(most)), _SLACK * (size / self.length + np.abs(first))
        return PathBox(least - slack, most + slack, slowest - rate_slack, fastest + rate_slack)

    def steepest(self, s: Array, order: int) -> Array:
        """As `Path.steepest`, from the largest derivatives of S5 and S7 on [0, 1].

        With a, b, c, d the first four derivatives of the tangent's angle, the tangent's third one has the components
        c - a^3 and 3 a b, its fourth one d - 6 a^2 b and a^4 - 3 b^2 - 4 a c.
        """
        piece, _ = self._within(s)
        length, alpha = self._layout.lengths[piece], self._layout.alphas[piece]
        a, b, c, d = (alpha * most / length**k for k, most in enumerate(QUINTIC_MOST, start=1))
        third = np.hypot(c + a**3, 3 * a * b)
        tangent = third if order == 4 else np.hypot(d + 6 * a**2 * b, a**4 + 3 * b**2 + 4 * a * c)
        bounds = [np.broadcast_to(tangent[:, None], (s.size, places(self.pose_names)))]
        bounds += [angle.steepest(s, order)[:, None] for angle in self._angles]
        return np.concatenate(bounds, axis=-1)

    def _tangent_bounds(self, tangent: Array, middle: Array, low: Array, high: Array) -> Array:
        """(2, k, p) bounds of the tangent, which is away from that in the middle by no more than it turns."""
        piece, _ = self._within(middle)
        ends = [(s - self._layout.edges[piece]) / self._layout.lengths[piece] for s in (low, high)]
        first, last = (quintic(np.clip(u, 0.0, 1.0)) for u in ends)
        turn = (self._layout.alphas[piece] * (last - first))[:, None]
        return np.stack([np.maximum(tangent - turn, -1.0), np.minimum(tangent + turn, 1.0)])

    def _within(self, s: Array) -> tuple[Array, Array]:
        """Which piece, and how far into it as a fraction."""
        edges, lengths = self._layout.edges, self._layout.lengths
        piece = interval_of(edges, s)
        return piece, np.clip((s - edges[piece]) / lengths[piece], 0.0, 1.0)

    @property
    def _points(self) -> Array:
        """(k, p)."""
        return np.array([pose[: places(self.pose_names)] for pose in self.poses], dtype=float)

    @cached_property
    def _layout(self) -> Layout:
        count, points = places(self.pose_names), self._points
        in_place = turning_in_place(points)
        for k in np.flatnonzero(in_place).tolist():
            if None in (*self.poses[k], *self.poses[k + 1]):
                expected = (
                    f"a place other than that of pose {k + 1}, or all angles of both poses to turn the tool there"
                )
                raise InvalidPath(k + 2, "place", points[k + 1].tolist(), expected)
        angles = np.array([pose[count:] for pose in self.poses], dtype=float)  # NaN where none is given
        turns = np.where(in_place, np.linalg.norm(np.diff(angles, axis=0), axis=1), 0.0)
        return laid_out(points, (0.0, *self.blends, 0.0), in_place, turns)

    @cached_property
    def _angles(self) -> list[Angle]:
        columns = list(zip(*self.poses, strict=True))[places(self.pose_names) :]
        found = []
        for column in columns:
            given = [k for k, value in enumerate(column) if value is not None]
            even = turning_in_place(self._points)[given[:-1]]  # both ends of such a leg are given
            found.append(Angle(self._layout.at[given], np.array([column[k] for k in given], dtype=float), even))
        return found


def _require_complete(path: RoundedPath) -> None:
    """Raise InvalidPath or InvalidValue where the fields do not make a path."""
    n, inner = len(path.pose_names), len(path.poses) - 2
    if inner < 0 or any(len(pose) != n for pose in path.poses):
        raise InvalidValue("poses of a path", path.poses, f"at least 2, each with {', '.join(path.pose_names)}")
    if len(path.blends) != inner:
        raise InvalidValue("blends of a path", path.blends, f"{inner}, one for each pose between the ends")
    for k, pose in enumerate(path.poses, start=1):
        needed = path.pose_names if k in (1, inner + 2) else path.pose_names[: places(path.pose_names)]
        for name, value in zip(path.pose_names, pose, strict=True):
            if (value is None and name in needed) or (value is not None and not math.isfinite(value)):
                raise InvalidPath(k, name, value, "a finite number")
    for k, blend in enumerate(path.blends, start=2):
        if not (math.isfinite(blend) and blend >= 0.0):
            raise InvalidPath(k, "blend", blend, "a length >= 0 m")
