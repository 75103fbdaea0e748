"""Speed of the joints."""

from __future__ import annotations

from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from kinematics import Array, Mechanism
from trajectory.limits.constraints import Along, Cap
from trajectory.limits.field import SPEED_UNIT, JointField
from trajectory.limits.limit import InstantLimit, SymbolicMotion, Use, against
from trajectory.limits.over_intervals import SlopesOverIntervals
from trajectory.motions import Motion

if TYPE_CHECKING:
    from trajectory.limits.limits import Limits


class JointSpeed(InstantLimit):
    """Of the actuators: |q'| <= limit."""

    name = "joint speed"
    fields = (JointField("speed", "Of the joints.", "a speed > 0, or one a joint", SPEED_UNIT, required=True),)
    kind = Cap
    power = 1

    def use(self, robot: Mechanism, motion: Motion, limits: Limits, slack: Motion) -> Use:  # noqa: ARG002
        """The speed itself."""
        speed = np.abs(motion.joints.first) + slack.joints.first
        return against(speed, limits.of_joints("speed", speed.shape[-1]))

    def constraint(self, along: Along, limits: Limits) -> Cap:
        """q' = dq sqrt(x)."""
        slopes = along.joints.first
        with np.errstate(divide="ignore"):
            return Cap((np.abs(slopes) / limits.set_of_joints("speed", slopes.shape[-1])).max(axis=-1) ** -2.0)

    def highest_over_intervals(self, slopes: SlopesOverIntervals, limits: Limits) -> Array:
        """Where the slopes are least."""
        with np.errstate(divide="ignore"):
            found: Array = (slopes.joints / limits.set_of_joints("speed", slopes.joints.shape[1])).max(axis=-1) ** -2.0
        return found

    def symbolic(self, motion: SymbolicMotion, limits: Limits) -> ca.SX:
        """Over the limit."""
        speed = motion.joints[1]
        return speed / ca.DM(limits.set_of_joints("speed", speed.numel()))


JOINT_SPEED = JointSpeed()
