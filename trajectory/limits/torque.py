"""Peak torque of the drives."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics import Array, Mechanism
from trajectory.limits.model import (
    Along,
    InstantLimit,
    IntervalRows,
    JointField,
    LimitValues,
    Linear,
    OverIntervals,
    Sampled,
    SymbolicMotion,
    Use,
    against,
    stretch_of_sum,
    torque_over,
)
from trajectory.motions import Motion


class PeakTorque(InstantLimit):
    """|tau| <= limit."""

    name = "torque"
    fields = (
        JointField("torque", "The peak torque of the drives.", "a number > 0, or one a joint (N m, or N)", "N m or N"),
    )
    kind = Linear
    pace_power = 2
    of_torque = True

    def use(self, robot: Mechanism, motion: Motion, limits: LimitValues, slack: Motion) -> Use:  # noqa: ARG002
        """The torque itself."""
        torque = np.abs(motion.torque) + slack.torque
        return against(torque, limits.of_joints("torque", torque.shape[-1]))

    def least_stretch(self, peak: float, motion: Sampled, limits: LimitValues) -> float:  # noqa: ARG002
        """By what the torque is at another rate: it keeps what it needs at rest."""
        limit = limits.set_of_joints("torque", motion.torque.constant.shape[-1])
        return stretch_of_sum(self.name, motion.torque, limit, 0.0)

    def holding_torque(self, limits: LimitValues, count: int) -> Array | None:
        """All of it."""
        return limits.of_joints("torque", count)

    def constraint(self, along: Along, limits: LimitValues) -> Linear:
        """Over the limit."""
        limit = limits.set_of_joints("torque", along.joints.first.shape[-1])
        return Linear(*torque_over(limit, along.torque))

    def rows_over_intervals(self, over: OverIntervals, limits: LimitValues) -> IntervalRows | None:
        """Over the limit."""
        limit = limits.of_joints("torque", over.acceleration.a.shape[1])
        return None if limit is None else over.torque.over(limit)

    def symbolic(self, motion: SymbolicMotion, limits: LimitValues) -> ca.SX:
        """Over the limit."""
        return motion.torque / ca.DM(limits.set_of_joints("torque", motion.torque.numel()))


PEAK_TORQUE = PeakTorque()
