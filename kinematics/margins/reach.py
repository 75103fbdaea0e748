"""Reach: how far each limb is from not reaching."""

from __future__ import annotations

import casadi as ca

from kinematics.model import Margin, Measure, Mechanism


class Reach(Margin):
    """Of each limb [m]; negative where it cannot reach."""

    name = "reach"
    unit = "m"
    words = "how far the worst limb is from not reaching"
    holds_on_paths = True
    beyond_reach = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One a limb."""
        model = robot.model()
        return robot.reach(model.pose, model.g)

    def limbs(self, robot: Mechanism) -> list[int]:
        """In order."""
        model = robot.model()
        return [i + 1 for i in range(robot.reach(model.pose, model.g).numel())]


REACH = Reach()
