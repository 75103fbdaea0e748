"""A move keeps the joints' limits, and ends where it should, at rest."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from ruckig import Result

from kinematics import (
    Delta,
    GoughStewart,
    Heli4,
    InvalidShape,
    InvalidValue,
    Redundant3T1R,
    UnreachablePose,
    actuator_motion,
)
from trajectory import (
    AdeptCycle,
    Cycle,
    Limits,
    LimitsExceeded,
    Move,
    MoveRefused,
    TimingFailed,
    plan_move,
    plan_stop,
    read_setpoints,
)
from trajectory import write_setpoints as write
from trajectory.moves import ruckig_plan as module

UNITS = ("rad",) * 4
HOME = np.array(Heli4().home)
LIMITS = Limits(speed=20.0, acceleration=250.0, jerk=1e5, torque=127.0)


@pytest.fixture(scope="module")
def target(path: AdeptCycle) -> np.ndarray:
    return path.evaluate(np.array(0.0), 0)[0]


@pytest.fixture(scope="module")
def approach(robot: Heli4, target: np.ndarray) -> Move:
    return plan_move(robot, HOME, target, LIMITS, 1.0, 1e-3, UNITS)


def test_it_goes_from_home_to_the_cycle_s_start_at_rest(robot: Heli4, target: np.ndarray, approach: Move) -> None:
    points = approach.setpoints
    assert points.pose[0] == pytest.approx(robot.home, abs=1e-9)
    assert points.pose[-1] == pytest.approx(target, abs=1e-9)
    for row in (0, -1):
        assert np.abs(points.speed[row]).max() < 1e-9
        assert np.abs(points.acceleration[row]).max() < 1e-9
    assert approach.duration == pytest.approx(points.time[-1], rel=1e-12)
    assert approach.duration / 1e-3 == pytest.approx(round(approach.duration / 1e-3), abs=1e-9)


def test_it_keeps_the_limits_and_uses_one(approach: Move) -> None:
    points = approach.setpoints
    assert np.abs(points.speed).max() <= 20.0
    assert np.abs(points.acceleration).max() <= 250.0 * (1 + 1e-9)
    assert np.abs(np.diff(points.acceleration, axis=0)).max() <= 1e5 * 1e-3 * (1 + 1e-9)
    assert np.abs(points.torque).max() <= 127.0
    assert max(approach.peak_over_limit.values()) == pytest.approx(1.0, abs=0.02)


def test_the_joints_move_on_a_straight_line(approach: Move) -> None:
    joints = approach.setpoints.joints
    fraction = (joints - joints[0]) / (joints[-1] - joints[0])
    assert np.ptp(fraction, axis=1).max() < 1e-9


def test_its_speeds_and_torques_follow_from_its_motion(robot: Heli4, approach: Move) -> None:
    points = approach.setpoints
    slope = (points.joints[2:] - points.joints[:-2]) / 2e-3
    assert np.abs(slope - points.speed[1:-1]).max() < 1e5 * 1e-6
    points.require_consistent(robot)
    power = (points.torque * points.speed).sum(axis=1)
    i, g = robot.inertia, robot.geometry
    platform = sum(i.plate_masses) + 1.0 + 2 * i.rod_mass
    arm = (i.arm_mass * i.arm_centre + i.rod_mass / 2) * g.arm_length
    fall = platform * (points.pose[-1, 2] - points.pose[0, 2])
    swing = arm * (np.cos(points.joints[-1]) - np.cos(points.joints[0])).sum()
    assert power.sum() * 1e-3 == pytest.approx(9.80665 * (fall + swing), rel=2e-3)


def test_it_can_start_elsewhere(robot: Heli4, target: np.ndarray) -> None:
    start = np.array([0.1, 0.1, -0.75, 0.5])
    found = plan_move(robot, start, target, replace(LIMITS, acceleration=200.0), 1.0, 1e-3, UNITS)
    assert found.setpoints.pose[0] == pytest.approx(start, abs=1e-9)


def test_where_the_target_is_the_start_it_rests_for_a_period(robot: Heli4) -> None:
    found = plan_move(robot, HOME, HOME, LIMITS, 1.0, 1e-3, UNITS)
    assert found.duration == 1e-3
    assert np.abs(found.setpoints.speed).max() == 0.0
    assert found.setpoints.pose == pytest.approx(np.tile(robot.home, (2, 1)), abs=1e-9)


def test_its_set_points_are_written_and_read(tmp_path_factory: pytest.TempPathFactory, approach: Move) -> None:
    file = tmp_path_factory.mktemp("approach") / "approach.csv"
    write(file, approach.setpoints)
    back = read_setpoints(file)
    assert np.array_equal(back.table(), approach.setpoints.table())
    assert back.header["laws"] == ["ruckig"]


def test_a_torque_beyond_its_limit_is_refused(robot: Heli4, target: np.ndarray) -> None:
    """By joint, time, value and limit."""
    with pytest.raises(LimitsExceeded, match=r"torque at .* \(q\d at t = .* s: .*, limit 127\)") as caught:
        plan_move(robot, HOME, target, replace(LIMITS, acceleration=450.0), 1.0, 1e-3, UNITS)
    peak = caught.value.peaks["torque"]
    assert peak.value > peak.limit == 127.0
    assert peak.ratio == caught.value.failures["torque"]
    free = plan_move(robot, HOME, target, replace(LIMITS, acceleration=450.0, torque=None), 1.0, 1e-3, UNITS)
    joint = robot.actuator_names.index(peak.joint)
    asked = abs(free.setpoints.torque[round(peak.time / 1e-3), joint])
    assert abs(asked - peak.value) < 0.05 * peak.limit


@pytest.mark.parametrize("field", ["acceleration", "jerk"])
def test_it_needs_acceleration_and_jerk_limits(robot: Heli4, target: np.ndarray, field: str) -> None:
    with pytest.raises(InvalidValue, match=field):
        plan_move(robot, HOME, target, replace(LIMITS, **{field: None}), 1.0, 1e-3, UNITS)


def test_it_does_not_take_a_tool_limit_that_it_cannot_keep(robot: Heli4, target: np.ndarray) -> None:
    with pytest.raises(InvalidValue, match="tool_speed"):
        plan_move(robot, HOME, target, replace(LIMITS, tool_speed=1.0), 1.0, 1e-3, UNITS)


@pytest.mark.parametrize("period", [0.0, math.nan])
def test_an_impossible_period_is_refused(robot: Heli4, target: np.ndarray, period: float) -> None:
    with pytest.raises(InvalidValue, match="period"):
        plan_move(robot, HOME, target, LIMITS, 1.0, period, UNITS)


def test_a_target_out_of_reach_is_refused(robot: Heli4) -> None:
    with pytest.raises(UnreachablePose):
        plan_move(robot, HOME, np.array([0.0, 0.0, -1.3, 0.0]), LIMITS, 1.0, 1e-3, UNITS)


def test_anything_but_success_is_an_error(robot: Heli4, target: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    class Failing:
        def __init__(self, *_: object) -> None: ...

        def calculate(self, *_: object) -> Result:
            return Result.ErrorExecutionTimeCalculation

    monkeypatch.setattr(module, "Ruckig", Failing)
    with pytest.raises(TimingFailed, match="ErrorExecutionTimeCalculation"):
        plan_move(robot, HOME, target, LIMITS, 1.0, 1e-3, UNITS)


def test_a_redundant_robot_moves_on_a_line_of_its_pose_with_all_joints_within_their_limits() -> None:
    robot, limits = Redundant3T1R(), Limits(speed=1.0, acceleration=8.0, jerk=300.0)
    start, end = np.array([0.1, -0.1, 0.05, -0.4]), np.array([0.3, 0.2, -0.1, 0.6])
    points = plan_move(robot, start, end, limits, 1.0, 1e-3, robot.actuator_units).setpoints
    assert points.pose[[0, -1]] == pytest.approx(np.stack([start, end]), abs=1e-12)
    assert np.abs(robot.closure_residual(points.pose, points.joints)).max() < 1e-14
    share = (points.pose - start) / (end - start)
    assert np.ptp(share, axis=1).max() < 1e-9
    slope = (points.joints[2:] - points.joints[:-2]) / 2e-3
    assert np.abs(slope - points.speed[1:-1]).max() < 300.0 * 1e-6
    for values, most in ((points.speed, 1.0), (points.acceleration, 8.0)):
        assert np.abs(values).max() <= most * (1 + 1e-9)
    assert max(np.abs(points.speed).max() / 1.0, np.abs(points.acceleration).max() / 8.0) > 0.8


def test_a_target_in_another_assembly_mode_is_refused_though_the_joints_are_the_same() -> None:
    """A hexapod above and below its base has the same legs; every way between them passes a singularity."""
    robot, limits = GoughStewart(), Limits(speed=1.0, acceleration=10.0, jerk=1e3)
    start = np.array([0.02, 0.01, 0.6, 0.1, 0.0, 0.0])
    target = start * [1, 1, -1, -1, -1, 1]
    assert np.abs(robot.inverse(start) - robot.inverse(target)).max() < 1e-12
    with pytest.raises(MoveRefused, match="a singularity"):
        plan_move(robot, start, target, limits, 1.0, 1e-3, robot.actuator_units)


def test_a_redundant_robot_slows_down_until_its_torque_suffices() -> None:
    robot, limits = Redundant3T1R(), Limits(speed=2.0, acceleration=30.0, jerk=3e3)
    start, end = np.array([-0.2, -0.1, 0.05, -0.4]), np.array([0.3, 0.2, -0.1, 0.6])
    free = plan_move(robot, start, end, limits, 1.0, 1e-3, robot.actuator_units)
    most = np.abs(free.setpoints.torque).max()
    held = plan_move(robot, start, end, replace(limits, torque=0.6 * most), 1.0, 1e-3, robot.actuator_units)
    assert np.abs(held.setpoints.torque).max() <= 0.6 * most * (1 + 1e-9)
    assert free.duration < held.duration < 2.0 * free.duration


def test_a_start_of_another_kind_of_pose_is_named() -> None:
    with pytest.raises(InvalidShape, match="start"):
        plan_move(Delta(), HOME, np.zeros(3), LIMITS, 1.0, 1e-3, ("rad",) * 3)


def test_a_move_that_leaves_the_joints_ranges_is_refused_by_margin_time_and_pose() -> None:
    start, end = np.array([0.0, 0.0, -0.7]), np.array([0.2, 0.0, -0.8])
    low = float(Delta().inverse(end).min())
    robot = Delta(ranges=Delta.Ranges(joints=(low + 0.05, 3.8)))
    with pytest.raises(MoveRefused, match=r"joint_travel of -0\.05") as caught:
        plan_move(robot, start, end, Limits(speed=5.0, acceleration=50.0, jerk=1e4), 0.5, 1e-3, ("rad",) * 3)
    assert robot.margin("joint_travel", np.array(caught.value.pose)) < -0.05
    assert caught.value.time > 0.0


def test_a_line_of_the_joints_that_leaves_a_range_gives_way_to_one_of_the_pose() -> None:
    """Between these poses the joints' own line swings the rods further out than the straight line of the tool does."""
    start, end = np.array([0.3, 0.33, -0.9]), np.array([0.25, 0.34, -0.61])
    limits = Limits(speed=5.0, acceleration=50.0, jerk=1e4)
    free = plan_move(Delta(), start, end, limits, 0.5, 1e-3, ("rad",) * 3).setpoints.pose
    line = start + np.linspace(0.0, 1.0, 101)[:, None] * (end - start)
    least = [
        float(Delta(ranges=Delta.Ranges(passive=(1.5, 1.5))).margin("passive_joint", p).min()) for p in (free, line)
    ]
    assert least[0] < least[1]
    most = 1.5 - (least[0] + least[1]) / 2
    held = Delta(ranges=Delta.Ranges(passive=(most, most)))
    points = plan_move(held, start, end, limits, 0.5, 1e-3, ("rad",) * 3).setpoints
    assert np.ptp((points.pose - start) / (end - start), axis=1).max() < 1e-9
    assert held.margin("passive_joint", points.pose).min() >= 0.0


@pytest.mark.parametrize(
    ("limits", "found"),
    [
        (Limits(speed=5e-4, acceleration=30.0, jerk=500.0), r"the move takes 4\d\d\.\d* s, more than 400 s"),
        (Limits(speed=1.0, acceleration=30.0, jerk=1e-8), r"the move takes \d{3}\.?\d* s, more than 400 s"),
        (Limits(speed=1e-5, acceleration=30.0, jerk=500.0), "it would take longer than ruckig can plan"),
    ],
)
def test_a_move_too_slow_to_plan_says_so_at_once(limits: Limits, found: str) -> None:
    with pytest.raises(TimingFailed, match=found):
        plan_move(Delta(), np.array([0.0, 0.0, -0.75]), np.array([0.1, 0.0, -0.8]), limits, 0.5, 1e-3, ("rad",) * 3)


# Stops


@pytest.fixture(scope="module")
def braking(robot: Heli4, cycle: Cycle) -> list[tuple[np.ndarray, Move]]:
    """Stops from states all over the way there, where its accelerations are within those of the stop."""
    motion = cycle.pieces[0].motion
    tool = motion.at(np.linspace(0.0, motion.duration, 41)[1:-1])
    states = np.stack(actuator_motion(robot, *tool)[:3], axis=1)
    able = [state for state in states if np.abs(state[2]).max() < STOPPING.acceleration]
    return [(state, plan_stop(robot, tuple(state), STOPPING, 1.0, 1e-3, UNITS)) for state in able]


STOPPING = Limits(speed=20.0, acceleration=400.0, jerk=1e5)


def test_a_stop_goes_from_its_state_to_rest_within_the_limits(braking: list[tuple[np.ndarray, Move]]) -> None:
    assert len(braking) > 10
    for (joints, speed, acceleration), stop in braking:
        points = stop.setpoints
        assert points.joints[0] == pytest.approx(joints, abs=1e-12)
        assert points.speed[0] == pytest.approx(speed, abs=1e-12)
        assert points.acceleration[0] == pytest.approx(acceleration, abs=1e-9)
        assert np.abs(points.speed[-1]).max() < 1e-9
        assert np.abs(points.acceleration[-1]).max() < 1e-6
        assert max(stop.peak_over_limit.values()) <= 1.0 + 1e-9


def test_a_stop_that_needs_too_much_torque_is_refused(robot: Heli4, braking: list[tuple[np.ndarray, Move]]) -> None:
    state, stop = max(braking, key=lambda found: np.abs(found[1].setpoints.torque).max())
    assert np.abs(stop.setpoints.torque).max() > 127.0
    with pytest.raises(LimitsExceeded, match="torque"):
        plan_stop(robot, tuple(state), replace(STOPPING, torque=127.0), 1.0, 1e-3, UNITS)


def test_a_stop_takes_as_long_as_its_fastest_joint_needs(robot: Heli4) -> None:
    """From v at rest in acceleration, v > a^2 / j: the trapezoid's v / a + a / j, in whole periods."""
    joints = robot.inverse(HOME)
    limits = Limits(speed=20.0, acceleration=100.0, jerk=1e4)
    stop = plan_stop(robot, (joints, np.array([2.0, -1.0, 2.0, -1.0]), np.zeros(4)), limits, 1.0, 1e-3, UNITS)
    exact = 2.0 / 100.0 + 100.0 / 1e4
    assert exact - 1e-9 <= stop.duration <= exact + 1e-3 + 1e-9
    travelled = stop.setpoints.joints[-1] - joints
    assert travelled == pytest.approx(np.array([2.0, -1.0, 2.0, -1.0]) * exact / 2, rel=0.05)


def test_a_stop_from_a_state_beyond_the_limits_is_refused(robot: Heli4) -> None:
    state = (robot.inverse(HOME), np.zeros(4), np.array([300.0, 0.0, 0.0, 0.0]))
    with pytest.raises((TimingFailed, LimitsExceeded), match=r"ruckig|acceleration"):
        plan_stop(robot, state, LIMITS, 1.0, 1e-3, UNITS)


def test_a_stop_whose_rest_is_out_of_reach_is_refused(robot: Heli4) -> None:
    state = (robot.inverse(np.array([0.0, 0.0, -1.09, 0.0])), np.full(4, 15.0), np.zeros(4))
    with pytest.raises(MoveRefused, match=r"no pose|another working mode"):
        plan_stop(robot, state, replace(LIMITS, torque=None), 1.0, 1e-3, UNITS)


@pytest.mark.parametrize(
    ("more", "error", "says"),
    [
        ({"position": (-0.01, 0.01)}, MoveRefused, "not within -0.01 to 0.01"),
        ({"stall_torque": 5.0, "no_load_speed": 1.0}, LimitsExceeded, "torque at speed"),
        ({"rms_torque": 0.01}, InvalidValue, "rms_torque"),
    ],
)
def test_no_limit_is_dropped_in_silence(more: dict[str, Any], error: type[Exception], says: str) -> None:
    limits = Limits(speed=5.0, acceleration=100.0, jerk=5000.0, **more)
    with pytest.raises(error, match=says):
        plan_move(
            Heli4(), np.array([-0.15, 0, -0.8, 0]), np.array([0.15, 0, -0.75, 1.0]), limits, 1.0, 0.001, ("rad",) * 4
        )
