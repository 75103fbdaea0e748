"""Ranges of the joints' positions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from kinematics import Array, Mechanism
from trajectory.limits.constraints import Along, Place
from trajectory.limits.field import RangeField
from trajectory.limits.limit import InstantLimit, SymbolicMotion, Use
from trajectory.motions import Motion

if TYPE_CHECKING:
    from trajectory.limits.limits import Limits


class JointRanges(InstantLimit):
    """low <= q <= high; the way alone decides whether it is kept."""

    name = "joint position"
    fields = (
        RangeField(
            "position",
            "Of the joints; the path alone decides whether it is kept.",
            "low < high, or one such pair a joint (rad, or m)",
            "rad or m",
        ),
    )
    kind = Place
    power = 0

    def use(self, robot: Mechanism, motion: Motion, limits: Limits, slack: Motion) -> Use | None:  # noqa: ARG002
        """The distance from the middle of the range over half of the range; the limit is the nearer end."""
        position = motion.joints.position
        if not self.is_set(limits):
            return None
        middle, half = self._middles(limits, position.shape[-1])
        away = position - middle
        return Use(position, middle + np.copysign(half, away), (np.abs(away) + slack.joints.position) / half)

    def constraint(self, along: Along, limits: Limits) -> Place:  # noqa: ARG002
        """Nothing of the pace."""
        return Place()

    def symbolic(self, motion: SymbolicMotion, limits: Limits) -> ca.SX:
        """As in `use`, with its sign."""
        position = motion.joints[0]
        middle, half = self._middles(limits, position.numel())
        return (position - ca.DM(middle)) / ca.DM(half)

    @staticmethod
    def _middles(limits: Limits, count: int) -> tuple[Array, Array]:
        """(count,) middles and half widths."""
        ranges = limits.ranges(count)
        assert ranges is not None
        return (ranges[1] + ranges[0]) / 2, (ranges[1] - ranges[0]) / 2


JOINT_RANGES = JointRanges()
