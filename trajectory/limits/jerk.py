"""Jerk of the joints."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics import Mechanism
from trajectory.limits.model import Along, InstantLimit, JointField, LimitValues, SymbolicMotion, Third, Use, against
from trajectory.motions import Motion


class JointJerk(InstantLimit):
    """Of the actuators: |q'''| <= limit."""

    name = "joint jerk"
    fields = (
        JointField(
            "jerk",
            "The largest jerk of the joints. The law `jerk` needs it; `toppra` does not keep it.",
            "a number > 0, or one a joint (rad/s^3, or m/s^3)",
            "rad/s^3 or m/s^3",
        ),
    )
    kind = Third
    pace_power = 3
    jumps = True

    def use(self, robot: Mechanism, motion: Motion, limits: LimitValues, slack: Motion) -> Use:  # noqa: ARG002
        """The jerk itself."""
        jerk = np.abs(motion.joints.third) + slack.joints.third
        return against(jerk, limits.of_joints("jerk", jerk.shape[-1]))

    def constraint(self, along: Along, limits: LimitValues) -> Third:
        """q''' = sqrt(x) (dq z + 3 ddq u + dddq x)."""
        _, first, second, third = along.joints
        limit = limits.set_of_joints("jerk", first.shape[-1])
        return Third(first / limit, 3.0 * second / limit, third / limit)

    def symbolic(self, motion: SymbolicMotion, limits: LimitValues) -> ca.SX:
        """Over the limit."""
        jerk = motion.joints[3]
        return jerk / ca.DM(limits.set_of_joints("jerk", jerk.numel()))


JOINT_JERK = JointJerk()
