"""Peak torque of the drives."""

from __future__ import annotations

from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from kinematics import Array, Mechanism
from trajectory.limits.constraints import Along, Linear, torque_over
from trajectory.limits.field import JointField
from trajectory.limits.limit import InstantLimit, SymbolicMotion, Use, against
from trajectory.limits.over_intervals import IntervalRows, OverIntervals
from trajectory.limits.stretch import Sampled, stretch_of_sum
from trajectory.motions import Motion

if TYPE_CHECKING:
    from trajectory.limits.limits import Limits


class PeakTorque(InstantLimit):
    """|tau| <= limit."""

    name = "torque"
    fields = (JointField("torque", "Peak of the drives.", "a number > 0, or one a joint (N m, or N)", "N m or N"),)
    kind = Linear
    power = 2
    of_torque = True

    def use(self, robot: Mechanism, motion: Motion, limits: Limits, slack: Motion) -> Use:  # noqa: ARG002
        """The torque itself."""
        torque = np.abs(motion.torque) + slack.torque
        return against(torque, limits.of_joints("torque", torque.shape[-1]))

    def least_stretch(self, peak: float, motion: Sampled, limits: Limits) -> float:  # noqa: ARG002
        """By what the torque is at another rate: it keeps what it needs at rest."""
        limit = limits.set_of_joints("torque", motion.torque.constant.shape[-1])
        return stretch_of_sum(self.name, motion.torque, limit, 0.0)

    def holding_torque(self, limits: Limits, count: int) -> Array | None:
        """All of it."""
        return limits.of_joints("torque", count)

    def constraint(self, along: Along, limits: Limits) -> Linear:
        """Over the limit."""
        limit = limits.set_of_joints("torque", along.joints.first.shape[-1])
        return Linear(*torque_over(limit, along.torque))

    def rows_over_intervals(self, over: OverIntervals, limits: Limits) -> IntervalRows | None:
        """Over the limit."""
        limit = limits.of_joints("torque", over.acceleration.a.shape[1])
        return None if limit is None else over.torque.over(limit)

    def symbolic(self, motion: SymbolicMotion, limits: Limits) -> ca.SX:
        """Over the limit."""
        return motion.torque / ca.DM(limits.set_of_joints("torque", motion.torque.numel()))


PEAK_TORQUE = PeakTorque()
