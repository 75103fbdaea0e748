"""Ranges of the joints' positions."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics import Mechanism
from trajectory.limits.model import Along, InstantLimit, LimitValues, Place, RangeField, SymbolicMotion, Use
from trajectory.motions import Motion


class JointRanges(InstantLimit):
    """low <= q <= high. Only the way decides whether it is kept, not the pace."""

    name = "joint position"
    fields = (
        RangeField(
            "position",
            "The ranges of the joints. Only the path decides whether they are kept.",
            "low < high, or one such pair a joint (rad, or m)",
            "rad or m",
        ),
    )
    kind = Place
    pace_power = 0

    def use(self, robot: Mechanism, motion: Motion, limits: LimitValues, slack: Motion) -> Use | None:  # noqa: ARG002
        """The distance from the middle of the range over half of the range; the limit is the nearer end."""
        position = motion.joints.position
        if (ranges := limits.ranges(position.shape[-1])) is None:
            return None
        middle, half = (ranges[1] + ranges[0]) / 2, (ranges[1] - ranges[0]) / 2
        away = position - middle
        return Use(position, middle + np.copysign(half, away), (np.abs(away) + slack.joints.position) / half)

    def constraint(self, along: Along, limits: LimitValues) -> Place:  # noqa: ARG002
        """Nothing of the pace."""
        return Place()

    def symbolic(self, motion: SymbolicMotion, limits: LimitValues) -> ca.SX:
        """From -1 at the lowest position to 1 at the highest."""
        position = motion.joints[0]
        ranges = limits.ranges(position.numel())
        assert ranges is not None
        low, high = (ca.DM(end) for end in ranges)
        return (2 * position - (low + high)) / (high - low)


JOINT_RANGES = JointRanges()
