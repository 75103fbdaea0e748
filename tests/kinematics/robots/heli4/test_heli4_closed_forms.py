"""Each closed form against the loop closure and against high-precision solutions of it."""

import mpmath as mp
import numpy as np
import pytest

from kinematics import Heli4
from kinematics.evaluation.block_interpreter import evaluate
from tests.kinematics.by_hand import OBLIQUE, ByHand, cylinder

ROBOTS = [Heli4(), Heli4(OBLIQUE)]
BOTH = pytest.mark.parametrize("robot", ROBOTS, ids=["prototype", "oblique"])


@BOTH
def test_closure_is_half_the_difference_of_squares(robot):
    rng = np.random.default_rng(1)
    poses, joints = cylinder(1000, seed=1), rng.uniform(-np.pi, np.pi, (1000, 4))
    rods = ByHand(robot.geometry).rods(poses, joints)
    expected = ((rods**2).sum(-1) - robot.geometry.rod_length**2) / 2
    assert np.abs(robot.closure_residual(poses, joints) - expected).max() < 1e-15


@BOTH
def test_inverse_closes_every_loop(robot):
    poses = cylinder(100_000, seed=2, radius=0.3)
    assert np.abs(ByHand(robot.geometry).gaps(poses, robot.inverse(poses))).max() < 1e-15


def gap_in_high_precision(geometry, limb, pose, q):
    """|A B|^2 - l^2 of one limb, every number exact to 50 digits."""
    g, a = geometry, mp.mpf(geometry.azimuths[limb])
    upper = limb >= 2
    climb = mp.mpf(g.pitch) / (2 * mp.pi) * mp.mpf(pose[3]) if upper else 0
    reach = mp.mpf(g.base_radius) + mp.mpf(g.arm_length) * mp.sin(q) - mp.mpf(g.platform_radius)
    height = mp.mpf(g.arm_length) * mp.cos(q) - mp.mpf(g.plate_offset) - climb - mp.mpf(pose[2])
    across = reach * mp.cos(a) - mp.mpf(pose[0]), reach * mp.sin(a) - mp.mpf(pose[1]), height
    return mp.fsum(v**2 for v in across) - mp.mpf(g.rod_length) ** 2


@BOTH
def test_inverse_is_right_to_the_last_digits(robot):
    with mp.workdps(50):
        for pose in cylinder(40, seed=3, radius=0.4):
            for limb, q in enumerate(robot.inverse(pose)):
                exact = mp.findroot(
                    lambda v, pose=pose, limb=limb: gap_in_high_precision(robot.geometry, limb, pose, v), q
                )
                assert abs(exact - q) < 4e-15


@BOTH
def test_inverse_keeps_the_elbow_out(robot):
    """The elbow lies on the outer side of the line from the platform to the actuator, in the arm's plane."""
    hand, poses = ByHand(robot.geometry), cylinder(100_000, seed=4, radius=0.35)
    joints = robot.inverse(poses)
    to_elbow, to_actuator = hand.arms(joints) - hand.platforms(poses), hand.actuators - hand.platforms(poses)
    out_e, out_a = ((v * hand.u).sum(-1) for v in (to_elbow, to_actuator))
    assert (out_e * to_actuator[..., 2] - out_a * to_elbow[..., 2] > 0).all()


def _cosines_and_sines(robot, model):
    return [model.pose], list(robot.joint_cosines_and_sines(model.pose, model.g, model.mode))


@BOTH
def test_cosines_and_sines_are_the_joints_own(robot):
    poses = cylinder(10_000, seed=5, radius=0.35)
    cosines, sines = evaluate(robot.program(_cosines_and_sines), poses)
    joints = robot.inverse(poses)
    assert np.abs(cosines - np.cos(joints)).max() < 1e-14
    assert np.abs(sines - np.sin(joints)).max() < 1e-14


@BOTH
def test_reach_is_the_slack_left_in_the_rods(robot):
    """A limb reaches exactly as long as some arm angle puts the rod's ends at the rod's length."""
    hand, poses = ByHand(robot.geometry), cylinder(300, seed=6, radius=1.2, z=(-1.2, -0.1))
    circle = np.linspace(-np.pi, np.pi, 4_001)[:, None, None] * np.ones(4)
    lengths = np.linalg.norm(hand.rods(poses, circle), axis=-1)
    slack = np.minimum(robot.geometry.rod_length - lengths.min(0), lengths.max(0) - robot.geometry.rod_length)
    assert np.abs(robot.margin("reach", poses) - slack.min(-1)).max() < 2e-6
    assert 20 < (slack.min(-1) > 0).sum() < 280


def test_a_pose_can_be_reached_exactly_where_the_margin_says_so():
    robot, poses = Heli4(), cylinder(100_000, seed=7, radius=1.2, z=(-1.2, -0.1))
    reach = robot.margin("reach", poses)
    clear = np.abs(reach) > 1e-12
    assert np.array_equal(np.isnan(robot.inverse(poses))[clear].all(-1), reach[clear] < 0)
    assert np.array_equal(np.isnan(robot.inverse(poses)).any(-1), np.isnan(robot.inverse(poses)).all(-1))
