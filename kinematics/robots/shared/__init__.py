"""Parts that several mechanisms use: rotary limbs, paired rods, and a check for limbs that coincide."""

from kinematics.robots.shared.arm_masses import ArmInertia, arms_and_rods
from kinematics.robots.shared.coincident_limbs import ALIKE, HalvesGeometry, twins
from kinematics.robots.shared.internal_determinant import INTERNAL_DETERMINANT
from kinematics.robots.shared.limb_members import SIDES, limb_members, motors, studs
from kinematics.robots.shared.paired_rods import RodLevel, outline
from kinematics.robots.shared.rotary_limbs import (
    ArmRanges,
    Limbs,
    RotaryLimbs,
    central_limbs,
    columns,
    height_in_reach,
    radial_directions,
    upright_limbs,
)

__all__ = [
    "ALIKE",
    "INTERNAL_DETERMINANT",
    "SIDES",
    "ArmInertia",
    "ArmRanges",
    "HalvesGeometry",
    "Limbs",
    "RodLevel",
    "RotaryLimbs",
    "arms_and_rods",
    "central_limbs",
    "columns",
    "height_in_reach",
    "limb_members",
    "motors",
    "outline",
    "radial_directions",
    "studs",
    "twins",
    "upright_limbs",
]
