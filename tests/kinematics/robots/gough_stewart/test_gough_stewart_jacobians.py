"""Gough-Stewart: Jacobian, leg rates, statics, singularities, dynamics, and the chapter's slips around them."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematics import FviBounds, GoughStewart, inverse_dynamics, joint_motion
from kinematics.dynamics.drive_torque import GRAVITY
from tests.kinematics.robots.gough_stewart.gough_stewart_by_hand import (
    anywhere,
    leg_vectors,
    matrix_of,
    moved,
    printed_inverse_jacobian,
    random_frame,
    random_poses,
    random_robot,
    transform_of,
)
from tests.kinematics.weighed import GOUGH_STEWART

SEEDS = st.integers(0, 2**32 - 1)


def test_inverse_jacobian_is_the_printed_8_20_row_by_row() -> None:
    rng = np.random.default_rng(1)
    for _ in range(100):
        robot, pose = random_robot(rng), anywhere(rng, 1)[0]
        j_q, j_x = robot.jacobians(pose)
        np.testing.assert_array_equal(j_q, np.eye(6))
        np.testing.assert_allclose(j_x, printed_inverse_jacobian(robot, pose), rtol=0, atol=1e-13)
        np.testing.assert_allclose(robot.inverse_jacobian(pose), j_x, rtol=0, atol=1e-15)


def test_jacobian_is_the_central_difference_of_the_leg_lengths_along_each_twist() -> None:
    rng, h = np.random.default_rng(2), 1e-5
    for _ in range(20):
        robot, pose = random_robot(rng), anywhere(rng, 1)[0]
        columns = [(robot.inverse(moved(pose, e, h)) - robot.inverse(moved(pose, e, -h))) / (2 * h) for e in np.eye(6)]
        np.testing.assert_allclose(robot.inverse_jacobian(pose), np.transpose(columns), atol=2e-8)


def test_jacobian_is_the_automatic_derivative_through_the_euler_angles() -> None:
    """The base's way, d phi / d pose times the pose rates; it loses digits near a pitch of a quarter turn only."""
    robot, rng = GoughStewart(), np.random.default_rng(3)
    model = robot.model()
    by_pose = -ca.jacobian(model.closure, model.pose) @ robot.pose_rate_map(model.pose)
    function = ca.Function("by_pose", [model.pose, model.geometry], [by_pose])
    for pose in random_poses(rng, 100):
        expected = np.array(function(pose, robot.geometry.vector()))
        np.testing.assert_allclose(robot.inverse_jacobian(pose), expected, rtol=0, atol=1e-13)


def test_jacobian_is_regular_where_the_euler_angles_are_not() -> None:
    robot = random_robot(np.random.default_rng(4))
    pose = np.array([0.1, 0.2, 0.3, 0.4, np.pi / 2, -0.3])
    np.testing.assert_allclose(robot.inverse_jacobian(pose), printed_inverse_jacobian(robot, pose), atol=1e-13)


def test_pose_rates_are_those_of_the_moving_frame() -> None:
    rng, h = np.random.default_rng(5), 1e-6
    function = ca.Function("rates", [pose := ca.SX.sym("pose", 6)], [GoughStewart.pose_rate_map(pose)])
    for at in random_poses(rng, 50):
        twist = rng.normal(size=6)
        difference = (moved(at, twist, h) - moved(at, twist, -h)) / (2 * h)
        np.testing.assert_allclose(np.array(function(at)) @ twist, difference, atol=1e-8)


def test_leg_rates_follow_a_motion_of_the_platform() -> None:
    """[8.12] against joint_motion, which differentiates the inverse model along the pose's own rates."""
    robot, rng = random_robot(np.random.default_rng(6)), np.random.default_rng(7)
    pose, rates = random_poses(rng, 200), rng.normal(size=(200, 6))
    motion = joint_motion(robot, pose, rates, 0 * rates, 0 * rates)
    function = ca.Function("rates", [p := ca.SX.sym("p", 6)], [ca.inv(GoughStewart.pose_rate_map(p))])
    twists = np.array([np.array(function(p)) @ r for p, r in zip(pose, rates, strict=True)])
    np.testing.assert_allclose(robot.leg_rates(pose, twists), motion.first, rtol=0, atol=1e-12)


# Errata.


def test_8_7_prints_e_where_its_inverse_maps_platform_points_to_the_tool_frame() -> None:
    robot = random_robot(np.random.default_rng(8))
    pose = anywhere(np.random.default_rng(9), 1)[0]
    e = np.array(robot.geometry.E)
    points = np.column_stack([robot.geometry.platform_points, np.ones(6)]).T
    base = robot.geometry.in_reference_frame()

    def lengths(in_tool: np.ndarray) -> np.ndarray:
        return np.linalg.norm((transform_of(pose) @ in_tool)[:3].T - base, axis=1)

    assert np.abs(lengths(e @ points) - robot.inverse(pose)).max() > 0.1
    np.testing.assert_allclose(lengths(np.linalg.inv(e) @ points), robot.inverse(pose), atol=1e-13)
    np.testing.assert_allclose(robot.geometry.in_tool_frame().T, (np.linalg.inv(e) @ points)[:3], atol=1e-14)


def test_8_14_is_the_velocity_of_b_in_the_reference_frame_not_in_the_tool_frame() -> None:
    """The text says "with respect to R_E", in which B_i rests; the formula is right in R_f."""
    robot, rng, h = random_robot(np.random.default_rng(10)), np.random.default_rng(11), 1e-6
    pose, twist = anywhere(rng, 1)[0], rng.normal(size=6)
    _, arms = leg_vectors(robot, pose)
    printed = twist[:3] + np.cross(-arms, twist[3:])
    ends = [p[:3] + leg_vectors(robot, p)[1] for p in (moved(pose, twist, -h), moved(pose, twist, h))]
    np.testing.assert_allclose(printed, (ends[1] - ends[0]) / (2 * h), atol=1e-8)
    in_tool = [leg_vectors(robot, p)[1] @ matrix_of(p) for p in (moved(pose, twist, -h), moved(pose, twist, h))]
    np.testing.assert_allclose(in_tool[1], in_tool[0], atol=1e-13)
    assert np.abs(printed).min(axis=1).max() > 0.01


def test_8_26_is_the_legs_wrench_so_an_external_load_turns_its_sign() -> None:
    """Against Newton's and Euler's equations of the platform, leg by leg; the unsigned formula does not balance."""
    rng = np.random.default_rng(12)
    for _ in range(50):
        robot, pose, external = random_robot(rng), anywhere(rng, 1)[0], rng.normal(size=6)
        legs, arms = leg_vectors(robot, pose)
        u = legs / np.linalg.norm(legs, axis=1)[:, None]

        def sums(gamma: np.ndarray, u: np.ndarray = u, arms: np.ndarray = arms) -> np.ndarray:
            push = gamma[:, None] * u
            return np.concatenate([push.sum(axis=0), np.cross(arms, push).sum(axis=0)])

        gamma = robot.leg_forces(pose, external)
        scale = 1e-13 * (1 + np.abs(gamma).max())
        np.testing.assert_allclose(sums(gamma) + external, 0, atol=scale)
        np.testing.assert_allclose(robot.legs_wrench(pose, gamma), -external, atol=scale)
        printed = np.linalg.solve(printed_inverse_jacobian(robot, pose).T, external)
        assert np.linalg.norm(sums(printed) + external) > np.linalg.norm(external)
        np.testing.assert_allclose(robot.legs_wrench(pose, printed), external, atol=scale)


def test_legs_that_carry_a_weight_from_below_push() -> None:
    robot = GoughStewart()
    forces = robot.leg_forces(np.array(robot.home), np.array([0, 0, -600.0, 0, 0, 0]))
    legs, _ = leg_vectors(robot, np.array(robot.home))
    np.testing.assert_allclose(forces, 100.0 / (legs[0, 2] / np.linalg.norm(legs[0])), rtol=1e-12)


def test_power_of_the_legs_is_the_power_of_their_wrench() -> None:
    robot, rng = random_robot(np.random.default_rng(13)), np.random.default_rng(14)
    pose, twist, forces = anywhere(rng, 300), rng.normal(size=(300, 6)), rng.normal(size=(300, 6))
    legs = np.sum(forces * robot.leg_rates(pose, twist), axis=1)
    np.testing.assert_allclose(np.sum(robot.legs_wrench(pose, forces) * twist, axis=1), legs, atol=1e-12)


# Singularities and indices.


def test_determinant_is_that_of_thirty_digits_and_never_leaves_its_bounds() -> None:
    rng = np.random.default_rng(15)
    mpmath.mp.dps = 30
    for _ in range(20):
        robot, pose = random_robot(rng), anywhere(rng, 1)[0]
        points = np.array(robot.geometry.platform_points)
        rho = np.sqrt(np.mean(np.sum((points - points.mean(axis=0)) ** 2, axis=1)))
        exact = mpmath.det(mpmath.matrix(printed_inverse_jacobian(robot, pose).tolist())) / (8 * rho**3)
        assert robot.margin("det_J_x", pose) == pytest.approx(abs(float(exact)), rel=1e-10, abs=1e-13)
        assert robot.margin("det_J_x", anywhere(rng, 2000)).max() <= 1.0
        assert robot.margin("J_q", pose) == robot.margin("det_J_q", pose) == 1.0


def test_octahedron_turned_by_a_quarter_is_singular_and_says_so_everywhere() -> None:
    """Hunt's and Fichter's singularity: yaw of a quarter turn at any height."""
    robot = GoughStewart(GoughStewart.Geometry.mssm())
    for z in (0.3, 0.6, 0.9):
        pose = np.array([0.0, 0.0, z, 0.0, 0.0, np.pi / 2])
        assert robot.margin("det_J_x", pose) < 1e-15
        assert robot.isotropic(pose)[1] < 1e-12
        assert robot.condition_number(pose) > 1e14
        values = np.linalg.svd(robot.inverse_jacobian(pose), compute_uv=False)
        assert values[-1] < 1e-14 < 0.01 < values[-2]
    pose[5] -= 0.1
    assert robot.margin("det_J_x", pose) > 1e-3


def test_a_leg_on_a_flat_platform_is_singular_for_leg_forces() -> None:
    """All joint centres in one plane: no leg can push out of it."""
    robot = GoughStewart()
    flat = np.zeros(6)
    assert np.isnan(robot.leg_forces(flat, np.array([0, 0, 1.0, 0, 0, 0]))).all()
    both = robot.leg_forces(np.array([flat, robot.home]), np.array([0, 0, 1.0, 0, 0, 0]))
    np.testing.assert_array_equal(np.isnan(both).all(axis=1), [True, False])


def test_worst_speed_and_force_are_those_of_numpys_inverse_with_the_mean_radius() -> None:
    rng = np.random.default_rng(16)
    robot = random_robot(rng)
    poses = anywhere(rng, 200)
    points = np.array(robot.geometry.platform_points)
    radius = np.linalg.norm(points - points.mean(axis=0), axis=1).mean()
    assert robot.characteristic_length == pytest.approx(radius, rel=1e-14)
    j = robot.inverse_jacobian(poses) / np.array([1, 1, 1, radius, radius, radius])
    speeds = 1 / np.linalg.norm(j, axis=2).max(axis=1)
    forces = 1 / np.linalg.norm(np.linalg.inv(j), axis=1).max(axis=1)
    v_w, f_w = robot.isotropic(poses)
    np.testing.assert_allclose(v_w, speeds, rtol=1e-12)
    np.testing.assert_allclose(f_w, forces, rtol=1e-7)
    bounds = FviBounds(joint_speed=0.5, joint_effort=100.0, speed=0.2, force=30.0)
    expected = np.minimum(speeds * 0.5 / 0.2, forces * 100.0 / 30.0)
    np.testing.assert_allclose(robot.fvi(poses, bounds), expected, rtol=1e-7)


def test_symbolic_determinant_and_fvi_stay_small() -> None:
    robot = GoughStewart()
    assert len(robot.margin_program("det_J_x").code) < 800
    assert len(robot.margin_program("fvi").code) < 2500


# Dynamics.


def test_a_robot_at_rest_carries_its_weight_by_8_26() -> None:
    inertia = replace(GOUGH_STEWART, rod_mass=0.7, platform_mass=9.0)
    rng = np.random.default_rng(17)
    robot = GoughStewart(random_robot(rng).geometry, inertia)
    pose, rest = anywhere(rng, 1)[0], np.zeros(6)
    _, arms = leg_vectors(robot, pose)
    weight, moment = np.array([0, 0, -GRAVITY * (9.0 + 6 * 0.7 + 3.0)]), np.zeros(3)
    for arm in arms:
        moment += np.cross(arm, [0, 0, -GRAVITY * (9.0 / 6 + 0.7)])
    expected = robot.leg_forces(pose, np.concatenate([weight, moment]))
    found = inverse_dynamics(robot, 3.0, pose, rest, rest)
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-8 * np.abs(expected).max())


@settings(max_examples=5)
@given(SEEDS)
def test_leg_power_is_the_change_of_kinetic_and_potential_energy(seed: int) -> None:
    """Along pose(t) = p + v t + a t^2 / 2, by central differences of the energy written by hand."""
    rng = np.random.default_rng(seed)
    robot = GoughStewart(GoughStewart.Geometry(Z=random_frame(rng)), GOUGH_STEWART)
    start = robot.home
    v, a, payload, h = 0.3 * rng.normal(size=6), rng.normal(size=6), 4.0, 1e-4
    i = robot.inertia

    def energy(t: float) -> float:
        def ends(s: float) -> np.ndarray:
            pose = start + v * s + a * s * s / 2
            return np.vstack([pose[:3] + leg_vectors(robot, pose)[1], pose[:3]])

        speed = (ends(t + h) - ends(t - h)) / (2 * h)
        masses = np.array([i.rod_mass + i.platform_mass / 6] * 6 + [payload])
        legs = [robot.inverse(start + v * s + a * s * s / 2) for s in (t - h, t + h)]
        spin = (legs[1] - legs[0]) / (2 * h) * 2 * np.pi / i.screw_lead
        kinetic = np.sum(masses * np.sum(speed**2, axis=1)) / 2 + i.drive * np.sum(spin**2) / 2
        return float(kinetic + GRAVITY * np.sum(masses * ends(t)[:, 2]))

    forces = inverse_dynamics(robot, payload, start, v, a)
    rates = joint_motion(robot, start, v, a, 0 * a).first
    near, far = (energy(k * h) - energy(-k * h) for k in (5, 10))
    power = (8 * near - far) / (60 * h)  # to fourth order
    assert forces @ rates == pytest.approx(power, rel=1e-4, abs=1e-3)
