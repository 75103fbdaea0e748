"""Mass: the sum of all masses that move."""

from __future__ import annotations

import casadi as ca

from kinematics.model import Margin, Measure, Mechanism


class Mass(Margin):
    """Of particles and rods without a payload [kg]; the same at every pose. Inertia seen at a drive is no mass."""

    name = "mass"
    sense = -1
    lowest = 0.0
    records = ("inertia", "structure")
    unit = "kg"
    words = "mass of all moving bodies, without a payload"

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One."""
        model = robot.model()
        bodies = robot.bodies(model.pose, model.joints, model.g, 0.0)
        return ca.SX(sum(p.mass for p in bodies.particles) + sum(rod.mass for rod in bodies.rods))


MASS = Mass()
