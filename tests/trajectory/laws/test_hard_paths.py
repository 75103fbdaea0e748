"""Paths that are easily refused though they can be travelled: each is timed by the law `toppra` and verified."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematics import Delta, GoughStewart, Heli4, Mechanism
from trajectory import Limits, Repaired, RoundedPath, lower_bound, pieces, repair, time_optimal

DELTA = Limits(speed=20.0, acceleration=400.0, torque=127.0)
SETTLED = 5e-4  # relative: what two times of the law may differ by, as its grids do
LEGS = Limits(speed=1.0, acceleration=30.0, torque=2000.0)


def through(robot: Mechanism, poses: object, blends: object = ()) -> RoundedPath:
    rows = tuple(tuple(pose) for pose in np.array(poses, dtype=object).tolist())
    return RoundedPath(robot.pose_names, rows, tuple(np.array(blends, dtype=float).tolist()))


def timed(robot: Mechanism, path: RoundedPath, limits: Limits, payload: float = 0.5) -> list[Repaired]:
    """Its pieces, within their limits; raises where anything fails."""
    return [repair(robot, time_optimal(robot, part, limits, payload), limits, payload) for part in pieces(path)]


def duration(parts: list[Repaired]) -> float:
    return sum(part.motion.duration for part in parts)


def test_a_meander_with_small_corners_is_timed() -> None:
    """A smoothed and stretched law with a jerk limit of 1e5 rad/s^3 takes 0.667 s on it."""
    robot, rows = Heli4(), np.linspace(-0.2, 0.2, 4)
    corners = [(x, y, -0.8, None) for k, y in enumerate(rows) for x in ((-0.2, 0.2) if k % 2 == 0 else (0.2, -0.2))]
    corners[0], corners[-1] = (*corners[0][:3], 0.0), (*corners[-1][:3], 0.0)
    parts = timed(robot, through(robot, corners, [0.01] * 6), Limits(speed=20.0, torque=127.0), 1.0)
    assert 0.5 < duration(parts) < 0.667


def test_a_circle_of_many_waypoints_takes_as_long_as_its_tool_can_turn() -> None:
    """On a circle of radius r the tool's acceleration v^2 / r alone bounds the speed, but for the corners' ripple."""
    robot, radius, cap = Delta(), 0.1, 20.0
    angles = np.linspace(0.0, 2.0 * math.pi, 13)
    circle = np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(13, -0.75)], axis=-1)
    blends = np.full(11, 0.49 * 2.0 * radius * math.sin(math.pi / 12))
    parts = timed(robot, through(robot, circle, blends), Limits(speed=1e3, tool_acceleration=cap))
    steady = 2.0 * math.pi * radius / math.sqrt(cap * radius)
    assert (
        steady < duration(parts) < 1.6 * steady
    )  # the curvature in the middle of a quintic corner is 1.875 times the mean


def test_a_smaller_blend_is_slower_and_never_slower_than_a_stop() -> None:
    robot, corner = Delta(), [(0.0, 0.0, -0.75), (0.1, 0.0, -0.75), (0.1, 0.1, -0.75)]
    times = [duration(timed(robot, through(robot, corner, [b]), DELTA)) for b in (0.01, 0.001, 2e-4, 1e-6, 0.0)]
    assert (np.diff(times) > -SETTLED * times[-1]).all()
    assert times[0] < times[1] < times[2] < times[-1]


def test_a_hexapod_rolls_in_place() -> None:
    """By 10 degrees: a forward and backward integration of its own takes 0.0791 s."""
    robot, start = GoughStewart(), (0.0, 0.0, 0.62, 0.0, 0.0, 0.0)
    parts = timed(robot, through(robot, [start, (0.0, 0.0, 0.62, math.radians(10.0), 0.0, 0.0)]), LEGS)
    assert duration(parts) == pytest.approx(0.0791, abs=1e-4)


def test_a_tool_that_stands_still_uses_none_of_its_own_limits() -> None:
    robot, limits = GoughStewart(), replace(LEGS, tool_speed=0.1, tool_acceleration=1.0)
    turn = through(robot, [(0.0, 0.0, 0.62, 0.0, 0.0, 0.0), (0.0, 0.0, 0.62, 0.0, 0.0, 0.2)])
    (free,), (capped,) = timed(robot, turn, LEGS), timed(robot, turn, limits)
    assert capped.motion.duration == pytest.approx(free.motion.duration, rel=SETTLED)
    assert capped.verification.proved["tool speed"] < 1e-6
    assert lower_bound(robot, turn, limits, 0.5) < free.motion.duration


def test_a_turn_in_place_between_two_moves_is_a_piece_of_its_own() -> None:
    robot, limits = Heli4(), Limits(speed=20.0, torque=127.0)
    poses = [(-0.1, 0, -0.8, 0), (0.1, 0, -0.8, 0), (0.1, 0, -0.8, 2), (0.1, 0.1, -0.8, 2)]
    parts = timed(robot, through(robot, poses, [0.0, 0.0]), limits)
    alone = [duration(timed(robot, through(robot, poses[k : k + 2]), limits)) for k in range(3)]
    assert [part.motion.duration for part in parts] == pytest.approx(alone, rel=2 * SETTLED)


@pytest.mark.parametrize("aside", [0.0, 1e-9, -3e-8])
def test_a_waypoint_that_is_hardly_aside_is_no_stop(aside: float) -> None:
    """200 mm at 0.5 m/s with 4 m/s^2 to start and to stop: 0.4 s + 0.125 s."""
    robot, limits = Delta(), Limits(speed=1e4, tool_speed=0.5, tool_acceleration=4.0)
    straight = through(robot, [(-0.1, 0.0, -0.75), (0.0, aside, -0.75), (0.1, 0.0, -0.75)], [0.0])
    assert straight.stops == ()
    assert duration(timed(robot, straight, limits)) == pytest.approx(0.525, rel=1e-4)


def test_a_waypoint_a_little_further_aside_is_a_stop() -> None:
    bent = through(Delta(), [(-0.1, 0.0, -0.75), (0.0, 3e-6, -0.75), (0.1, 0.0, -0.75)], [0.0])
    assert bent.stops == pytest.approx((0.1,))


def test_a_step_of_ten_nanometres_between_two_stops_is_timed() -> None:
    robot = Delta()
    poses = [(0.0, 0.0, -0.75), (0.05, 0.0, -0.75), (0.05, 1e-8, -0.75), (0.1, 1e-8, -0.75)]
    first, step, last = (part.motion.duration for part in timed(robot, through(robot, poses, [0.0, 0.0]), DELTA))
    assert step < 1e-3 * min(first, last)


@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_a_scaled_path_under_scaled_limits_of_its_tool_takes_as_long(factor: float) -> None:
    """Lengths, speeds and accelerations of the tool and the robot by one factor, and the same time."""
    robot = Delta()
    sizes = {
        name: factor * getattr(robot.geometry, name)
        for name in ("base_radius", "platform_radius", "arm_length", "rod_length")
    }
    scaled = Delta(replace(robot.geometry, **sizes))
    poses = np.array([(-0.1, 0.0, -0.75), (0.0, 0.05, -0.7), (0.1, -0.05, -0.75)])
    limits = Limits(speed=20.0, acceleration=400.0, tool_speed=1.0, tool_acceleration=30.0)
    by_factor = replace(limits, tool_speed=factor, tool_acceleration=30.0 * factor)
    found = timed(robot, through(robot, poses, [0.02]), limits)
    again = timed(scaled, through(scaled, factor * poses, [0.02 * factor]), by_factor)
    assert duration(again) == pytest.approx(duration(found), rel=1e-6)
    peaks, others = (parts[0].verification.peak_over_limit for parts in (found, again))
    assert others == pytest.approx(peaks, rel=1e-6)
