"""What the study of Heli4 asks, with the requirements that its paper speaks of."""

from __future__ import annotations

import math

from design import Bounds, Cylinder, Problem, Requirement, SumLimit
from kinematics import Heli4

ROOM = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-math.pi, math.pi))
VARIABLES = {
    "base_radius": (0.20, 0.45),
    "platform_radius": (0.03, 0.08),
    "arm_length": (0.25, 0.50),
    "rod_length": (0.60, 1.00),
    "plate_offset": (0.02, 0.08),
    "pitch": (0.02, 0.12),
}
PROBLEM = Problem(
    robot=Heli4(),
    objective="fvi",
    variables=tuple(Bounds(name, 0, low, high) for name, (low, high) in VARIABLES.items()),
    requirements=(Requirement("reach", 0.01), Requirement("J_q", 0.3), Requirement("internal_determinant", 0.4)),
    sums=(SumLimit(("arm_length", "rod_length"), 1.151),),
    fvi_bounds=Heli4.fvi_bounds,
    characteristic_length=Heli4().characteristic_length,
)
