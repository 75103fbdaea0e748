"""Strength: how many times the load of its members a robot could bear before one of them buckles or yields."""

from __future__ import annotations

import math

import casadi as ca

from kinematics.dynamics import WorstDirection, case_at_rest, safety_factors
from kinematics.model import Margin, Measure, Mechanism


class Strength(Margin):
    """The smallest safety factor of all members; 1 is the limit.

    The load is `robot.load`: its payload, accelerated by its acceleration in the worst direction, from rest, and the
    weights. It is infinite for a mechanism without the hook `statics`.
    """

    name = "strength"
    words = "smallest safety factor of the members against buckling and yield, under the robot's load"

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """Of each rod, buckling and yield; of each cut of an arm, yield."""
        size = WorstDirection(robot.load.acceleration)
        case = case_at_rest(robot)
        factors = [f for load in case.loads(case.shared()) for f in safety_factors(load, size).values()]
        return ca.vertcat(*factors) if factors else ca.SX(math.inf)

    def places(self, robot: Mechanism) -> list[str]:
        """The member of each component, and by what it fails."""
        size = WorstDirection(robot.load.acceleration)
        return [f"{own.member}, {what}" for own in case_at_rest(robot).bearers for what in safety_factors(own, size)]


STRENGTH = Strength()
