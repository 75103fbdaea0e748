"""The drives' speed-torque line: the faster a drive turns, the less torque it has."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics import Array, Mechanism
from trajectory.limits.model import (
    SPEED_UNIT,
    Along,
    InstantLimit,
    JointField,
    LimitValues,
    Sampled,
    Sloped,
    SymbolicMotion,
    Use,
    stretch_of_sum,
    torque_over,
)
from trajectory.motions import Motion


class SpeedTorqueLine(InstantLimit):
    """|tau| <= stall_torque (1 - |q'| / no_load_speed)."""

    name = "torque at speed"
    fields = (
        JointField(
            "stall_torque",
            "The torque at rest: abs(torque) <= stall_torque (1 - abs(speed) / no_load_speed).",
            "a number > 0, or one a joint (N m, or N)",
            "N m or N",
        ),
        JointField(
            "no_load_speed",
            "The speed at which no torque is left. Give it together with stall_torque.",
            "a speed > 0, or one a joint; only together with stall_torque",
            SPEED_UNIT,
        ),
    )
    both = "both ends of the speed-torque line, or neither"
    kind = Sloped
    pace_power = 2
    of_torque = True

    def use(self, robot: Mechanism, motion: Motion, limits: LimitValues, slack: Motion) -> Use | None:  # noqa: ARG002
        """|tau| / stall_torque + |q'| / no_load_speed."""
        if not self.is_set(limits):
            return None
        torque = np.abs(motion.torque) + slack.torque
        stall, fastest = self._ends(limits, torque.shape[-1])
        share = (np.abs(motion.joints.first) + slack.joints.first) / fastest
        return Use(torque, stall * (1.0 - share), torque / stall + share)

    def least_stretch(self, peak: float, motion: Sampled, limits: LimitValues) -> float:  # noqa: ARG002
        """As of the torque, with the speed beside it."""
        speed = np.abs(motion.joints.first)
        stall, fastest = self._ends(limits, speed.shape[-1])
        return stretch_of_sum(self.name, motion.torque, stall, stall / fastest * speed)

    def holding_torque(self, limits: LimitValues, count: int) -> Array | None:
        """At stall."""
        return limits.of_joints("stall_torque", count)

    def constraint(self, along: Along, limits: LimitValues) -> Sloped:
        """|q'| = |dq| sqrt(x)."""
        slopes = np.abs(along.joints.first)
        stall, fastest = self._ends(limits, slopes.shape[-1])
        return Sloped(*torque_over(stall, along.torque), slopes / fastest)

    def symbolic(self, motion: SymbolicMotion, limits: LimitValues) -> ca.SX:
        """|tau| <= t - s and |s| <= t where t - s >= |tau| and t + s >= |tau|, whatever the signs."""
        stall, fastest = self._ends(limits, motion.torque.numel())
        torque, share = motion.torque / ca.DM(stall), motion.joints[1] / ca.DM(fastest)
        return ca.vertcat(torque + share, torque - share)

    @staticmethod
    def _ends(limits: LimitValues, count: int) -> tuple[Array, Array]:
        """(count,) stall torques and no-load speeds."""
        return limits.set_of_joints("stall_torque", count), limits.set_of_joints("no_load_speed", count)


SPEED_TORQUE_LINE = SpeedTorqueLine()
