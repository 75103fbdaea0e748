"""The approach keeps the joints' limits, and ends where the cycle starts, at rest."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from ruckig import Result

from kinematics import Heli4, InvalidValue, UnreachablePose
from trajectory import AdeptCycle, Approach, Limits, LimitsExceeded, TimingFailed, plan_approach, read_setpoints
from trajectory import approach as module
from trajectory import write_setpoints as write

UNITS = ("rad",) * 4
LIMITS = Limits(speed=20.0, acceleration=250.0, jerk=1e5, torque=127.0)


@pytest.fixture(scope="module")
def target(path: AdeptCycle) -> np.ndarray:
    return path.evaluate(np.array(0.0), 0)[0]


@pytest.fixture(scope="module")
def approach(robot: Heli4, target: np.ndarray) -> Approach:
    return plan_approach(robot, target, LIMITS, 1.0, 1e-3, UNITS)


def test_it_goes_from_home_to_the_cycle_s_start_at_rest(robot: Heli4, target: np.ndarray, approach: Approach) -> None:
    points = approach.setpoints
    assert points.pose[0] == pytest.approx(robot.home, abs=1e-9)
    assert points.pose[-1] == pytest.approx(target, abs=1e-9)
    for row in (0, -1):
        assert np.abs(points.speed[row]).max() < 1e-9
        assert np.abs(points.acceleration[row]).max() < 1e-9
    assert approach.duration == pytest.approx(points.time[-1], rel=1e-12)
    assert approach.duration / 1e-3 == pytest.approx(round(approach.duration / 1e-3), abs=1e-9)


def test_it_keeps_the_limits_and_uses_one(approach: Approach) -> None:
    points = approach.setpoints
    assert np.abs(points.speed).max() <= 20.0
    assert np.abs(points.acceleration).max() <= 250.0 * (1 + 1e-9)
    assert np.abs(np.diff(points.acceleration, axis=0)).max() <= 1e5 * 1e-3 * (1 + 1e-9)
    assert np.abs(points.torque).max() <= 127.0
    assert max(approach.peak_over_limit.values()) == pytest.approx(1.0, abs=0.02)


def test_the_joints_move_on_a_straight_line(approach: Approach) -> None:
    joints = approach.setpoints.joints
    fraction = (joints - joints[0]) / (joints[-1] - joints[0])
    assert np.ptp(fraction, axis=1).max() < 1e-9


def test_its_speeds_and_torques_follow_from_its_motion(robot: Heli4, approach: Approach) -> None:
    points = approach.setpoints
    slope = (points.joints[2:] - points.joints[:-2]) / 2e-3
    assert np.abs(slope - points.speed[1:-1]).max() < 1e5 * 1e-6
    points.require_consistent(robot)
    power = (points.torque * points.speed).sum(axis=1)
    i, g = robot.inertia, robot.geometry
    platform = sum(i.plate_masses) + 1.0 + 2 * i.rod_pair_mass
    arm = (i.arm_mass * i.arm_centre + i.rod_pair_mass / 2) * g.arm_length
    fall = platform * (points.pose[-1, 2] - points.pose[0, 2])
    swing = arm * (np.cos(points.joints[-1]) - np.cos(points.joints[0])).sum()
    assert power.sum() * 1e-3 == pytest.approx(9.80665 * (fall + swing), rel=2e-3)


def test_it_can_start_elsewhere(robot: Heli4, target: np.ndarray) -> None:
    start = np.array([0.1, 0.1, -0.75, 0.5])
    found = plan_approach(robot, target, replace(LIMITS, acceleration=200.0), 1.0, 1e-3, UNITS, start)
    assert found.setpoints.pose[0] == pytest.approx(start, abs=1e-9)


def test_where_the_target_is_the_start_it_rests_for_a_period(robot: Heli4) -> None:
    found = plan_approach(robot, np.array(robot.home), LIMITS, 1.0, 1e-3, UNITS)
    assert found.duration == 1e-3
    assert np.abs(found.setpoints.speed).max() == 0.0
    assert found.setpoints.pose == pytest.approx(np.tile(robot.home, (2, 1)), abs=1e-9)


def test_its_set_points_are_written_and_read(tmp_path_factory: pytest.TempPathFactory, approach: Approach) -> None:
    file = tmp_path_factory.mktemp("approach") / "approach.csv"
    write(file, approach.setpoints)
    back = read_setpoints(file)
    assert np.array_equal(back.table(), approach.setpoints.table())
    assert back.header["laws"] == ["ruckig"]


def test_a_torque_beyond_its_limit_is_refused(robot: Heli4, target: np.ndarray) -> None:
    with pytest.raises(LimitsExceeded, match="torque"):
        plan_approach(robot, target, replace(LIMITS, acceleration=450.0), 1.0, 1e-3, UNITS)


@pytest.mark.parametrize("field", ["acceleration", "jerk"])
def test_it_needs_acceleration_and_jerk_limits(robot: Heli4, target: np.ndarray, field: str) -> None:
    with pytest.raises(InvalidValue, match=field):
        plan_approach(robot, target, replace(LIMITS, **{field: None}), 1.0, 1e-3, UNITS)


def test_it_does_not_take_a_tool_limit_that_it_cannot_keep(robot: Heli4, target: np.ndarray) -> None:
    with pytest.raises(InvalidValue, match="tool_speed"):
        plan_approach(robot, target, replace(LIMITS, tool_speed=1.0), 1.0, 1e-3, UNITS)


@pytest.mark.parametrize("period", [0.0, math.nan])
def test_an_impossible_period_is_refused(robot: Heli4, target: np.ndarray, period: float) -> None:
    with pytest.raises(InvalidValue, match="period"):
        plan_approach(robot, target, LIMITS, 1.0, period, UNITS)


def test_a_target_out_of_reach_is_refused(robot: Heli4) -> None:
    with pytest.raises(UnreachablePose):
        plan_approach(robot, np.array([0.0, 0.0, -1.3, 0.0]), LIMITS, 1.0, 1e-3, UNITS)


def test_anything_but_success_is_an_error(robot: Heli4, target: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    class Failing:
        def __init__(self, *_: object) -> None: ...

        def calculate(self, *_: object) -> Result:
            return Result.ErrorExecutionTimeCalculation

    monkeypatch.setattr(module, "Ruckig", Failing)
    with pytest.raises(TimingFailed, match="ErrorExecutionTimeCalculation"):
        plan_approach(robot, target, LIMITS, 1.0, 1e-3, UNITS)


@pytest.mark.parametrize(("spoiled", "what"), [(np.nan, "no pose"), (0.01, "another working mode")])
def test_a_pose_that_does_not_exist_on_the_way_is_an_error(target: np.ndarray, spoiled: float, what: str) -> None:
    class Broken(Heli4):
        def forward(self, joints: np.ndarray) -> np.ndarray:
            pose = super().forward(joints)
            pose[len(pose) // 2] += spoiled
            return pose

    with pytest.raises(TimingFailed, match=what):
        plan_approach(Broken(), target, LIMITS, 1.0, 1e-3, UNITS)


def test_a_redundant_robot_is_refused(target: np.ndarray) -> None:
    class Redundant(Heli4):
        joint_names = ("q1", "q2", "q3", "q4", "q5")

    with pytest.raises(InvalidValue, match="joints of Redundant"):
        plan_approach(Redundant(), target, LIMITS, 1.0, 1e-3, UNITS)
