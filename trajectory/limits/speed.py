"""Speed of the joints."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics import Array, Mechanism
from trajectory.limits.model import (
    SPEED_UNIT,
    Along,
    Cap,
    InstantLimit,
    JointField,
    LimitValues,
    SlopesOverIntervals,
    SymbolicMotion,
    Use,
    against,
)
from trajectory.motions import Motion


class JointSpeed(InstantLimit):
    """Of the actuators: |q'| <= limit."""

    name = "joint speed"
    fields = (
        JointField(
            "speed", "The largest speed of the joints.", "a speed > 0, or one a joint", SPEED_UNIT, required=True
        ),
    )
    kind = Cap
    pace_power = 1

    def use(self, robot: Mechanism, motion: Motion, limits: LimitValues, slack: Motion) -> Use:  # noqa: ARG002
        """The speed itself."""
        speed = np.abs(motion.joints.first) + slack.joints.first
        return against(speed, limits.of_joints("speed", speed.shape[-1]))

    def constraint(self, along: Along, limits: LimitValues) -> Cap:
        """q' = dq sqrt(x)."""
        slopes = along.joints.first
        with np.errstate(divide="ignore"):
            return Cap((np.abs(slopes) / limits.set_of_joints("speed", slopes.shape[-1])).max(axis=-1) ** -2.0)

    def highest_over_intervals(self, slopes: SlopesOverIntervals, limits: LimitValues) -> Array:
        """Where the slopes are least."""
        with np.errstate(divide="ignore"):
            found: Array = (slopes.joints / limits.set_of_joints("speed", slopes.joints.shape[1])).max(axis=-1) ** -2.0
        return found

    def symbolic(self, motion: SymbolicMotion, limits: LimitValues) -> ca.SX:
        """Over the limit."""
        speed = motion.joints[1]
        return speed / ca.DM(limits.set_of_joints("speed", speed.numel()))


JOINT_SPEED = JointSpeed()
