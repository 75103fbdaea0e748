"""Gough-Stewart: the forward model, from a start near, returns what the inverse one came from."""

from __future__ import annotations

import numpy as np

from kinematics import GoughStewart
from kinematics.robots.gough_stewart.forward import step
from tests.kinematics.robots.gough_stewart.gough_stewart_by_hand import (
    anywhere,
    pose_errors,
    random_poses,
    random_robot,
)
from tests.sizes import few_or_many


@few_or_many(1, 10)
def test_random_poses_come_back_from_their_leg_lengths_and_the_last_pose(count: int) -> None:
    robot, rng = GoughStewart(), np.random.default_rng(3)
    for _ in range(count):
        poses = random_poses(rng, 100_000 if count > 1 else 20_000)
        last = poses + rng.uniform(-1e-4, 1e-4, poses.shape)
        found = robot.newton(robot.inverse(poses), last)
        assert found.converged.all()
        assert np.abs(found.pose - poses).max() < 1e-11


@few_or_many(30, 1000)
def test_random_geometries_with_random_frames_close_the_round_trip(count: int) -> None:
    rng = np.random.default_rng(4)
    worst, tested = 0.0, 0
    for _ in range(count):
        robot = random_robot(rng)
        poses = anywhere(rng, 4)
        found = robot.forward(robot.inverse(poses), poses + 1e-5)
        regular = np.linalg.cond(robot.lengths_and_jacobian(poses)[1]) < 1000.0
        worst = max(worst, float(pose_errors(found, poses)[regular].max(initial=0.0)))
        tested += int(regular.sum())
    assert worst < 1e-11
    assert tested > 3.8 * count


def test_default_robot_reaches_its_poses_from_home() -> None:
    robot, poses = GoughStewart(), random_poses(np.random.default_rng(5), 20_000)
    np.testing.assert_allclose(robot.forward(robot.inverse(poses)), poses, rtol=0, atol=1e-11)


def test_newtons_method_squares_the_error_at_each_step() -> None:
    """log-log slope 2 from 1e-2 down to 1e-6 of the pose's error, over 500 random poses."""
    robot, rng = GoughStewart(), np.random.default_rng(12)
    poses = random_poses(rng, 500)
    joints, direction = robot.inverse(poses), rng.normal(size=poses.shape)
    sizes = np.array([1e-2, 1e-3, 1e-4])
    errors = []
    for size in sizes:
        after, _ = step(robot, poses + size * direction, joints)
        errors.append(pose_errors(after, poses))
    slopes = np.diff(np.log(errors), axis=0) / np.diff(np.log(sizes))[:, None]
    assert 1.9 < np.median(slopes) < 2.1
    assert np.quantile(slopes, 0.02) > 1.7


def test_forward_says_where_it_did_not_converge_and_gives_nan_there() -> None:
    robot = GoughStewart()
    joints = np.array([robot.inverse(np.array(robot.home)), [3.0, 0.1, 3.0, 0.1, 3.0, 0.1]])
    found = robot.newton(joints)
    np.testing.assert_array_equal(found.converged, [True, False])
    np.testing.assert_array_equal(np.isnan(found.pose).all(axis=1), [False, True])
    assert found.iterations[1] == 30
    assert found.residual[0] < 1e-14 < 1e-3 < found.residual[1]
    near = robot.inverse(np.array(robot.home) + 0.1)
    assert not robot.newton(near, iterations=1).converged
    assert np.isnan(robot.newton(near, iterations=1).pose).all()
    assert robot.newton(near, iterations=6).converged


def test_what_forward_finds_from_afar_closes_every_leg() -> None:
    """From a random start it may end in another assembly mode, or nowhere, but never at a wrong pose."""
    rng = np.random.default_rng(13)
    for robot in (GoughStewart(), random_robot(rng)):
        joints = robot.inverse(np.repeat(anywhere(rng, 200), 10, axis=0))
        found = robot.newton(joints, anywhere(rng, 2000))
        assert found.converged.mean() > 0.5
        assert np.abs(robot.inverse(found.pose) - joints)[found.converged].max() < 1e-12


def test_forward_broadcasts_one_start_over_many_joints_and_one_set_of_joints_over_many_starts() -> None:
    robot, poses = GoughStewart(), random_poses(np.random.default_rng(14), 6).reshape(2, 3, 6)
    np.testing.assert_allclose(robot.forward(robot.inverse(poses), robot.home), poses, atol=1e-12)
    found = robot.forward(robot.inverse(poses[0, 0]), poses)
    np.testing.assert_allclose(found, np.broadcast_to(poses[0, 0], (2, 3, 6)), atol=1e-12)


def test_pitch_of_a_quarter_turn_is_no_obstacle() -> None:
    robot = random_robot(np.random.default_rng(15))
    pose = np.array([0.1, 0.2, 0.3, 0.4, np.pi / 2, 0.0])
    found = robot.forward(robot.inverse(pose), pose + np.array([0.01, 0.0, 0.02, 0.03, -0.02, 0.01]))
    assert pose_errors(found, pose) < 1e-7  # the angles of a matrix near gimbal lock keep half the digits
    assert np.abs(robot.inverse(found) - robot.inverse(pose)).max() < 1e-12
