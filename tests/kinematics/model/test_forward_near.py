"""`forward` from a pose that is known: the pose that is asked for, or none, but never one of another side."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics import Hexa, Redundant3T1R

# The way from home ends just before these poses' joints, on a singularity; a pose beyond it has the same joints.
BESIDE = [
    [0.24377399, -0.28973693, -0.62861756, 0.10467, 0.5603371, -0.5967273],
    [0.11101428, 0.19628163, -0.7534586, -0.74588067, -0.31535871, -0.35594768],
    [0.08522876, 0.28283633, -0.67552088, 0.71311059, 0.58696553, 0.50822702],
]


@pytest.mark.parametrize("behind", [(), (0, 2), (0, 3, 4, 5), (0, 1, 2, 3, 5), (4,)])
def test_the_redundant_robot_is_found_from_any_pose_to_any_other(behind: tuple[int, ...]) -> None:
    """Its region is one aspect, with the slides behind the platform, on both sides of it, or mostly ahead."""
    joints = Redundant3T1R().inverse(Redundant3T1R().home)
    joints[list(behind)] *= -1
    robot = Redundant3T1R(home_joints=joints.tolist())
    rng = np.random.default_rng(0)
    poses, near = rng.uniform([-0.3, -0.3, -0.3, -1.5], [0.3, 0.3, 0.3, 1.5], (2, 100, 4))
    assert robot.forward(robot.inverse(poses), near=near) == pytest.approx(poses, abs=1e-8)


def test_a_hexa_is_never_given_a_pose_beyond_a_singularity_from_home() -> None:
    robot = Hexa()
    joints = robot.inverse(np.array(BESIDE))
    found = robot.forward(joints)
    home = np.linalg.det(robot.jacobians(robot.home)[1])
    sides = np.linalg.det(np.nan_to_num(robot.jacobians(found, joints)[1]))
    assert (np.isnan(found).any(axis=-1) | (sides * home > -1e-6 * home**2)).all()


def test_a_hexa_whose_joints_way_is_singular_is_found_on_a_way_of_the_pose() -> None:
    """Random poses that a straight line joins to home; of the joints' lines to them some meet a singularity."""
    robot = Hexa()
    rng = np.random.default_rng(1)
    poses = np.array(robot.home) + rng.uniform(-1, 1, (1500, 6)) * [0.25, 0.25, 0.25, 0.6, 0.6, 0.6]
    line = np.array(robot.home) + np.linspace(0, 1, 60)[:, None, None] * (poses - robot.home)
    sides = np.linalg.det(np.nan_to_num(robot.jacobians(line)[1]))
    joined = (sides * sides[0] > 0.0).all(axis=0)
    poses = poses[joined]
    found = robot.forward(robot.inverse(poses))
    missing = np.isnan(found).any(axis=-1)
    assert missing.mean() < 0.01
    assert (robot.apart(found[~missing], poses[~missing]) < 1e-6).mean() > 0.99
