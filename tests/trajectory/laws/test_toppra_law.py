"""The time-optimal law: against closed forms, against its own optimality condition, and what it refuses."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematics import Delta, Heli4, InvalidValue, UnreachablePose, inverse_dynamics
from tests.bench.timing.cases import reference
from tests.bench.timing.toppra_peer import ExactPath, problem_of, solved
from trajectory import (
    AdeptCycle,
    Limits,
    PathBeyondLimit,
    Reversed,
    RoughPath,
    RoundedPath,
    TimedPath,
    pieces,
    time_optimal,
    verify,
)

FREE = 1e6  # a limit that never matters


def test_the_reference_half_cycle_takes_127_ms(timed: TimedPath) -> None:
    assert timed.duration == pytest.approx(0.1274, abs=1e-4)


@pytest.mark.parametrize("intervals", [20, 400, 3000])
def test_the_answer_does_not_hang_on_the_first_grid(
    robot: Heli4, path: AdeptCycle, limits: Limits, timed: TimedPath, intervals: int
) -> None:
    found = time_optimal(robot, path, limits, 1.0, intervals)
    assert found.duration == pytest.approx(timed.duration, rel=3e-4)
    assert max(verify(robot, found, limits, 1.0).peak_over_limit.values()) < 1.0005


def test_toppra_takes_as_long_on_a_fine_grid(timed: TimedPath) -> None:
    case = reference()
    peer = solved(case, problem_of(case, ExactPath(case.path), 8000))
    assert timed.duration == pytest.approx(peer.duration, rel=3e-4)


@pytest.mark.parametrize("blend", [1e-6, 2e-4])
def test_a_corner_of_any_size_is_passed_within_the_limits(blend: float) -> None:
    """The grid is refined in the corner alone: ever smaller ones cost no more than stopping there."""
    robot, limits = Delta(), Limits(speed=20.0, acceleration=400.0, torque=127.0)
    legs = ((0.0, 0.0, -0.75), (0.1, 0.0, -0.75), (0.1, 0.1, -0.75))
    rounded = time_optimal(robot, RoundedPath(robot.pose_names, legs, (blend,)), limits, 0.5)
    stopped = sum(
        time_optimal(robot, part, limits, 0.5).duration for part in pieces(RoundedPath(robot.pose_names, legs, (0.0,)))
    )
    assert rounded.law.times.size < 12_000
    assert max(verify(robot, rounded, limits, 0.5).peak_over_limit.values()) < 1.0005
    assert 0.9 * stopped < rounded.duration < stopped


def test_a_straight_line_under_a_tool_acceleration_cap_is_bang_bang(robot: Heli4, straight: type) -> None:
    line = straight()
    timed = time_optimal(robot, line, Limits(speed=FREE, tool_acceleration=50.0), 1.0)
    assert timed.duration == pytest.approx(2 * math.sqrt(line.length / 50.0), rel=1e-4)


def test_a_straight_line_under_a_tool_speed_cap_too_is_a_trapezoid(robot: Heli4, straight: type) -> None:
    line = straight()
    timed = time_optimal(robot, line, Limits(speed=FREE, tool_speed=1.0, tool_acceleration=50.0), 1.0)
    assert timed.duration == pytest.approx(line.length / 1.0 + 1.0 / 50.0, rel=1e-4)
    assert timed.law.speed.max() == pytest.approx(1.0, rel=1e-6)


def test_joint_speed_alone_is_saturated_along_the_way(robot: Heli4, path: AdeptCycle) -> None:
    limits = Limits(speed=(3.0, 4.0, 5.0, 6.0), acceleration=5000.0)
    timed = time_optimal(robot, path, limits, 1.0)
    middle = timed.law.at(np.linspace(0.2, 0.8, 50) * timed.duration)
    _, first, *_ = path.evaluate(middle.position, 1)
    pose = path.evaluate(middle.position, 0)[0]
    rates = np.einsum("kij,kj->ki", robot.inverse_jacobian(pose), first) * middle.speed[:, None]
    assert (np.abs(rates) / [3.0, 4.0, 5.0, 6.0]).max(axis=-1) == pytest.approx(1.0, abs=1e-3)


def test_some_limit_is_reached_at_every_instant(robot: Heli4, path: AdeptCycle, timed: TimedPath) -> None:
    """A time-optimal law on a fixed path is always on the edge of what it may, but for the grid and the switches."""
    along = timed.law.at(np.linspace(0.0, timed.duration, 2001)[1:-1])
    pose, first, second = path.evaluate(along.position, 2)
    v, a = along.speed[:, None], along.acceleration[:, None]
    torque = inverse_dynamics(robot, 1.0, pose, first * v, second * v**2 + first * a)
    rates = np.einsum("kij,kj->ki", robot.inverse_jacobian(pose), first * v)
    used = np.maximum(np.abs(torque).max(axis=-1) / 127.0, np.abs(rates).max(axis=-1) / 20.0)
    assert np.quantile(used, 0.02) > 0.98
    assert np.quantile(used, 0.5) > 0.999
    assert used.max() < 1.001


def test_the_way_back_takes_as_long(robot: Heli4, path: AdeptCycle, limits: Limits, timed: TimedPath) -> None:
    back = time_optimal(robot, Reversed(path), limits, 1.0)
    assert back.duration == pytest.approx(timed.duration, rel=1e-5)


def test_less_torque_more_payload_and_sharper_corners_take_longer(
    robot: Heli4, path: AdeptCycle, limits: Limits, timed: TimedPath
) -> None:
    assert time_optimal(robot, path, replace(limits, torque=110.0), 1.0).duration > 1.02 * timed.duration
    assert time_optimal(robot, path, limits, 2.0).duration > 1.02 * timed.duration
    sharp = time_optimal(robot, replace(path, blend=0.002), limits, 1.0).duration
    assert sharp / timed.duration == pytest.approx(1 / 0.87, abs=0.02)


@pytest.mark.parametrize(
    "more",
    [
        {"tool_acceleration": 165.0},
        {"tool_speed": 4.0},
        {"acceleration": 300.0},
        {"torque": (100.0, 120.0, 80.0, 90.0)},
        {"tool_acceleration": 100.0, "tool_speed": 3.0, "acceleration": 400.0},
    ],
)
def test_every_limit_is_kept_and_the_tightest_is_used(
    robot: Heli4, path: AdeptCycle, limits: Limits, more: dict[str, object]
) -> None:
    tighter = replace(limits, **more)
    timed = time_optimal(robot, path, tighter, 1.0)
    ratios = verify(robot, timed, tighter, 1.0).peak_over_limit
    assert max(ratios.values()) == pytest.approx(1.0, abs=2e-3)
    assert set(ratios) >= {"joint speed", "torque"}


def test_a_pose_out_of_reach_is_refused_naming_limb_and_margin(robot: Heli4, path: AdeptCycle, limits: Limits) -> None:
    with pytest.raises(UnreachablePose) as caught:
        time_optimal(robot, replace(path, pick=(-0.1525, 0.0, -1.2)), limits, 1.0)
    assert caught.value.limb in (1, 2, 3, 4)
    assert caught.value.margin < 0
    assert f"limb {caught.value.limb}" in str(caught.value)


def test_a_path_by_another_parameter_is_refused_before_timing(robot: Heli4, straight: type, limits: Limits) -> None:
    with pytest.raises(RoughPath):
        time_optimal(robot, straight(direction=(0.0, 0.0, 0.5, 0.0)), limits, 1.0)


@pytest.mark.parametrize(
    ("changes", "intervals", "payload", "what"),
    [
        ({"jerk": 1e5}, 2000, 1.0, "jerk"),
        ({"rms_torque": 76.0}, 2000, 1.0, "rms_torque"),
        ({"stall_torque": 150.0, "no_load_speed": 25.0}, 2000, 1.0, "stall_torque"),
        ({}, 0, 1.0, "intervals"),
        ({}, 2000, -1.0, "payload"),
        ({}, 2000, math.nan, "payload"),
        ({"torque": (127.0, 127.0)}, 2000, 1.0, "torque"),
    ],
)
def test_what_the_law_cannot_do_is_refused(
    robot: Heli4,
    path: AdeptCycle,
    limits: Limits,
    changes: dict[str, object],
    intervals: int,
    payload: float,
    what: str,
) -> None:
    with pytest.raises(InvalidValue, match=what):
        time_optimal(robot, path, replace(limits, **changes), payload, intervals)


def test_another_kind_of_pose_is_refused(path: AdeptCycle, limits: Limits) -> None:
    class Turned(Heli4):
        pose_names = ("x", "y", "z", "phi")

    with pytest.raises(InvalidValue, match="path for Turned"):
        time_optimal(Turned(), path, limits, 1.0)


def test_nothing_is_written_to_the_terminal(
    robot: Heli4, path: AdeptCycle, limits: Limits, capfd: pytest.CaptureFixture[str]
) -> None:
    time_optimal(robot, path, limits, 1.0)
    way = RoundedPath(
        robot.pose_names, ((0.0, 0.0, -0.85, 0.0), (0.35, 0.0, -0.75, 0.0), (0.35, 0.0, -0.65, 0.0)), (0.05,)
    )
    with pytest.raises(PathBeyondLimit):
        time_optimal(robot, way, replace(limits, torque=6.351), 1.0)
    assert capfd.readouterr() == ("", "")
