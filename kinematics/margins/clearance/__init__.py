"""Clearance: the distance between members, base and surroundings, and what proves it."""

from kinematics.margins.clearance.clearance import CLEARANCE
from kinematics.margins.clearance.solids import hull_depth, lowest_of_base

__all__ = ["CLEARANCE", "hull_depth", "lowest_of_base"]
