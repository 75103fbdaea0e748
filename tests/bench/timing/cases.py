"""The cases in which timing laws are compared: a robot, half of a cycle, limits and a payload."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from kinematics import Heli4, Mechanism
from kinematics.arrays import Array
from studies.building.load import load_study
from studies.building.objects import limits_of, path_of, pose_bounds_of, robot_of
from studies.study_file.locate import study_path
from studies.study_file.toml_file import read_toml
from trajectory import AdeptCycle, Limits, Path
from trajectory.paths.pose_bounds import PoseBounds


@dataclass(frozen=True)
class Case:
    """What every law is given; SI. The comparison knows limits of the drives' speed, acceleration, torque and jerk.

    `within` is the study's region, for a law with a path of its own.
    """

    name: str
    robot: Mechanism
    path: Path
    limits: Limits
    payload: float
    within: PoseBounds | None = None

    @property
    def without_jerk(self) -> Limits:
        """What a law with steps of acceleration can keep."""
        return replace(self.limits, jerk=None)

    def limit(self, name: str) -> Array | None:
        """(m,) one limit of the drives."""
        return self.limits.of_joints(name, len(self.robot.actuator_names))


def reference() -> Case:
    """Of the study cycle_reference."""
    return _of_study("cycle_reference", "the reference")


def others() -> list[Case]:
    """Other sizes, loads, drives and robots."""
    slower = AdeptCycle.centred((0.05, 0.05, -0.75), span=0.4, lift=0.05, blend=0.015, turn=-math.pi / 2, heading=0.7)
    weaker = Limits(speed=15.0, torque=90.0, jerk=5e4)
    return [
        Case("Heli4, off centre, 50/400/50, corners of 15 mm, 2 kg", Heli4(), slower, weaker, 2.0),
        _of_study("redundant_3t1r", "Redundant3T1R, its study"),
        _of_study("peppermill", "Peppermill, its study"),
    ]


def _of_study(study: str, name: str) -> Case:
    found = load_study(read_toml(study_path(study)))
    asked = found.trajectory
    assert asked is not None
    robot = robot_of(found)
    path = path_of(asked, robot.pose_names)
    return Case(name, robot, path, limits_of(asked.limits), asked.payload, pose_bounds_of(found))
