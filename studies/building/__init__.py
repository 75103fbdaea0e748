"""Builds the robot, the region, the path and the other objects that a study describes."""

from studies.building.inside_region import leaving
from studies.building.load import load_study
from studies.building.mechanisms import installed_mechanisms
from studies.building.objects import (
    FRAME_FILE,
    approach_limits,
    drive_file_names,
    drive_of,
    home_of,
    limits_of,
    path_of,
    problem_of,
    region_of,
    require_cycle_inside,
    robot_of,
    timing_of,
)

__all__ = [
    "FRAME_FILE",
    "approach_limits",
    "drive_file_names",
    "drive_of",
    "home_of",
    "installed_mechanisms",
    "leaving",
    "limits_of",
    "load_study",
    "path_of",
    "problem_of",
    "region_of",
    "require_cycle_inside",
    "robot_of",
    "timing_of",
]
