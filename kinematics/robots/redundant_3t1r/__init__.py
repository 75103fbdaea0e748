"""The redundant 3T-1R robot: six parallel slides, four freedoms."""

from kinematics.robots.redundant_3t1r.redundant_3t1r import Redundant3T1R

__all__ = [
    "Redundant3T1R",
]
