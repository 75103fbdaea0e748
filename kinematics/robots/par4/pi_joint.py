"""The pi joint: how far Par4's parallelogram of bars is from being flat."""

from __future__ import annotations

import casadi as ca

from kinematics.model import Margin, Measure, Mechanism


class PiJoint(Margin):
    """cos psi, psi the bars' angle: 0 where the parallelogram, a rectangle at theta = 0, may fold the other way."""

    name = "pi_joint"
    words = "cosine of the angle of the bars from the middle"
    holds_on_paths = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One."""
        model = robot.model()
        result: ca.SX = ca.cos(model.pose[3] / model.g.amplification)
        return result


PI_JOINT = PiJoint()
