"""`forward` gives the pose of home's aspect: joined to home without a singularity, its limbs in the same mode."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from kinematics import Heli4, Mechanism, Par4, Planar3PRR, Planar3RPR, Planar3RRR, Redundant3T1R

SLIDES = Redundant3T1R()
MIXED = SLIDES.inverse(SLIDES.home) * [1, -1, 1, -1, -1, -1]  # at home B_i are at x = -+ d/2, so nearly mirror images
ELBOWS = Heli4(home_joints=-Heli4().inverse(Heli4().home) * [1, -1, 1, -1])


def rays(robot: Mechanism, count: int, seed: int, share: float) -> np.ndarray:
    """Poses on rays from home up to where a limb cannot reach, or the robot comes near to a singularity; (k, n)."""
    rng = np.random.default_rng(seed)
    along = rng.uniform(-share, share, (count, len(robot.pose_names))) * robot.pose_units()
    poses = robot.home + np.linspace(0.0, 1.0, 150)[:, None, None] * along
    j_x = robot.jacobians(poses)[1]
    inside = np.isfinite(robot.inverse(poses)).all(axis=-1) & (robot.margin("det_J_x", poses) > 1e-3)
    if j_x.shape[-1] == j_x.shape[-2]:
        sides = np.sign(np.linalg.det(np.nan_to_num(j_x)))
        inside &= sides == sides[0]
    return poses[np.logical_and.accumulate(inside, axis=0)]


@pytest.mark.parametrize(
    "robot",
    [
        Par4(),
        Par4(home=[0.0, 0.0, 0.7, 0.0]),
        Par4(Par4.Geometry(azimuths=(0.3, 3.3, 1.6, 4.6)), home=[0.1, 0.0, -0.7, 1.0]),
        ELBOWS,
        Heli4(Heli4.Geometry(azimuths=(0.1, -3.0, -1.7, 1.8), height_step=-0.1, pitch=-0.05), home=[0, 0, 0.7, 0.0]),
        Redundant3T1R(home_joints=MIXED),
    ],
    ids=["Par4", "above", "oblique", "elbows", "clockwise", "slides"],
)
def test_it_undoes_the_inverse_wherever_no_singularity_is_between_home_and_the_pose(robot: Mechanism) -> None:
    poses = rays(robot, 60, seed=1, share=0.9)
    assert len(poses) > 2000
    assert robot.apart(robot.forward(robot.inverse(poses)), poses).max() < 1e-8


@pytest.mark.parametrize("kind", [Planar3RPR, Planar3PRR, Planar3RRR])
def test_a_planar_robot_s_pose_has_the_limbs_of_its_working_mode(kind: Any) -> None:
    robot = kind(ranges=kind.Ranges(joints=(-10.0, 10.0)))
    poses = rays(robot, 60, seed=2, share=2.0)
    assert len(poses) > 2000
    joints = robot.inverse(poses)
    found = robot.forward(joints)
    gap = robot.inverse(found) - joints
    turns = np.array([unit == "rad" for unit in robot.joint_units])
    assert np.abs(np.where(turns, 2 * np.sin(gap / 2), gap)).max() < 1e-7
    sides = np.sign(np.linalg.det(robot.jacobians(np.stack([found, poses]))[1]))
    assert np.ptp(sides) == 0.0


def test_the_pose_follows_slides_on_both_sides_from_a_known_one_too() -> None:
    """Six slides on a straight line of their joints fit no pose of four freedoms in between, but do at its end."""
    robot = Redundant3T1R()
    poses = rays(robot, 30, seed=3, share=0.3)
    assert len(poses) > 1000
    assert robot.apart(robot.forward(robot.inverse(poses), near=robot.home), poses).max() < 1e-9
    wrong = robot.inverse(poses) + 1e-3 * np.eye(6)[5]
    assert np.isnan(robot.forward(wrong, near=robot.home)).all()


def test_a_closed_form_that_loses_digits_is_made_exact() -> None:
    """Elbows on both sides bring the halves' horizontal lines near to parallel, by which the closed form divides."""
    poses = rays(ELBOWS, 100, seed=4, share=0.9)
    joints = ELBOWS.inverse(poses)
    found = ELBOWS.forward(joints)
    assert np.abs(ELBOWS.closure_gap(found, joints)).max() < 1e-11
    for k in range(0, len(poses), max(len(poses) // 40, 1)):
        modes = ELBOWS.assembly_modes(joints[k])
        assert ELBOWS.apart(modes, poses[k]).min() < 1e-8
