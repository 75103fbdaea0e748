"""J_q and J_x against (53) built by hand, and against differences of the closure and of the inverse model."""

import numpy as np
import pytest

from kinematics import Heli4
from tests.kinematics.by_hand import OBLIQUE, UPPER, ByHand, cylinder
from tests.kinematics.numeric import differences

BOTH = pytest.mark.parametrize("robot", [Heli4(), Heli4(OBLIQUE)], ids=["prototype", "oblique"])
POSES = cylinder(2_000, seed=1, radius=0.3)


@BOTH
def test_both_are_the_papers_with_the_sign_of_p_that_its_points_ask_for(robot):
    hand, joints = ByHand(robot.geometry), robot.inverse(POSES)
    rods = hand.rods(POSES, joints)
    j_q, j_x = robot.jacobians(POSES)
    diagonal = (hand.arm_tangents(joints) * rods).sum(-1)
    assert np.abs(j_q - diagonal[..., None] * np.eye(4)).max() < 1e-14
    assert np.abs(j_x[..., :3] - rods).max() < 1e-14
    assert np.abs(j_x[..., 3] - hand.pitch * UPPER * rods[..., 2]).max() < 1e-16


@BOTH
def test_both_are_derivatives_of_the_closure(robot):
    joints = robot.inverse(POSES)
    j_q, j_x = robot.jacobians(POSES)
    by_joints = differences(lambda q: robot.closure_residual(POSES, q), joints, 1e-3)
    by_pose = differences(lambda x: robot.closure_residual(x, joints), POSES, 1e-3)
    assert np.abs(j_q - by_joints).max() < 1e-11
    assert np.abs(j_x + by_pose).max() < 1e-11


@BOTH
def test_inverse_jacobian_is_the_derivative_of_the_inverse_model(robot):
    expected = differences(robot.inverse, POSES, 1e-4)
    assert np.abs(robot.inverse_jacobian(POSES) - expected).max() < 1e-8


@BOTH
def test_inverse_jacobian_solves_j_q_q_dot_equals_j_x_t(robot):
    j_q, j_x = robot.jacobians(POSES)
    assert np.abs(j_q @ robot.inverse_jacobian(POSES) - j_x).max() < 1e-14


@BOTH
def test_inverse_jacobian_undoes_the_derivative_of_the_forward_model(robot):
    joints = robot.inverse(POSES)
    product = robot.inverse_jacobian(POSES) @ differences(robot.forward, joints, 1e-4)
    assert np.abs(product - np.eye(4)).max() < 1e-7


@BOTH
@pytest.mark.parametrize("name", ["J_q", "det_J_q", "det_J_x"])
def test_normalised_margins_are_the_determinants_over_their_scales(robot, name):
    g, hand = robot.geometry, ByHand(robot.geometry)
    j_q, j_x = robot.jacobians(POSES)
    shares = np.abs(np.diagonal(j_q, axis1=1, axis2=2)) / (g.arm_length * g.rod_length)
    expected = {
        "J_q": shares.min(-1),
        "det_J_q": shares.prod(-1),
        "det_J_x": np.abs(np.linalg.det(j_x)) / (abs(hand.pitch) * g.rod_length**4),
    }[name]
    found = robot.margin(name, POSES)
    assert np.abs(found - expected).max() < 1e-13
    assert found.min() >= 0.0
    assert found.max() <= 1.0
