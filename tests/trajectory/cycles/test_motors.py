"""A robot whose drives couple its joints is timed, verified and commanded at its motors."""

import numpy as np
import pytest

from kinematics import Peppermill, inverse_dynamics
from trajectory import AdeptCycle, Limits, cycle_setpoints, plan_move, there_and_back, time_optimal

PERIOD = 1e-3
LIMITS = Limits(speed=314.0, torque=7.2)
CONST = 2 * np.pi / 0.10  # 2 pi / p_c of the default


def drives(joints):
    """(A.4) by hand."""
    d, theta = joints[..., :2], joints[..., 2:]
    return np.stack([CONST * d + theta, -CONST * d + theta], axis=-1).reshape(joints.shape)


@pytest.fixture(scope="module")
def cycle():
    path = AdeptCycle.centred((0.0, 0.0, -0.0125), heading=0.6)
    return there_and_back(Peppermill(), path, LIMITS, 1.0, time_optimal)


def test_the_cycle_is_bounded_by_the_motors(cycle):
    """Speeds and torques by hand from the set-points' poses, within the limits and touching one of them."""
    setpoints = cycle_setpoints(cycle, PERIOD, cycle.robot.actuator_units)
    robot = cycle.robot
    motors = drives(robot.inverse(setpoints.pose))
    np.testing.assert_allclose(setpoints.joints, motors, atol=1e-9)
    speed = np.gradient(motors, PERIOD, axis=0)
    assert np.abs(speed).max() < 1.01 * LIMITS.speed
    assert np.abs(setpoints.torque).max() <= LIMITS.torque
    assert max(cycle.pieces[0].timed.verification.peak_over_limit.values()) > 0.99
    at_rest = inverse_dynamics(robot, 1.0, setpoints.pose[:1], np.zeros((1, 4)), np.zeros((1, 4)))
    assert np.abs(at_rest).max() < LIMITS.torque


def test_set_points_are_named_and_counted_at_the_motors(cycle):
    setpoints = cycle_setpoints(cycle, PERIOD, cycle.robot.actuator_units)
    assert setpoints.joint_names == ("1L", "1R", "2L", "2R")
    setpoints.require_consistent(cycle.robot)
    found = cycle.robot.forward(cycle.robot.from_motors(setpoints.joints))
    assert np.abs(found - setpoints.pose).max() < 1e-11


def test_an_approach_moves_the_motors_from_rest_to_rest_within_their_limits():
    robot, target = Peppermill(), np.array([0.15, -0.1, 0.02, 3.0])
    limits = Limits(speed=300.0, acceleration=2e3, jerk=1e6, torque=7.2)
    found = plan_move(robot, np.array(robot.home), target, limits, 1.0, PERIOD, robot.actuator_units)
    motors = found.setpoints.joints
    np.testing.assert_allclose(motors[[0, -1]], drives(robot.inverse(np.stack([robot.home, target]))), atol=1e-6)
    assert np.abs(np.diff(motors, axis=0) / PERIOD).max() <= limits.speed * (1 + 1e-9)
    found.setpoints.require_consistent(robot)
