"""Where a margin is worst, found by dense samples."""

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
