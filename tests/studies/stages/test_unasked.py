"""The figures of the bodies that a study did not ask about, and which of them became worse."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from design import Box
from kinematics import Heli4, member_forces
from studies.stages.unasked import Change
from tests.studies.command_line import SmallRun


def test_a_run_shows_the_bodies_figures_and_names_each_that_became_worse(small_run: SmallRun) -> None:
    data = json.loads(small_run[1].stdout)
    before, after = data["unasked_before"], {name: found["value"] for name, found in data["unasked"].items()}
    assert {"clearance", "stiffness", "natural_frequency", "position_accuracy", "strength", "mass"} <= set(after)
    assert not set(after) & set(data["worst"])
    told = {line.split(" is worse")[0] for line in data["became_worse"]}
    for name, now in after.items():
        loss = Heli4.margins[name].sense * (before[name] - now)
        if abs(loss) > 2e-3 * abs(before[name]):
            assert (name in told) == (loss > 0.0)
    assert told  # a geometry that was changed for the FVI alone


def test_the_masses_told_are_those_of_both_geometries(small_run: SmallRun) -> None:
    data = json.loads(small_run[1].stdout)
    found = Heli4(Heli4.Geometry(**data["geometry"]))
    for robot, told in ((Heli4(), data["unasked_before"]["mass"]), (found, data["unasked"]["mass"]["value"])):
        assert float(robot.margin("mass", robot.home)) == pytest.approx(told, rel=1e-12)


def test_no_member_bears_more_in_a_random_motion_from_rest_than_is_told(small_run: SmallRun) -> None:
    """Up to what a grid misses between its poses."""
    data = json.loads(small_run[1].stdout)
    region = Box(x=(-0.2, 0.2), y=(-0.2, 0.2), z=(-0.76, -0.7), theta=(-math.pi / 2, math.pi / 2))
    robot, rng, count = Heli4(Heli4.Geometry(**data["geometry"])), np.random.default_rng(4), 5000
    poses = region.random(robot.pose_names, count, rng)
    directions = rng.normal(size=(count, 3))
    acceleration = np.zeros((count, 4))
    acceleration[:, :3] = robot.load.acceleration * directions / np.linalg.norm(directions, axis=1)[:, None]
    found = member_forces(robot, robot.load.payload, poses, 0 * poses, acceleration)
    told = {load["member"]: load for load in data["loads_from_rest"]}
    assert tuple(told) == found.names
    for k, name in enumerate(found.names):
        along = max(told[name]["tension"], told[name]["compression"])
        assert 0.7 * along < np.abs(found.tension[:, k]).max() < 1.02 * along
        assert found.bending[:, k].max() < 1.02 * told[name]["bending"]
        assert found.joint_force[:, k].max() < 1.02 * told[name]["joint_force"]


def test_a_change_is_worse_in_its_own_sense_only() -> None:
    assert Change("stiffness", "N/m", 4e5, 3e5, 1).worse
    assert not Change("stiffness", "N/m", 3e5, 4e5, 1).worse
    assert Change("mass", "kg", 5.0, 6.0, -1).worse
    assert not Change("mass", "kg", 5.0, 5.004, -1).worse
    assert not Change("strength", "", math.inf, math.inf, 1).worse
    assert str(Change("mass", "kg", 5.0, 6.0, -1)) == "mass is worse by 20.0 %: 5 before, 6 kg now"
