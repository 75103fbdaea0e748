"""Inverse and forward model undo each other and close every loop, all over the workspace."""

import numpy as np
import pytest

from kinematics import Heli4
from tests.kinematics.by_hand import OBLIQUE, ByHand, cylinder, random_geometry
from tests.sizes import few_or_many


def assert_round_trip(robot: Heli4, poses: np.ndarray, joint_error: float = 1e-12) -> None:
    joints = robot.inverse(poses)
    assert not np.isnan(joints).any()
    found = robot.forward(joints)
    assert np.abs(robot.inverse(found) - joints).max() < joint_error
    assert np.abs(found - poses)[:, :3].max() < 1e-12
    assert np.abs(found - poses)[:, 3].max() < 1e-11
    assert np.abs(ByHand(robot.geometry).gaps(found, joints)).max() < 1e-14


@few_or_many(50_000, 1_000_000)
def test_poses_of_the_workspace_come_back(count):
    assert_round_trip(Heli4(), cylinder(count, seed=1))


@pytest.mark.parametrize("zeroed", [(0,), (1,), (0, 1), (0, 3), (0, 1, 3)], ids=str)
def test_planes_where_the_papers_forward_model_divides_by_zero(zeroed):
    poses = cylinder(20_000, seed=2)
    poses[:, list(zeroed)] = 0.0
    assert_round_trip(Heli4(), poses)


def test_home():
    robot = Heli4()
    assert_round_trip(robot, np.array([robot.home]))


def test_oblique_limbs_at_two_heights_with_a_left_handed_screw():
    assert_round_trip(Heli4(OBLIQUE), cylinder(100_000, seed=3, radius=0.3))


def test_edge_of_the_workspace():
    poses = cylinder(50_000, seed=4)
    poses[:, :2] *= 0.5 / np.linalg.norm(poses[:, :2], axis=1, keepdims=True)
    poses[:, 2] = np.where(np.arange(len(poses)) % 2, -0.8, -0.6)
    poses[:, 3] = np.where(np.arange(len(poses)) % 4 < 2, -np.pi, np.pi)
    assert_round_trip(Heli4(), poses)


def test_many_turns_of_a_long_screw():
    poses = cylinder(1_000, seed=5, radius=0.1, theta=8 * np.pi)
    assert_round_trip(Heli4(Heli4.Geometry(pitch=0.005)), poses)


@few_or_many(30, 1000)
def test_random_geometries(count):
    rng = np.random.default_rng(6)
    for _ in range(count):
        geometry = random_geometry(rng)
        robot = Heli4(geometry)
        poses = cylinder(40, seed=7, radius=0.2, z=(-0.75, -0.65))
        poses = poses[~np.isnan(robot.inverse(poses)).any(axis=-1)]
        assert len(poses) > 20, geometry
        assert_round_trip(robot, poses)
