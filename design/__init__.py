"""Regions, requirements and the synthesis of geometries that meet them."""

from design.errors import InvalidRegion, SynthesisFailed
from design.region import Box, Cylinder, Region
from design.requirement import Bounds, Requirement, SumLimit
from design.search import WorstPoses, worst_poses

__all__ = [
    "Bounds",
    "Box",
    "Cylinder",
    "InvalidRegion",
    "Region",
    "Requirement",
    "SumLimit",
    "SynthesisFailed",
    "WorstPoses",
    "worst_poses",
]
