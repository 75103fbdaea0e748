"""The figures of the bodies that a study did not ask about, and which of them became worse."""

from __future__ import annotations

import json
import math

import pytest

from kinematics import Heli4
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


def test_a_change_is_worse_in_its_own_sense_only() -> None:
    assert Change("stiffness", "N/m", 4e5, 3e5, 1).worse
    assert not Change("stiffness", "N/m", 3e5, 4e5, 1).worse
    assert Change("mass", "kg", 5.0, 6.0, -1).worse
    assert not Change("mass", "kg", 5.0, 5.004, -1).worse
    assert not Change("strength", "", math.inf, math.inf, 1).worse
    assert str(Change("mass", "kg", 5.0, 6.0, -1)) == "mass is worse by 20.0 %: 5 before, 6 kg now"
