"""Acceleration of the joints."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics import Mechanism
from trajectory.limits.model import (
    Along,
    InstantLimit,
    IntervalRows,
    JointField,
    LimitValues,
    Linear,
    OverIntervals,
    SymbolicMotion,
    Use,
    against,
)
from trajectory.motions import Motion


class JointAcceleration(InstantLimit):
    """Of the actuators: |q''| <= limit."""

    name = "joint acceleration"
    fields = (
        JointField(
            "acceleration",
            "The largest acceleration of the joints.",
            "a number > 0, or one a joint (rad/s^2, or m/s^2)",
            "rad/s^2 or m/s^2",
        ),
    )
    kind = Linear
    pace_power = 2

    def use(self, robot: Mechanism, motion: Motion, limits: LimitValues, slack: Motion) -> Use:  # noqa: ARG002
        """The acceleration itself."""
        acceleration = np.abs(motion.joints.second) + slack.joints.second
        return against(acceleration, limits.of_joints("acceleration", acceleration.shape[-1]))

    def constraint(self, along: Along, limits: LimitValues) -> Linear:
        """q'' = dq u + ddq x."""
        _, first, second, _ = along.joints
        limit, none = limits.set_of_joints("acceleration", first.shape[-1]), np.zeros_like(first)
        return Linear(first / limit, second / limit, none, none, none)

    def rows_over_intervals(self, over: OverIntervals, limits: LimitValues) -> IntervalRows | None:
        """Over the limit."""
        limit = limits.of_joints("acceleration", over.acceleration.a.shape[1])
        return None if limit is None else over.acceleration.over(limit)

    def symbolic(self, motion: SymbolicMotion, limits: LimitValues) -> ca.SX:
        """Over the limit."""
        acceleration = motion.joints[2]
        return acceleration / ca.DM(limits.set_of_joints("acceleration", acceleration.numel()))


JOINT_ACCELERATION = JointAcceleration()
