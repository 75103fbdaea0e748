"""Dense samples that find where a margin is worst."""

from design.sampling.sweep import Sweep, sweep
from design.sampling.worst_pose import DENSE, WorstPoses, descend, worst_poses

__all__ = [
    "DENSE",
    "Sweep",
    "WorstPoses",
    "descend",
    "sweep",
    "worst_poses",
]
