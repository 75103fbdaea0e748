"""Proper acceleration: what it takes to move 1 kg and to hold it, for places as expressions of joints and pose."""

from __future__ import annotations

import casadi as ca

from kinematics.dynamics.chain_rule import derivatives_along
from kinematics.dynamics.drive_torque import GRAVITY
from kinematics.model import Mechanism

_E_Z = ca.DM([0, 0, 1])


class ProperAcceleration:
    """The acceleration of points along a motion, and the weight of 1 kg upward.

    Attributes:
        variable: joints and pose.
        rates: their velocities, and their accelerations.
    """

    def __init__(self, robot: Mechanism, velocity: ca.SX, acceleration: ca.SX) -> None:
        model = self._model = robot.model()
        m = model.joints.numel()
        self._joint_rates = [ca.SX.sym(name, m) for name in ("joint_velocity", "joint_acceleration")]
        given = zip(self._joint_rates, (velocity, acceleration), strict=True)
        self.rates = [ca.vertcat(q, x) for q, x in given]
        self._motion = derivatives_along(model.inverse, model.pose, [velocity, acceleration])[1:]
        self.variable = ca.vertcat(model.joints, model.pose)

    def __call__(self, point: ca.SX) -> ca.SX:
        """(3,) of a point (3,) of joints and pose."""
        result: ca.SX = self.second(point) + GRAVITY * _E_Z
        return result

    def second(self, place: ca.SX) -> ca.SX:
        """The second time derivative of a point or an angle."""
        return derivatives_along(place, self.variable, self.rates)[2]

    def at_pose(self, expression: ca.SX) -> ca.SX:
        """Without joints and their rates."""
        found = self._model.at_pose(expression)
        return ca.substitute(found, ca.vertcat(*self._joint_rates), ca.vertcat(*self._motion))
