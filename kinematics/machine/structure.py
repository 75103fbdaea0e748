"""What a mechanism's bodies are made of, and how its joints give way."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from kinematics.errors import InvalidField
from kinematics.machine.geometry_record import numbers_of
from kinematics.machine.materials import MATERIALS, Material
from kinematics.machine.members import Member


@dataclass(frozen=True)
class Structure:
    """Materials of the kinds of members, and the joints between them. A mechanism uses the kinds that it has.

    Attributes:
        arm, rod, leg, link, plate, screw: the material of each kind.
        joint_stiffness: of each joint at a rod's end, along the rod [N/m]; inf for a joint that does not give way.
        joint_play: how far each joint at a rod's end lets the rod slip along itself [m], from one end to the other.
            With a joint at each end the rod acts as one whose length is off by at most so much to either side.

    Raises:
        InvalidValue: it names the field.
    """

    arm: Material = MATERIALS["aluminium"]
    rod: Material = MATERIALS["carbon tube"]
    leg: Material = MATERIALS["steel"]
    link: Material = MATERIALS["aluminium"]
    plate: Material = MATERIALS["aluminium"]
    screw: Material = MATERIALS["steel"]
    joint_stiffness: float = float("inf")
    joint_play: float = 0.0

    def of(self, member: Member) -> Material:
        """The material of a member."""
        material: Material = getattr(self, member.material)
        return material

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            if f.name not in ("joint_stiffness", "joint_play"):
                if not isinstance(value, Material):
                    raise InvalidField("Structure", f.name, value, "a Material")
                continue
            number, stiff = numbers_of(value), f.name == "joint_stiffness"
            if number is None or number.ndim or not (number > 0.0 if stiff else 0.0 <= number < np.inf):
                raise InvalidField("Structure", f.name, value, "a number > 0, or inf" if stiff else "a number >= 0")
            object.__setattr__(self, f.name, float(number))
