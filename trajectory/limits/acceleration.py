"""Acceleration of the joints."""

from __future__ import annotations

from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from kinematics import Mechanism
from trajectory.limits.constraints import Along, Linear
from trajectory.limits.field import JointField
from trajectory.limits.limit import InstantLimit, SymbolicMotion, Use, against
from trajectory.limits.over_intervals import IntervalRows, OverIntervals
from trajectory.motions import Motion

if TYPE_CHECKING:
    from trajectory.limits.limits import Limits


class JointAcceleration(InstantLimit):
    """Of the actuators: |q''| <= limit."""

    name = "joint acceleration"
    fields = (
        JointField(
            "acceleration", "Of the joints.", "a number > 0, or one a joint (rad/s^2, or m/s^2)", "rad/s^2 or m/s^2"
        ),
    )
    kind = Linear
    power = 2

    def use(self, robot: Mechanism, motion: Motion, limits: Limits, slack: Motion) -> Use:  # noqa: ARG002
        """The acceleration itself."""
        acceleration = np.abs(motion.joints.second) + slack.joints.second
        return against(acceleration, limits.of_joints("acceleration", acceleration.shape[-1]))

    def constraint(self, along: Along, limits: Limits) -> Linear:
        """q'' = dq u + ddq x."""
        _, first, second, _ = along.joints
        limit, none = limits.set_of_joints("acceleration", first.shape[-1]), np.zeros_like(first)
        return Linear(first / limit, second / limit, none, none, none)

    def rows_over_intervals(self, over: OverIntervals, limits: Limits) -> IntervalRows | None:
        """Over the limit."""
        limit = limits.of_joints("acceleration", over.acceleration.a.shape[1])
        return None if limit is None else over.acceleration.over(limit)

    def symbolic(self, motion: SymbolicMotion, limits: Limits) -> ca.SX:
        """Over the limit."""
        acceleration = motion.joints[2]
        return acceleration / ca.DM(limits.set_of_joints("acceleration", acceleration.numel()))


JOINT_ACCELERATION = JointAcceleration()
