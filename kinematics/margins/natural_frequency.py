"""Natural frequency: how slowly the platform with its payload swings on locked drives."""

from __future__ import annotations

import casadi as ca

from kinematics.dynamics import mass_matrix_symbolic, stiffness_parts
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
    words = "smallest natural frequency on locked drives, with the payload of the load"

    def pencil(self, robot: Mechanism) -> Pencil | None:
        """Stiffness against mass."""
        parts = stiffness_parts(robot)
        if not parts:
            return None
        n, freedoms = len(robot.pose_names), parts[0][0].shape[0]
        order = [*range(n, freedoms), *range(n)]
        moved = [(wrenches[order, :], inner) for wrenches, inner in parts]
        return Pencil(moved, mass_matrix_symbolic(robot, robot.load.payload))

    def eigenvalue(self, bound: ca.SX) -> ca.SX:
        """(2 pi f)^2."""
        return (TURN * bound) ** 2

    def of_eigenvalue(self, value: ca.SX) -> ca.SX:
        """Of omega^2."""
        return ca.sqrt(value) / TURN


NATURAL_FREQUENCY = NaturalFrequency()
