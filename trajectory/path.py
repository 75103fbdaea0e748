"""Paths of the pose by arc length, and what a path must be before it is timed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, Protocol

import numpy as np

from kinematics import InvalidValue, Mechanism
from trajectory.errors import RoughPath

Array = np.ndarray
SCHOENFLIES = ("x", "y", "z", "theta")
HIGHEST_ORDER = 4
_ROUNDING = 1e-12  # of the length: how far outside [0, length] an arc length may be by rounding alone
_UNIT = 1e-9  # how far from 1 the length of the tangent may be
_JUMP = 0.05  # how far the tangent may be from the trapezoid of its derivative between neighbouring samples


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

    def split(self) -> tuple[Path, ...]:
        """Itself or, where the tangent jumps inside, its parts from one jump to the next, to be timed one by one."""

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

    def split(self) -> tuple[Path, ...]:
        """The path's own parts, the last one first."""
        return tuple(Reversed(part) for part in reversed(self.path.split()))

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

    def split(self) -> tuple[Path, ...]:
        """As `Path.split`."""
        return (self,)

    def as_dict(self) -> dict[str, object]:
        """The path's own data, and from where to where."""
        return {**self.path.as_dict(), "from": self.start, "to": self.stop}


def pieces(path: Path, stops: Sequence[float]) -> tuple[Path, ...]:
    """The path itself, or its parts between stops inside it [m]."""
    edges = [0.0, *stops, path.length]
    return tuple(Part(path, a, b) for a, b in pairwise(edges)) if stops else (path,)


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
    return np.clip(s, 0.0, length)


def places(pose_names: Sequence[str]) -> int:
    """How many of the pose's coordinates are the tool point's; they stand first."""
    return sum(name in ("x", "y", "z") for name in pose_names)


def require_poses_of(robot: Mechanism, path: HasPoseNames) -> None:
    """Check that a path's poses are of the robot's kind.

    Raises:
        InvalidValue: they are of another kind.
    """
    if robot.pose_names != path.pose_names:
        what = f"pose of the path for {type(robot).__name__}"
        raise InvalidValue(what, ", ".join(path.pose_names), ", ".join(robot.pose_names))


def require_smooth(path: Path, s: Array) -> None:
    """Check that a path can be passed at speed: a unit tangent that does not jump between the samples.

    A jump shows as a change of the tangent that its own derivative does not explain: over each interval the change is
    compared with the trapezoid of the second derivative. A reversal within gives 2, a right angle about 1.4.

    Args:
        path: any path.
        s: (k,) increasing arc lengths [m], the grid on which it will be timed.

    Raises:
        RoughPath: with the place and the defect; NaN derivatives are refused too.
    """
    _, first, second = path.evaluate(s, 2)
    count = places(path.pose_names)
    unit = np.abs(np.linalg.norm(first[:, :count], axis=-1) - 1.0)
    _require_small(unit, s, "the tangent's length minus 1", _UNIT)
    explained = np.diff(s)[:, None] * (second[1:] + second[:-1]) / 2
    jump = np.diff(first, axis=0) - explained
    _require_small(np.linalg.norm(jump[:, :count], axis=-1), s, "a jump of the tangent", _JUMP)
    for k, name in enumerate(path.pose_names[count:], start=count):
        _require_small(np.abs(jump[:, k]), s, f"a jump of d {name} / ds [rad/m]", _JUMP * np.abs(first[:, k]).max())


def _require_small(defect: Array, s: Array, what: str, bound: float) -> None:
    bad = ~(defect <= bound)
    if bad.any():
        k = int(np.argmax(np.where(np.isnan(defect), np.inf, defect)))
        raise RoughPath(float(s[k]), what, float(defect[k]), bound)
