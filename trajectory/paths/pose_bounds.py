"""Where the poses of a motion may be: inside a box, and with x and y inside a circle about the z axis.

Such a set is convex, and a cubic is inside the hull of its four Bezier points: a motion that is cubic in time is inside
at every instant where these points are.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca
import numpy as np

from kinematics import Array

EDGE = 1e-7  # rad, or of the largest length, by which a solver may leave it: even a single value has an interior


@dataclass(frozen=True)
class PoseBounds:
    """Bounds of the poses.

    Attributes:
        low, high: (n,) of each coordinate [m or rad].
        places: how many of the coordinates are lengths; these stand first.
        radius: of the circle about the z axis [m]; infinite without one.
    """

    low: tuple[float, ...]
    high: tuple[float, ...]
    places: int
    radius: float = math.inf

    def box(self) -> tuple[Array, Array]:
        """(n,) bounds of each coordinate, the edge included."""
        edge = np.full(len(self.low), EDGE)
        edge[: self.places] *= self._length
        return np.array(self.low) - edge, np.array(self.high) + edge

    @property
    def _length(self) -> float:
        """The largest distance of a finite bound from 0 [m]."""
        bounds = np.abs([self.low[: self.places], self.high[: self.places]])
        return float(bounds[np.isfinite(bounds)].max(initial=0.0))

    def rows(self, points: Sequence[ca.SX]) -> tuple[ca.SX, Array, Array]:
        """Expressions that have to be between two bounds for the Bezier points (4, n) of a cubic to be inside.

        The two outer ones are kept in the box as variables; the last is the next cubic's first.
        """
        first, second, third, _ = points
        low, high = self.box()
        inner = ca.vertcat(second, third)
        if not math.isfinite(self.radius):
            return inner, np.tile(low, 2), np.tile(high, 2)
        circle = [ca.sumsqr(point[:2]) / (self.radius + EDGE * self._length) ** 2 for point in (first, second, third)]
        least, most = np.full(3, -np.inf), np.ones(3)
        return ca.vertcat(inner, *circle), np.append(np.tile(low, 2), least), np.append(np.tile(high, 2), most)


def bezier_points(start: Sequence[ca.SX], lasting: float) -> list[ca.SX]:
    """Of a cubic from its value and its three derivatives where it starts."""
    p, v, a, j = start
    h = lasting
    return [p, p + h * v / 3, p + h * (2 * v + h * a / 2) / 3, p + h * (v + h * (a / 2 + h * j / 6))]
