"""Parts that several mechanisms use: rotary limbs, paired rods, and a check for limbs that coincide."""

from kinematics.robots.shared.arm_and_rod_members import SIDES, limb_members, motors, pairs_held, studs
from kinematics.robots.shared.arm_masses import ArmInertia, arms_and_rods
from kinematics.robots.shared.coincident_limbs import ALIKE, HalvesGeometry, twins
from kinematics.robots.shared.internal_determinant import INTERNAL_DETERMINANT
from kinematics.robots.shared.limb_statics import beam, rod_statics, rods_of
from kinematics.robots.shared.paired_arms import PairedArms
from kinematics.robots.shared.paired_rods import RodLevel, means_and_differences, outline
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
    "PairedArms",
    "RodLevel",
    "RotaryLimbs",
    "arms_and_rods",
    "beam",
    "central_limbs",
    "columns",
    "height_in_reach",
    "limb_members",
    "means_and_differences",
    "motors",
    "outline",
    "pairs_held",
    "radial_directions",
    "rod_statics",
    "rods_of",
    "studs",
    "twins",
    "upright_limbs",
]
