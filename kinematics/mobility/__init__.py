"""Mobility: counted from joints and loops, and confirmed by a rank."""

from kinematics.mobility.architectures import ARCHITECTURES, Architecture, loop_mobility, mobility_of_identical_chains
from kinematics.mobility.joint_graph import Joint, JointGraph

__all__ = [
    "ARCHITECTURES",
    "Architecture",
    "Joint",
    "JointGraph",
    "loop_mobility",
    "mobility_of_identical_chains",
]
