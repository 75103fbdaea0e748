"""Clearance: the distance between members, base and surroundings, and what proves it."""

from kinematics.margins.clearance.clearance import CLEARANCE
from kinematics.margins.clearance.solids import lowest_of_base, payload_inside

__all__ = ["CLEARANCE", "lowest_of_base", "payload_inside"]
