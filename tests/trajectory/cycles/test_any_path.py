"""Any path of any mechanism is proved, timed in pieces, verified and sampled."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from pathlib import Path as FilePath

import numpy as np
import pytest

from kinematics import GoughStewart, Heli4, Hexa, Planar3RRR
from trajectory import (
    AdeptCycle,
    Limits,
    PathRefused,
    RoughPath,
    RoundedPath,
    cycle_setpoints,
    read_setpoints,
    there_and_back,
    time_optimal,
    write_setpoints,
)

SIX = GoughStewart.pose_names
LEGS = Limits(speed=1.0, acceleration=30.0, torque=2000.0)
TILTED = AdeptCycle(span=0.15, pick=(-0.075, 0.02, 0.62), turn=0.2, tilt=(0.14, -0.08), heading=0.3, pose_names=SIX)
COARSE = partial(time_optimal, intervals=1000)


def corners(*blends: float) -> RoundedPath:
    """Up, across with a turn, and down, of Heli4."""
    up = ((-0.1, 0.05, -0.8, 0.0), (-0.1, 0.05, -0.75, None), (0.1, -0.05, -0.75, None), (0.1, -0.05, -0.8, 1.0))
    return RoundedPath(Heli4.pose_names, up, blends)


@pytest.mark.long
def test_a_hexapod_s_tilted_cycle_keeps_every_limit_and_goes_to_a_file_and_back(tmp_path: FilePath) -> None:
    robot = GoughStewart()
    cycle = there_and_back(robot, TILTED, LEGS, 2.0, COARSE)
    assert cycle.half == pytest.approx(cycle.duration / 2, rel=1e-4)
    points = cycle_setpoints(cycle, 1e-3, robot.actuator_units)
    assert points.columns[1:7] == SIX
    assert points.units[1:7] == ("m", "m", "m", "rad", "rad", "rad")
    assert points.pose[[0, -1]] == pytest.approx(np.tile((-0.075, 0.02, 0.62, 0, 0, 0), (2, 1)), abs=1e-12)
    turning = points.pose[len(points.pose) // 2]
    assert turning[3:] == pytest.approx((0.14, -0.08, 0.2), abs=1e-9)
    points.require_consistent(robot)
    write_setpoints(tmp_path / "cycle.csv", points)
    back = read_setpoints(tmp_path / "cycle.csv")
    assert back.pose_names == SIX
    assert np.array_equal(back.table(), points.table())
    assert back.header["proved margins"] == cycle.certificate.margins


def test_the_mirror_image_of_a_path_takes_a_mirror_symmetric_hexapod_as_long() -> None:
    """In the xz plane y, roll and yaw change sign."""
    robot = GoughStewart()
    x, y, z = TILTED.pick
    image = replace(TILTED, pick=(x, -y, z), heading=-TILTED.heading, turn=-TILTED.turn, tilt=(-0.14, -0.08))
    times = [COARSE(robot, path, LEGS, 2.0).duration for path in (TILTED, image)]
    assert times[1] == pytest.approx(times[0], rel=1e-9)


def test_a_path_turned_by_half_a_turn_takes_heli4_as_long(limits: Limits) -> None:
    path = AdeptCycle.centred((0.03, 0.02, -0.8), heading=0.4)
    turned = AdeptCycle.centred((-0.03, -0.02, -0.8), heading=0.4 + math.pi)
    times = [COARSE(Heli4(), p, limits, 1.0).duration for p in (path, turned)]
    assert times[1] == pytest.approx(times[0], rel=1e-9)


def test_corners_without_a_blend_are_stops_and_cost_time(limits: Limits) -> None:
    rounded = COARSE(Heli4(), corners(0.04, 0.04), limits, 1.0)
    stopped = there_and_back(Heli4(), corners(0.0, 0.0), limits, 1.0, COARSE)
    assert [len(way) for way in (stopped.there, stopped.back)] == [3, 3]
    assert stopped.half > 1.1 * rounded.duration
    for piece in stopped.pieces:
        assert np.abs(piece.motion.at(np.array([0.0, piece.duration])).velocity).max() < 1e-12
        assert piece.timed.verification.ok
    points = cycle_setpoints(stopped, 1e-3, Heli4.joint_units)
    at_rest = np.flatnonzero(np.abs(points.speed).max(axis=1) < 1e-9)
    tops = points.pose[at_rest][:, :3]
    assert len(at_rest) == 7
    assert tops[1] == pytest.approx((-0.1, 0.05, -0.75), abs=1e-9)
    assert tops[2] == pytest.approx((0.1, -0.05, -0.75), abs=1e-9)


def test_a_path_with_a_stop_inside_is_not_timed_as_one(limits: Limits) -> None:
    with pytest.raises(RoughPath, match="jump of the tangent"):
        COARSE(Heli4(), corners(0.04, 0.0), limits, 1.0)


def test_a_planar_robot_s_closed_path_is_run_once() -> None:
    robot = Planar3RRR()
    poses = ((0.0, 0.0, 0.0), (0.05, 0.0, 0.1), (0.0, 0.05, 0.2), (0.0, 0.0, 0.0))
    limits = Limits(speed=10.0, acceleration=200.0, tool_acceleration=20.0)
    cycle = there_and_back(robot, RoundedPath(robot.pose_names, poses, (0.02, 0.0)), limits, 0.5, COARSE)
    assert (len(cycle.there), cycle.back) == (2, ())
    assert max(piece.timed.verification.peak_over_limit["tool acceleration"] for piece in cycle.there) > 0.99
    points = cycle_setpoints(cycle, 1e-3, robot.actuator_units)
    assert points.pose[-1] == pytest.approx(points.pose[0], abs=1e-12)


def test_a_path_that_cannot_be_proved_is_not_timed(limits: Limits) -> None:
    far = AdeptCycle(span=1.6, pick=(-0.8, 0.0, -0.8))
    with pytest.raises(PathRefused, match="reach margin of limb"):
        there_and_back(Heli4(), far, limits, 1.0, COARSE)


@pytest.mark.long
def test_a_hexa_follows_six_coordinates_too() -> None:
    robot = Hexa()
    path = AdeptCycle(span=0.1, pick=(-0.05, 0.0, robot.home[2]), turn=0.2, tilt=(0.1, 0.05), pose_names=SIX)
    cycle = there_and_back(robot, path, Limits(speed=20.0, torque=127.0), 0.5, COARSE)
    assert max(cycle.there[0].timed.verification.peak_over_limit.values()) > 0.99
