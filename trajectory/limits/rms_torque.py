"""Root mean square of the torque: the torque that a drive can give for a long time without overheating."""

from __future__ import annotations

import casadi as ca

from kinematics import Array
from trajectory.limits.model import (
    Along,
    JointField,
    LimitValues,
    MeanSquareLimit,
    Sampled,
    Squared,
    SymbolicMotion,
    stretch_of_mean_square,
)
from trajectory.motions import ByRate, Motion


class RmsTorque(MeanSquareLimit):
    """The RMS torque over each way from rest to rest, and so over the whole cycle."""

    name = "rms torque"
    fields = (
        JointField(
            "rms_torque",
            "The largest root mean square of the torque on each way, and so in the cycle. `toppra` refuses it.",
            "a number > 0, or one a joint (N m, or N)",
            "N m or N",
        ),
    )
    kind = Squared
    pace_power = 2
    of_torque = True

    def quantity(self, motion: Motion) -> Array:
        """The torque."""
        return motion.torque

    def excess(self, slack: Motion, mean_torque: Array) -> tuple[Array, Array]:
        """The torque's own."""
        return slack.torque, mean_torque

    def most(self, limits: LimitValues, count: int) -> Array | None:
        """The limit."""
        return limits.of_joints("rms_torque", count)

    def least_stretch(self, peak: float, motion: Sampled, limits: LimitValues) -> float:  # noqa: ARG002
        """The largest of all drives."""
        torque = motion.torque
        most = limits.set_of_joints("rms_torque", torque.constant.shape[-1])
        drives = [ByRate(*(part[..., k] for part in torque)) for k in range(most.size)]
        factors = [
            stretch_of_mean_square(self.name, drive, float(limit), motion.mean)
            for drive, limit in zip(drives, most, strict=True)
        ]
        return max(factors)

    def holding_torque(self, limits: LimitValues, count: int) -> Array | None:
        """In the mean."""
        return self.most(limits, count)

    def constraint(self, along: Along, limits: LimitValues) -> Squared:
        """Over the limit, with all friction."""
        t = along.torque
        limit = limits.set_of_joints("rms_torque", t.inertia.shape[-1])
        return Squared(t.inertia / limit, t.square / limit, t.viscous / limit, t.whole / limit)

    def symbolic(self, motion: SymbolicMotion, limits: LimitValues) -> ca.SX:
        """Over the limit."""
        return motion.torque / ca.DM(limits.set_of_joints("rms_torque", motion.torque.numel()))


RMS_TORQUE = RmsTorque()
