"""What shows a clearance holds for any numbers, and proves thin gaps that fixed directions cannot."""

from __future__ import annotations

from math import pi

import casadi as ca
import numpy as np
import pytest

from design import Box, Cylinder, certify, replay
from kinematics import ClaimSymbols, Heli4, Mechanism, Redundant3T1R, Surroundings
from kinematics.margins.clearance.parting import Turning, chosen
from trajectory import AdeptCycle, PathRefused, certify_path


@pytest.mark.parametrize("robot", [Heli4(), Redundant3T1R()], ids=["Heli4", "Redundant3T1R"])
def test_no_numbers_show_more_than_the_clearance(robot: Mechanism) -> None:
    """Chosen numbers with large errors, at a bound just above the true value: some claim is below 0, at every pose."""
    rng, model, claim = np.random.default_rng(4), robot.model(), ClaimSymbols.fresh()
    shown = robot.margins["clearance"].to_show(robot, claim, robot.home, positive=True)
    assert shown.matrix is not None
    given = [model.pose, model.geometry, claim.vector]
    seen = ca.Function("seen", given, [shown.matrix])
    rows = ca.Function("rows", [*given, ca.vec(shown.scaling)], [shown.expressions])
    for _ in range(30):
        pose = robot.home + 0.05 * robot.pose_units() * rng.uniform(-1, 1, len(robot.home))
        value = float(robot.margin("clearance", pose))
        measure = robot.fvi_bounds, robot.characteristic_length
        at = [pose, robot.geometry.vector()]
        below, above = (
            [*at, ClaimSymbols.values(bound, *measure)] for bound in (value - 1e-9, value + 1e-9 * robot.geometry.size)
        )
        chosen = shown.chosen(np.array(seen(*below)).T)[0, :, 0]
        assert np.array(rows(*below, chosen)).min() >= 0.0
        for error in (0.0, 0.01, 1.0):
            numbers = chosen + error * rng.normal(size=chosen.shape)
            assert np.array(rows(*above, numbers)).min() < 0.0


@pytest.mark.long
def test_neighbouring_rods_that_run_nearly_parallel_are_proved_apart() -> None:
    """3.5 mm between rods of 0.8 m: fixed directions need boxes of a third of a millimetre."""
    robot = Heli4()
    region = Box(x=(-0.05, 0.05), y=(-0.05, 0.05), z=(-0.7, -0.65), theta=(-0.4, 0.4))
    sampled = robot.margin("clearance", region.random(robot.pose_names, 20_000, np.random.default_rng(0))).min()
    asked = {"margin": "clearance", "at_least": 0.9 * float(sampled)}
    proved = certify(robot, region, **asked, most_boxes=5_000)
    assert proved.status == "proved"
    assert replay(proved, robot, region=region, **asked) > 0
    refuted = certify(robot, region, "clearance", at_least=1.001 * float(sampled), most_boxes=50_000)
    assert refuted.counterexample is not None
    assert robot.margin("clearance", refuted.counterexample) < refuted.bound.value


def test_a_floor_is_proved_and_refuted_over_a_region() -> None:
    robot = Redundant3T1R(surroundings=Surroundings(floor=-0.45))
    region = Box(x=0.0, y=(-0.1, 0.1), z=(-0.05, 0.05), theta=(-0.3, 0.3))
    low = float(robot.margin("clearance", region.random(robot.pose_names, 5_000, np.random.default_rng(0))).min())
    assert certify(robot, region, "clearance", at_least=0.5 * low, most_boxes=20_000).status == "proved"
    sunk = robot.with_surroundings(Surroundings(floor=-0.2))
    assert certify(sunk, region, "clearance", at_least=0.0, most_boxes=20_000).status == "refuted"


def test_a_cycle_keeps_its_clearance_and_a_refused_one_names_the_two_bodies() -> None:
    robot = Heli4()
    cycle = AdeptCycle(pick=(-0.1525, 0.0, -0.8), turn=pi)
    (poses,) = cycle.evaluate(np.linspace(0.0, cycle.length, 5001), 0)
    lowest = float(robot.margin("clearance", poses).min())
    assert 0.89 * lowest < certify_path(robot, cycle).margins["clearance"] < lowest
    placed = robot.with_surroundings(Surroundings(floor=-0.74))
    with pytest.raises(PathRefused, match=r"the clearance margin of .* and the floor is at most -0\.0") as caught:
        certify_path(placed, cycle)
    assert caught.value.margin == "clearance"
    assert caught.value.proved


@pytest.mark.long
def test_nine_tenths_of_heli4s_clearance_are_proved_over_its_whole_region() -> None:
    region = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-pi, pi))
    assert certify(Heli4(), region, "clearance", at_least=0.9 * 0.003288, most_boxes=200_000).status == "proved"


def test_no_boxes_need_no_directions() -> None:
    """A proof may ask for the bounds of an empty list of boxes."""
    seen = np.zeros((1, 2 * 3 + 16))
    assert chosen(seen, 2).shape == (1, 2 * 3 + Turning.numbers)
    assert chosen(seen[:0], 2).shape == (0, 2 * 3 + Turning.numbers)
