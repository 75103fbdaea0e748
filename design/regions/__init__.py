"""Regions of the pose space: boxes, cylinders, and their common base."""

from design.regions.box import Box
from design.regions.cylinder import Cylinder
from design.regions.region import Region, unit_grid

__all__ = ["Box", "Cylinder", "Region", "unit_grid"]
