"""A path through points: straight legs, G3 corners of chosen blend, angles that follow the arc length.

The corners cut the points inside: the nearest pose of the path is the middle of the corner. Between the points that
give an angle it changes monotonically by the septic smoothstep of the arc length, so that it has exactly the value
given at a point (in the middle of its corner) and never leaves the range of the values given.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from kinematics import InvalidValue
from kinematics.interpreter import evaluate
from trajectory.corner import (
    QUINTIC_MOST,
    SEPTIC_MOST,
    corner_length,
    quintic,
    septic,
    septic_program,
    tangent_program,
    turned,
)
from trajectory.errors import InvalidPath
from trajectory.knots import interval_of
from trajectory.path import Array, PathBox, checked_arc_length, places

_STRAIGHT = 1e-12  # rad: a turn that is rounding
_CUSP = math.pi - 1e-6  # rad: from here on a turn is a reversal
_SLACK = 1e-12  # m, rad or 1: far more than what evaluation in double arithmetic is off by


@dataclass(frozen=True)
class RoundedPath:
    """Poses in order, joined by straight legs with rounded corners.

    Attributes:
        pose_names: (n,) of the pose's coordinates, those of the tool point first.
        poses: (k, n) with k >= 2; None for an angle leaves it to its neighbours.
        blends: (k - 2,) what each corner takes off both of its legs [m]; 0 stops there.

    Raises:
        InvalidPath: a value that is not finite, two equal points in a row, a reversal that is to be rounded, or
            corners that overlap; the pose is named, counted from 1.
        InvalidValue: numbers of poses, coordinates or blends that do not fit together.
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
        return tuple(np.unique(np.concatenate([self._layout.edges, *(at for at, _ in self._angles)])).tolist())

    @property
    def stops(self) -> tuple[float, ...]:
        """As `Path.stops`: the corners without a blend."""
        return self._layout.stops

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
        angles = [_angle(at, values, s, order) for at, values in self._angles]
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
        for at, values in self._angles:
            angle, rate = _angle_bounds(at, values, low, high)
            bounds.append(angle[..., None])
            rates.append(rate[..., None])
        (least, most), (slowest, fastest) = (np.concatenate(v, axis=-1) for v in (bounds, rates))
        slack, rate_slack = _SLACK * (1.0 + np.abs(most)), _SLACK * (1.0 + np.abs(first))
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
        for at, values in self._angles:
            most = SEPTIC_MOST[order] * np.abs(np.diff(values)) / np.diff(at) ** order
            bounds.append(most[interval_of(at, s)][:, None])
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

    @cached_property
    def _layout(self) -> _Layout:
        points = np.array([pose[: places(self.pose_names)] for pose in self.poses], dtype=float)
        blends = (0.0, *self.blends, 0.0)
        _require_room(points, blends)
        return _laid_out(points, blends)

    @cached_property
    def _angles(self) -> list[tuple[Array, Array]]:
        """For each angle, the arc lengths where it is given, and its values there."""
        columns = list(zip(*self.poses, strict=True))[places(self.pose_names) :]
        given = [
            [(at, v) for at, v in zip(self._layout.at, column, strict=True) if v is not None] for column in columns
        ]
        return [(np.array([at for at, _ in pairs]), np.array([v for _, v in pairs])) for pairs in given]


class _Layout(NamedTuple):
    """Legs and corners in order; `along` and `across` span the plane in which one turns by `alphas`."""

    edges: Array  # (m + 1,) arc lengths
    lengths: Array  # (m,)
    alphas: Array  # (m,)
    starts: Array  # (m, p)
    along: Array  # (m, p)
    across: Array  # (m, p)
    at: Array  # (k,) arc length at which each point is passed
    stops: tuple[float, ...]


def _laid_out(points: Array, blends: Sequence[float]) -> _Layout:
    steps = np.diff(points, axis=0)
    legs = np.linalg.norm(steps, axis=1)
    units = steps / legs[:, None]
    rows: list[tuple[float, float, Array, Array, Array]] = []
    at, stops, travelled = [0.0], [], 0.0
    for k, (leg, unit) in enumerate(zip(legs, units, strict=True)):
        straight = leg - blends[k] - blends[k + 1]
        if straight > _STRAIGHT * leg:
            rows.append((straight, 0.0, points[k] + blends[k] * unit, unit, np.zeros_like(unit)))
            travelled += straight
        if k + 1 == len(legs):
            break
        alpha, across = _turn(unit, units[k + 1])
        if alpha > _CUSP and blends[k + 1] > 0.0:
            raise InvalidPath(k + 2, "blend", blends[k + 1], "0 m: where a path reverses it has to stop")
        length = corner_length(alpha, blends[k + 1])
        at.append(travelled + length / 2)
        if length > 0.0:
            rows.append((length, alpha, points[k + 1] - blends[k + 1] * unit, unit, across))
            travelled += length
        elif alpha > 0.0:
            stops.append(float(travelled))
    lengths, alphas, starts, along, across_ = (np.array(column) for column in zip(*rows, strict=True))
    edges = np.concatenate([[0.0], np.cumsum(lengths)])
    return _Layout(edges, lengths, alphas, starts, along, across_, np.array([*at, edges[-1]]), tuple(stops))


def _turn(first: Array, second: Array) -> tuple[float, Array]:
    """By how much the second direction is turned from the first, and the unit vector towards it."""
    towards = second - (first @ second) * first
    size = float(np.linalg.norm(towards))
    alpha = math.atan2(size, float(first @ second))
    if size <= _STRAIGHT:
        return (0.0 if alpha < 1.0 else math.pi), np.zeros_like(first)
    return alpha, towards / size


def _angle(at: Array, values: Array, s: Array, order: int) -> list[Array]:
    """(..., 1) an angle and its derivatives by s."""
    span = interval_of(at, s)
    extent, change = np.diff(at)[span], np.diff(values)[span][..., None]
    w = np.clip((s - at[span]) / extent, 0.0, 1.0)
    shares = evaluate(septic_program(), w[..., None], 1 / extent[..., None])
    return [values[span][..., None] + change * shares[0], *(change * share for share in shares[1 : order + 1])]


def _angle_bounds(at: Array, values: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """(2, k) bounds of an angle, and of its rate, change times 140 w^3 (1 - w)^3, which rises up to w = 1/2."""
    span = interval_of(at, 0.5 * low + 0.5 * high)
    extent, change = np.diff(at)[span], np.diff(values)[span]
    w = np.stack([np.clip((s - at[span]) / extent, 0.0, 1.0) for s in (low, high)])
    angle = values[span] + change * septic(w)
    peak = np.clip(0.5, w[0], w[1])
    rates = change / extent * 140 * np.stack([*w, peak]) ** 3 * (1 - np.stack([*w, peak])) ** 3
    return np.stack([angle.min(axis=0), angle.max(axis=0)]), np.stack([rates.min(axis=0), rates.max(axis=0)])


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


def _require_room(points: Array, blends: Sequence[float]) -> None:
    """Raise InvalidPath where a leg has no length or the corners at its ends overlap."""
    for k, leg in enumerate(np.linalg.norm(np.diff(points, axis=0), axis=1), start=1):
        if not leg > 0.0:
            raise InvalidPath(k + 1, "place", points[k].tolist(), f"another one than that of pose {k}")
        both = blends[k - 1] + blends[k]
        if both > leg * (1.0 + _STRAIGHT):
            at = k if blends[k - 1] > blends[k] else k + 1
            expected = f"with its neighbour's at most the {leg:.9g} m from pose {k} to pose {k + 1}, not {both:.9g} m"
            raise InvalidPath(at, "blend", blends[at - 1], expected)
