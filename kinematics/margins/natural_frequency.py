"""Natural frequency: how slowly the platform with its payload swings on locked drives."""

from __future__ import annotations

import casadi as ca

from kinematics.dynamics import mass_matrix_symbolic, transmission_at_pose
from kinematics.machine import TURN
from kinematics.margins.stiffness import Pencil, WeakestDirection
from kinematics.model import Mechanism


class NaturalFrequency(WeakestDirection):
    """The smallest sqrt(x) / (2 pi) with det(K - x M) = 0, for the payload of `load`.

    M is the mass matrix of the motion with rigid members: it lets every mass swing that the tool moves, motors too.
    Freedoms that the pose does not have, such as tilts, follow without mass.
    """

    name = "natural_frequency"
    unit = "Hz"
    records = ("inertia", "structure", "load")
    words = "smallest natural frequency on locked drives, with the payload of the load"

    def pencil(self, robot: Mechanism) -> Pencil | None:
        """Stiffness against mass."""
        found = transmission_at_pose(robot)
        if found is None:
            return None
        wrenches, compliance = found
        n = len(robot.pose_names)
        order = [*range(n, wrenches.shape[0]), *range(n)]
        return Pencil(wrenches[order, :], compliance, mass_matrix_symbolic(robot, robot.load.payload))

    def eigenvalue(self, bound: ca.SX) -> ca.SX:
        """(2 pi f)^2."""
        return (TURN * bound) ** 2

    def of_eigenvalue(self, value: ca.SX) -> ca.SX:
        """Of omega^2."""
        return ca.sqrt(value) / TURN


NATURAL_FREQUENCY = NaturalFrequency()
