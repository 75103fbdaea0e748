"""Jacobians and singularities of the redundant robot, (23)-(38)."""

import casadi as ca
import numpy as np
import pytest

from kinematics import Redundant3T1R
from kinematics.mathematics.symbolic_linear_algebra import volume
from tests.kinematics.numeric import differences
from tests.kinematics.robots.redundant_3t1r.redundant_by_hand import OUTER, ByHand, box, random_geometry, reachable
from tests.sizes import few_or_many


@pytest.fixture(scope="module")
def robot():
    return Redundant3T1R()


def test_jacobians_are_31_32_and_33_as_printed(robot):
    poses = reachable(robot, box(50_000, seed=1), margin=1e-4)
    j_q, j_x = robot.jacobians(poses)
    diagonal, matrix = ByHand().jacobians(poses)
    assert np.abs(j_q - diagonal[..., None] * np.eye(6)).max() < 1e-13
    assert np.abs(j_x - matrix).max() < 1e-13
    j_m = ByHand().inverse_jacobian(poses)
    assert (np.abs(robot.inverse_jacobian(poses) - j_m).max(axis=(1, 2)) < 1e-12 * np.abs(j_m).max(axis=(1, 2))).all()


def test_jacobians_of_other_geometries_are_as_printed():
    rng = np.random.default_rng(2)
    for _ in range(20):
        other = Redundant3T1R(random_geometry(rng))
        poses = reachable(other, box(300, seed=3, y=0.4, z=0.4), margin=1e-3)
        diagonal, matrix = ByHand(other.geometry).jacobians(poses)
        j_q, j_x = other.jacobians(poses)
        assert np.abs(np.diagonal(j_q, axis1=1, axis2=2) - diagonal).max(initial=0) < 1e-12
        assert np.abs(j_x - matrix).max(initial=0) < 1e-12


def test_jacobians_against_central_differences_of_inverse_and_closure(robot):
    poses = reachable(robot, box(2_000, seed=4), margin=0.05)
    assert np.abs(differences(ByHand().inverse, poses, 1e-4) - robot.inverse_jacobian(poses)).max() < 1e-7
    joints = robot.inverse(poses)
    by_pose = differences(lambda p: robot.closure_residual(p, joints), poses, 1e-4)
    by_joints = differences(lambda q: robot.closure_residual(poses, q), joints, 1e-4)
    j_q, j_x = robot.jacobians(poses)
    assert np.abs(by_pose + j_x).max() < 1e-9
    assert np.abs(by_joints - j_q).max() < 1e-9


def test_jacobian_of_the_closed_form_inverse_by_ad_is_that_of_the_closure(robot):
    model, poses = robot.model(), reachable(robot, box(200, seed=5))
    ad = ca.Function("ad", [model.pose, model.geometry], [ca.jacobian(model.inverse, model.pose)])
    geometry = robot.geometry.vector()
    for pose, j_m in zip(poses, robot.inverse_jacobian(poses), strict=True):
        assert np.abs(ad(pose, geometry).full() / j_m - 1)[np.abs(j_m) > 1e-12].max() < 1e-10


def test_velocities_of_points_a_and_b_agree_along_each_arm(robot):
    """(27)-(29) for random twists."""
    poses = reachable(robot, box(5_000, seed=6), margin=1e-3)
    hand, twists = ByHand(), np.random.default_rng(7).normal(size=(len(poses), 4))
    rates = np.einsum("kij,kj->ki", robot.inverse_jacobian(poses), twists)
    n, levers = hand.directions(poses), hand.levers(poses)
    omega = twists[:, None, 3:] * np.array([0.0, 0, 1])
    of_b = twists[:, None, :3] + np.cross(omega, levers)
    assert np.abs(rates * n[..., 0] - (n * of_b).sum(axis=-1)).max() < 1e-12


def test_serial_singularity_is_an_arm_across_the_x_axis(robot):
    """(34): on the way to the edge of reach the arm that touches it loses n_x, none before."""
    steps = np.zeros(4)
    hand = ByHand()
    for theta in (-1.2, 0.0, 0.6):
        edge = brink(robot, np.array([0.0, 0.1, 1.0, theta]))
        poses = np.column_stack([steps, steps + 0.1, edge * np.array([0, 0.5, 0.99, 1 - 1e-12]), steps + theta])
        n_x = hand.directions(poses)[..., 0]
        assert (np.diff(robot.margin("J_q", poses)) < 0).all()
        assert np.allclose(robot.margin("J_q", poses), np.abs(n_x).min(axis=-1), atol=1e-9)
        assert np.allclose(robot.margin("det_J_q", poses), np.abs(n_x).prod(axis=-1), atol=1e-9)
        assert robot.margin("J_q", poses)[-1] < 1e-5
        assert (robot.margin("det_J_x", poses) > 0.05).all()


def brink(robot, direction):
    """z at which the pose leaves reach, by bisection."""
    low, high = 0.0, 2.0
    for _ in range(60):
        middle = (low + high) / 2
        pose = direction * [1, 1, 0, 1] + middle * np.array([0, 0, 1, 0])
        low, high = (middle, high) if robot.margin("reach", pose) > 0 else (low, middle)
    return low


def test_matrix_n_of_35_has_the_rank_of_j_x(robot):
    hand, poses = ByHand(), reachable(robot, box(2_000, seed=8))
    n, levers = hand.directions(poses), hand.levers(poses)
    r = hand.platform(poses)[:, 2] - hand.platform(poses)[:, 0]  # (36)
    across = np.cross(r, [0.0, 0, 1])
    last = -np.einsum("kij,kj->ki", n, across) * [0, 0, 1, 1, 0, 0]
    matrix_n = np.concatenate([n, last[..., None]], axis=-1)
    combination = np.einsum("kij,kj->ki", n, np.cross(levers[:, 0], [0.0, 0, 1]))
    by_columns = np.concatenate([n, (hand.jacobians(poses)[1][..., 3] + combination)[..., None]], axis=-1)
    assert np.abs(matrix_n - by_columns).max() < 1e-14
    volumes = [np.sqrt(np.linalg.det(np.swapaxes(m, 1, 2) @ m)) for m in (matrix_n, robot.jacobians(poses)[1])]
    assert np.allclose(*volumes, rtol=1e-10)


def test_outer_arms_hold_the_position_everywhere_in_reach():
    """Rank 3 of M, (37): n_1 . (n_2 x n_5) has the sign of y_1 (z_1 - a/2) at every pose of every geometry."""
    rng = np.random.default_rng(9)
    for _ in range(200):
        geometry = random_geometry(rng)
        hand, poses = ByHand(geometry), box(500, seed=10, y=1.5, z=1.5)
        n = hand.directions(poses[~np.isnan(hand.inverse(poses)).any(axis=-1)])
        triple = np.einsum("ki,ki->k", n[:, 0], np.cross(n[:, 1], n[:, 4]))
        sign = np.sign(geometry.outer_rail_y * (geometry.outer_rail_z - geometry.platform_height / 2))
        assert (triple * sign > 0).all()


@few_or_many(50_000, 1_200_000)
def test_no_parallel_singularity_inside_reach(robot, count):
    poses = reachable(robot, box(count, seed=11, y=0.9, z=1.1))
    conditions = robot.parallel_singularity(poses[:200_000])
    assert min(conditions.translation.min(), conditions.rotation.min()) > 0.1
    assert max(conditions.translation.max(), conditions.rotation.max()) <= 1.0
    margin = robot.margin("det_J_x", poses)
    assert margin.min() > 0.06
    assert margin.max() <= 1.0


def test_parallel_singularity_conditions_are_those_of_section_v_b(robot):
    hand, poses = ByHand(), reachable(robot, box(1_000, seed=12))
    n, r = hand.directions(poses), hand.platform(poses)[:, 2] - hand.platform(poses)[:, 0]
    across = np.cross(r, [0.0, 0, 1])
    m = n[:, OUTER]
    translation = np.sqrt(np.linalg.det(np.swapaxes(m, 1, 2) @ m) / (4 / 3) ** 3)
    rotation = np.abs(np.einsum("kij,kj->ki", n[:, 2:4], across)).max(axis=-1) / np.linalg.norm(across, axis=-1)
    conditions = robot.parallel_singularity(poses)
    assert np.allclose(conditions.translation, translation, rtol=1e-10)
    assert np.allclose(conditions.rotation, rotation, rtol=1e-10)


def test_the_parallel_singularity_at_the_very_edge_of_reach():
    """n_3, n_4, r and e_z in one plane across x: y_b3 = 0, z^2 = L3^2 - y3^2, theta = 90 degrees; also the tilt's."""
    g = Redundant3T1R.Geometry(outer_arm_length=1.6)
    robot = Redundant3T1R(g)
    z = np.sqrt(g.middle_arm_length**2 - g.middle_rail_y**2)
    near = [np.array([0.0, -g.platform_length / 2, z - gap, np.pi / 2]) for gap in (1e-2, 1e-6, 1e-10)]
    for name in ("det_J_x", "J_q", "internal_determinant"):
        values = [robot.margin(name, pose) for pose in near]
        assert values[2] < 1e-4
        assert np.isclose(values[1] / values[2], 100, rtol=0.05)  # all fall with the root of the gap
    assert robot.parallel_singularity(near[2]).translation > 0.1
    assert robot.parallel_singularity(near[2]).rotation < 1e-4


def test_volume_is_the_product_of_singular_values_even_when_tiny():
    rng = np.random.default_rng(13)
    symbol = ca.SX.sym("A", 6, 4)
    function = ca.Function("volume", [symbol], [volume(symbol)])
    for smallest in (1.0, 1e-6, 1e-12):
        u, v = (np.linalg.qr(rng.normal(size=(k, 4)))[0] for k in (6, 4))
        value = float(function(u @ np.diag([2.0, 1.0, 0.5, smallest]) @ v.T))
        assert np.isclose(value, smallest, rtol=1e-3 if smallest == 1e-12 else 1e-8)
    singular = float(function(u @ np.diag([2.0, 1.0, 0.5, 0.0]) @ v.T))
    assert singular < 1e-15
