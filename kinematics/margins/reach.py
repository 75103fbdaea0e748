"""Reach: the distance of each limb from the end of its reach."""

from __future__ import annotations

import casadi as ca

from kinematics.model import Margin, Measure, Mechanism


class Reach(Margin):
    """Distance of each limb from the end of its reach [m]; negative if it cannot reach."""

    name = "reach"
    unit = "m"
    words = "distance of the worst limb from the end of its reach"
    holds_on_paths = True
    beyond_reach = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One component for each limb."""
        model = robot.model()
        return robot.reach(model.pose, model.g)

    def places(self, robot: Mechanism) -> list[str]:
        """The limbs in order."""
        model = robot.model()
        return [f"limb {i + 1}" for i in range(robot.reach(model.pose, model.g).numel())]


REACH = Reach()
