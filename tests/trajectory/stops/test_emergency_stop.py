"""A stop along the path from any instant: within every limit, never off the path, never past the end of the piece."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from kinematics import DriveTrain, Heli4, InvalidValue, Peppermill
from tests.sizes import later
from trajectory import (
    AdeptCycle,
    Cycle,
    EmergencyStop,
    Limits,
    LimitsExceeded,
    TimedMotion,
    emergency_stop,
    repair,
    there_and_back,
    time_optimal,
)


@pytest.fixture(scope="module", params=[20, later(60)])
def stops(
    request: pytest.FixtureRequest, robot: Heli4, cycle: Cycle, limits: Limits
) -> list[tuple[TimedMotion, EmergencyStop]]:
    """From instants all over the way there and some of the way back, at the knots of the law and its corners too."""
    there, back = (piece.motion for piece in cycle.pieces)
    corners = np.interp(there.path.knots[1:-1], there.law.position, there.law.times)
    knots = there.times[[1, 700, -2]]
    at = [*np.linspace(0.0, there.duration, request.param - 8)[1:-1], *corners, *knots, knots[1] * (1 - 1e-10)]
    at += [1e-6 * there.duration, (1 - 1e-6) * there.duration]
    found = [(there, emergency_stop(robot, there, t, limits, 1.0)) for t in at]
    assert len(found) >= request.param
    return found + [(back, emergency_stop(robot, back, f * back.duration, limits, 1.0)) for f in (0.3, 0.5, 0.7)]


def test_from_every_instant_the_limits_hold(stops: list[tuple[TimedMotion, EmergencyStop]]) -> None:
    for _, stop in stops:
        assert max(stop.verification.peak_over_limit.values()) <= 1.0
        assert stop.verification.ok
    assert np.median([stop.verification.peak_over_limit["torque"] for _, stop in stops]) > 0.999


def test_it_takes_over_the_motion_and_rests_before_its_end(stops: list[tuple[TimedMotion, EmergencyStop]]) -> None:
    for motion, stop in stops:
        first, last = stop.motion.at(np.array([0.0, stop.duration])), motion.at(np.array([stop.start, motion.duration]))
        assert first.pose[0] == pytest.approx(last.pose[0], abs=1e-12)
        assert first.velocity[0] == pytest.approx(last.velocity[0], abs=1e-9)
        assert np.abs(first.velocity[-1]).max() < 1e-6
        # the way is the least, not the time: close to the end, braking rests no sooner than the motion itself
        assert stop.duration <= 1.01 * (motion.duration - stop.start)
        assert stop.start <= stop.motion.pace.position[-1] <= motion.duration
        assert (np.diff(stop.motion.pace.speed) <= 0.0).all()


def test_it_never_leaves_the_path(stops: list[tuple[TimedMotion, EmergencyStop]], path: AdeptCycle) -> None:
    points = cKDTree(path.evaluate(np.linspace(0.0, path.length, 100_001), 0)[0])
    apart = np.linalg.norm(np.diff(points.data, axis=0), axis=1).max()
    for _, stop in stops:
        poses = stop.motion.at(np.linspace(0.0, stop.duration, 50)).pose
        assert points.query(poses)[0].max() < 0.51 * apart


def test_the_speeds_of_the_stop_are_the_slopes_of_its_poses(stops: list[tuple[TimedMotion, EmergencyStop]]) -> None:
    _, stop = stops[len(stops) // 3]
    t = np.linspace(0.0, stop.duration, 20_001)
    motion = stop.motion.at(t)
    for value, rate in ((motion.pose, motion.velocity), (motion.velocity, motion.acceleration)):
        slope = (value[2:] - value[:-2]) / (t[2:] - t[:-2])[:, None]
        assert np.median(np.abs(slope - rate[1:-1])) < 1e-5 * np.abs(rate).max()


@pytest.mark.parametrize("share", [0.2, 0.4, 0.7])
def test_on_a_straight_line_it_is_the_parabola_of_the_cap(robot: Heli4, straight: type, share: float) -> None:
    limits = Limits(speed=20.0, tool_acceleration=30.0)
    timed = repair(robot, time_optimal(robot, straight(), limits, payload=1.0), limits, 1.0).motion
    start = share * timed.duration
    speed = timed.at(np.array(start)).velocity[2]
    stop = emergency_stop(robot, timed, start, limits, 1.0)
    assert stop.duration == pytest.approx(speed / 30.0, rel=1e-3)
    travelled = stop.pose[2] - timed.at(np.array(start)).pose[2]
    assert travelled == pytest.approx(speed**2 / 60.0, rel=1e-3)


def test_motors_that_share_the_joints_keep_their_limits() -> None:
    robot = Peppermill()
    path = AdeptCycle.centred((0.0, 0.0, -0.0125), heading=0.6)
    limits = Limits(speed=314.0, torque=7.2)
    cycle = there_and_back(robot, path, limits, 0.5, time_optimal)
    motion = cycle.pieces[0].motion
    for share in (0.2, 0.5, 0.6):
        stop = emergency_stop(robot, motion, share * motion.duration, limits, 0.5)
        assert 0.99 < max(stop.verification.peak_over_limit.values()) <= 1.0


def test_a_motion_that_is_over_its_limits_cannot_be_stopped_within_them(robot: Heli4, cycle: Cycle) -> None:
    motion = cycle.pieces[0].motion
    with pytest.raises(LimitsExceeded, match="torque"):
        emergency_stop(robot, motion, 0.6 * motion.duration, replace(cycle.limits, torque=60.0), 1.0)


def test_what_nothing_limits_cannot_be_braked(robot: Heli4, cycle: Cycle) -> None:
    motion = cycle.pieces[0].motion
    with pytest.raises(InvalidValue, match="acceleration, torque, tool_acceleration, jerk"):
        emergency_stop(robot, motion, 0.5 * motion.duration, Limits(speed=20.0), 1.0)


@pytest.mark.parametrize("share", [0.0, 1.0, -0.1, np.nan])
def test_where_nothing_moves_nothing_is_stopped(robot: Heli4, cycle: Cycle, limits: Limits, share: float) -> None:
    motion = cycle.pieces[0].motion
    with pytest.raises(InvalidValue, match="start of an emergency stop"):
        emergency_stop(robot, motion, share * motion.duration, limits, 1.0)


@pytest.mark.parametrize("drives", [later({"coulomb": 6.0}), {"coulomb": 4.0, "viscous": 0.5}])
def test_a_stop_against_friction_keeps_the_limits_down_to_rest(path: AdeptCycle, drives: dict[str, float]) -> None:
    rough, limits = Heli4(inertia=Heli4.Inertia(drive_train=DriveTrain(**drives))), Limits(speed=20.0, torque=127.0)
    smooth = time_optimal(Heli4(), path, Limits(speed=20.0, torque=100.0), 1.0, 1000)
    for share in (0.1, 0.3, 0.5, 0.7, 0.9):
        stop = emergency_stop(rough, smooth, share * smooth.duration, limits, 1.0)
        assert stop.verification.peak_over_limit["torque"] <= stop.verification.proved["torque"] <= 1.0
        assert stop.duration <= (1.0 - share) * smooth.duration * 1.01
