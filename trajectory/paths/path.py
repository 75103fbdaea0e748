"""Paths of the pose by arc length, and the checks of a path before it is timed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, Protocol

import numpy as np

from kinematics import Array, InvalidValue, Mechanism, is_length

SCHOENFLIES = ("x", "y", "z", "theta")
HIGHEST_ORDER = 4
_ROUNDING = 1e-12  # of the length: how far outside [0, length] an arc length may be by rounding alone


class PathBox(NamedTuple):
    """Bounds of the pose and of its first derivative by s over intervals of s, each (k, n)."""

    low: Array
    high: Array
    first_low: Array
    first_high: Array


class HasPoseNames(Protocol):
    """A way of poses."""

    @property
    def pose_names(self) -> tuple[str, ...]:
        """(n,) of the pose's coordinates."""


class Path(Protocol):
    """A path of poses by the arc length s of the tool point, twice smooth in its tangent.

    The tool point's coordinates, out of x, y and z, stand before the angles.
    """

    @property
    def pose_names(self) -> tuple[str, ...]:
        """(n,) of the pose's coordinates."""

    @property
    def length(self) -> float:
        """Arc length of the tool point's path [m]."""

    @property
    def knots(self) -> tuple[float, ...]:
        """Arc lengths where its pieces meet, 0 and the length included [m]; between them it is analytic."""

    def evaluate(self, s: Array, order: int = 3) -> tuple[Array, ...]:
        """The pose and its derivatives by arc length; at a knot those of the piece that starts there.

        Args:
            s: (...,) arc length in [0, length] [m].
            order: of the highest derivative, 0 to 4.

        Returns:
            order + 1 arrays (..., n): pose, first to at most fourth derivative by s.

        Raises:
            InvalidValue: an arc length is outside the path, or the order outside 0 to 4.
        """

    def enclose(self, low: Array, high: Array) -> PathBox:
        """Bounds that hold everywhere on intervals (k,) of s, each between two neighbouring knots."""

    def steepest(self, s: Array, order: int) -> Array:
        """(k, n) bounds of the modulus of a derivative, the fourth or fifth, on the whole pieces around s (k,)."""

    @property
    def stops(self) -> tuple[float, ...] | None:
        """Arc lengths inside where its tangent jumps, so that the tool rests there [m]; elsewhere it is smooth.

        None where nothing is known by construction: then it must not jump, and `require_smooth` looks for jumps.
        """

    def waypoint(self, s: float) -> int | None:
        """The waypoint, counted from 1, that is nearest to an arc length along the path; None where it has none."""

    def as_dict(self) -> dict[str, object]:
        """Plain data that describes the path, for a file's header."""


@dataclass(frozen=True)
class Reversed:
    """The same path travelled the other way."""

    path: Path

    @property
    def pose_names(self) -> tuple[str, ...]:
        """(n,)."""
        return self.path.pose_names

    @property
    def length(self) -> float:
        """Arc length [m]."""
        return self.path.length

    @property
    def knots(self) -> tuple[float, ...]:
        """As `Path.knots`."""
        return tuple(self.length - s for s in reversed(self.path.knots))

    def evaluate(self, s: Array, order: int = 3) -> tuple[Array, ...]:
        """As `Path.evaluate`; odd derivatives change sign."""
        s = checked_arc_length(s, self.length, order)
        derivatives = self.path.evaluate(self.length - s, order)
        return tuple(-d if k % 2 else d for k, d in enumerate(derivatives))

    def enclose(self, low: Array, high: Array) -> PathBox:
        """As `Path.enclose`."""
        box = self.path.enclose(self.length - high, self.length - low)
        return PathBox(box.low, box.high, -box.first_high, -box.first_low)

    def steepest(self, s: Array, order: int) -> Array:
        """As `Path.steepest`."""
        return self.path.steepest(self.length - s, order)

    @property
    def stops(self) -> tuple[float, ...] | None:
        """As `Path.stops`."""
        stops = self.path.stops
        return None if stops is None else tuple(self.length - s for s in reversed(stops))

    def waypoint(self, s: float) -> int | None:
        """As `Path.waypoint`, by the path's own count."""
        return self.path.waypoint(self.length - s)

    def as_dict(self) -> dict[str, object]:
        """The path's own data, marked as reversed."""
        return {**self.path.as_dict(), "reversed": True}


@dataclass(frozen=True)
class Part:
    """A path between two of its arc lengths [m], as a path of its own."""

    path: Path
    start: float
    stop: float

    @property
    def pose_names(self) -> tuple[str, ...]:
        """(n,)."""
        return self.path.pose_names

    @property
    def length(self) -> float:
        """Arc length [m]."""
        return self.stop - self.start

    @property
    def knots(self) -> tuple[float, ...]:
        """As `Path.knots`."""
        inside = [s for s in self.path.knots if self.start < s < self.stop]
        return tuple(s - self.start for s in (self.start, *inside, self.stop))

    def evaluate(self, s: Array, order: int = 3) -> tuple[Array, ...]:
        """As `Path.evaluate`; at its end those of the piece that ends there."""
        s = self.start + checked_arc_length(s, self.length, order)
        return self.path.evaluate(np.clip(s, self.start, np.nextafter(self.stop, self.start)), order)

    def enclose(self, low: Array, high: Array) -> PathBox:
        """As `Path.enclose`."""
        return self.path.enclose(self.start + low, self.start + high)

    def steepest(self, s: Array, order: int) -> Array:
        """As `Path.steepest`."""
        return self.path.steepest(self.start + s, order)

    @property
    def stops(self) -> tuple[float, ...] | None:
        """As `Path.stops`."""
        stops = self.path.stops
        return None if stops is None else tuple(s - self.start for s in stops if self.start < s < self.stop)

    def waypoint(self, s: float) -> int | None:
        """As `Path.waypoint`, by the path's own count."""
        return self.path.waypoint(self.start + s)

    def as_dict(self) -> dict[str, object]:
        """The path's own data, and from where to where."""
        return {**self.path.as_dict(), "from": self.start, "to": self.stop}


def pieces(path: Path) -> tuple[Path, ...]:
    """The path itself or, where it has stops inside, its parts from one to the next, to be timed one by one."""
    if not path.stops:
        return (path,)
    if isinstance(path, Reversed):  # not a part of it: at its ends the path's own part knows which side is meant
        return tuple(Reversed(part) for part in reversed(pieces(path.path)))
    return tuple(Part(path, a, b) for a, b in pairwise((0.0, *path.stops, path.length)))


def checked_arc_length(s: Array, length: float, order: int) -> Array:
    """The arc length, with what rounding put outside [0, length] moved to its end.

    Raises:
        InvalidValue: an arc length is outside the path or not a number, or the order outside 0 to 4.
    """
    if order not in range(HIGHEST_ORDER + 1):
        raise InvalidValue("order of a path's derivative", order, f"0 to {HIGHEST_ORDER}")
    s = np.asarray(s, dtype=float)
    slack = _ROUNDING * length
    outside = ~((s >= -slack) & (s <= length + slack))
    if outside.any():
        raise InvalidValue("arc length", float(s[outside].flat[0]), f"a number in [0, {length:.6g}] m")
    result: Array = np.clip(s, 0.0, length)
    return result


def places(pose_names: Sequence[str]) -> int:
    """How many of the pose's coordinates are the tool point's; they stand first."""
    return sum(map(is_length, pose_names))


def require_poses_of(robot: Mechanism, path: HasPoseNames) -> None:
    """Check that a path's poses are of the robot's kind.

    Raises:
        InvalidValue: they are of another kind.
    """
    if robot.pose_names != path.pose_names:
        what = f"pose of the path for {type(robot).__name__}"
        raise InvalidValue(what, ", ".join(path.pose_names), ", ".join(robot.pose_names))
