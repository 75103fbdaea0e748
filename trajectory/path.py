"""Paths of the pose by arc length, and what a path must be before it is timed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from kinematics import InvalidValue, Mechanism
from trajectory.errors import RoughPath

Array = np.ndarray
POSE_NAMES = ("x", "y", "z", "theta")
_ROUNDING = 1e-12  # of the length: how far outside [0, length] an arc length may be by rounding alone
_UNIT = 1e-9  # how far from 1 the length of the tangent may be
_JUMP = 0.05  # how far the tangent may be from the trapezoid of its derivative between neighbouring samples


class Path(Protocol):
    """A path of poses [x, y, z, theta] by the arc length s of the tool point, twice smooth in its tangent."""

    @property
    def length(self) -> float:
        """Arc length of the tool point's path [m]."""

    def evaluate(self, s: Array, order: int = 3) -> tuple[Array, ...]:
        """The pose and its derivatives by arc length.

        Args:
            s: (...,) arc length in [0, length] [m].
            order: of the highest derivative, 0 to 3.

        Returns:
            order + 1 arrays (..., 4): pose, first, second, third derivative by s.

        Raises:
            InvalidValue: an arc length is outside the path, or the order outside 0 to 3.
        """

    def as_dict(self) -> dict[str, object]:
        """Plain data that describes the path, for a file's header."""


@dataclass(frozen=True)
class Reversed:
    """The same path travelled the other way."""

    path: Path

    @property
    def length(self) -> float:
        """Arc length [m]."""
        return self.path.length

    def evaluate(self, s: Array, order: int = 3) -> tuple[Array, ...]:
        """As `Path.evaluate`; odd derivatives change sign."""
        s = checked_arc_length(s, self.length, order)
        derivatives = self.path.evaluate(self.length - s, order)
        return tuple(-d if k % 2 else d for k, d in enumerate(derivatives))

    def as_dict(self) -> dict[str, object]:
        """The path's own data, marked as reversed."""
        return {**self.path.as_dict(), "reversed": True}


def checked_arc_length(s: Array, length: float, order: int) -> Array:
    """The arc length, with what rounding put outside [0, length] moved to its end.

    Raises:
        InvalidValue: an arc length is outside the path or not a number, or the order outside 0 to 3.
    """
    if order not in (0, 1, 2, 3):
        raise InvalidValue("order of a path's derivative", order, "0, 1, 2 or 3")
    s = np.asarray(s, dtype=float)
    slack = _ROUNDING * length
    outside = ~((s >= -slack) & (s <= length + slack))
    if outside.any():
        raise InvalidValue("arc length", float(s[outside].flat[0]), f"a number in [0, {length:.6g}] m")
    return np.clip(s, 0.0, length)


def require_schoenflies(robot: Mechanism) -> None:
    """Check that the robot's pose is [x, y, z, theta].

    Raises:
        InvalidValue: it is something else.
    """
    if robot.pose_names != POSE_NAMES:
        raise InvalidValue(f"pose of {type(robot).__name__}", robot.pose_names, f"{POSE_NAMES} for a path of this kind")


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
    unit = np.abs(np.linalg.norm(first[:, :3], axis=-1) - 1.0)
    _require_small(unit, s, "the tangent's length minus 1", _UNIT)
    explained = np.diff(s)[:, None] * (second[1:] + second[:-1]) / 2
    jump = np.diff(first, axis=0) - explained
    _require_small(np.linalg.norm(jump[:, :3], axis=-1), s, "a jump of the tangent", _JUMP)
    turning = np.abs(first[:, 3]).max()
    _require_small(np.abs(jump[:, 3]), s, "a jump of d theta / ds [rad/m]", _JUMP * turning)


def _require_small(defect: Array, s: Array, what: str, bound: float) -> None:
    bad = ~(defect <= bound)
    if bad.any():
        k = int(np.argmax(np.where(np.isnan(defect), np.inf, defect)))
        raise RoughPath(float(s[k]), what, float(defect[k]), bound)
