"""The clearance arch of a pick-and-place cycle: the tool must stay outside it when its path is free.

The arch is between the verticals at pick and place, below the line from one lift to the other. Each corner is rounded
by a superellipse. Let a and b be the distances from the two sides of a corner, over the blend, counted outward from the
inner end of the corner. The tool is outside where max(a, 0)^k + max(b, 0)^k >= 1. It must also stay above the height of
the nearer end.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import casadi as ca
import numpy as np

from kinematics import Array
from trajectory.errors import UnsuitedPath
from trajectory.paths.adept import AdeptCycle
from trajectory.paths.path import Path, Reversed

EXPONENT = 3.0
TOLERANCE = 4e-4  # times the blend, as a cycle starts exactly on the side of the arch


@dataclass(frozen=True)
class Arch:
    """The arch of a cycle.

    Attributes:
        cycle: its pick, place, lifts and blend.
        exponent: k of the corners; 2 is a circle, more is closer to the square corner.
    """

    cycle: AdeptCycle
    exponent: float = EXPONENT

    @classmethod
    def of(cls, path: Path) -> Arch:
        """The arch of a cycle or of its way back.

        Raises:
            UnsuitedPath: the path is of another kind, and so has no arch.
        """
        cycle = path.path if isinstance(path, Reversed) else path
        if not isinstance(cycle, AdeptCycle):
            raise UnsuitedPath("free", "another path", "an Adept cycle, as its arch decides where the tool may go")
        return cls(cycle)

    def sides(self, x: ca.SX, y: ca.SX, z: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
        """How far the tool point is from the sides of the corners, over the blend: pick, place, top; and the floor."""
        cycle = self.cycle
        along = (x - cycle.pick[0]) * math.cos(cycle.heading) + (y - cycle.pick[1]) * math.sin(cycle.heading)
        height = z - cycle.pick[2]
        rise = cycle.rise + cycle.down - cycle.lift  # of the top line
        stretch = math.hypot(cycle.span, rise) / cycle.span
        below = cycle.lift + rise * along / cycle.span - height
        floor = height - cycle.rise * ca.fmin(ca.fmax(along / cycle.span, 0.0), 1.0)
        blend = cycle.blend
        return 1 - stretch * along / blend, 1 - stretch * (cycle.span - along) / blend, 1 - below / blend, floor / blend

    def outside(self, pick: ca.SX, place: ca.SX, top: ca.SX) -> ca.SX:
        """At least 1 outside the arch; the two corners never count together."""
        return ca.sum1(ca.fmax(ca.vertcat(pick, place, top), 0.0) ** self.exponent)

    def kept_clear(self, tool: Array, slack: Array) -> bool:
        """Whether the tool stays out of the arch and above the floor, but for `TOLERANCE`.

        Args:
            tool: (k, 3) tool points [m].
            slack: (k, 3) how far from them it may be [m].
        """
        point = ca.SX.sym("point", 3)
        sides = ca.vertcat(*self.sides(point[0], point[1], point[2]))
        function = ca.Function("sides", [point], [sides, ca.jacobian(sides, point)])
        # The sides are piecewise linear, and steepest between pick and place, where the floor's own slope counts.
        steepest = np.abs(np.array(function((np.array(self.cycle.pick) + np.array(self.cycle.place)) / 2)[1]))
        least = np.array(function.map(len(tool))(tool.T)[0]) - steepest @ slack.T + TOLERANCE
        outside = (np.maximum(least[:3], 0.0) ** self.exponent).sum(axis=0)
        return bool((outside >= 1.0).all() and (least[3] >= 0.0).all())
