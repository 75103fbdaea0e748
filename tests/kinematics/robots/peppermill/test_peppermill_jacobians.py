"""The Peppermill's Jacobians against A and B as printed, AD and differences; its three kinds of singularity."""

import casadi as ca
import numpy as np
import pytest

from kinematics import InvalidValue, Peppermill, UnreachablePose
from kinematics.robots.peppermill.singularities import links, singularity_kinds
from tests.kinematics.numeric import differences
from tests.kinematics.robots.peppermill.peppermill_by_hand import TURN, ByHand, assembled, box, random_geometry
from tests.sizes import few_or_many

GEOMETRY = Peppermill.Geometry()
UNLIKE = Peppermill.Geometry((0.22, 0.17), (0.48, 0.61), 0.55, (0.09, -0.13), 0.06)
ELBOWS = [(1, 1), (1, -1), (-1, 1), (-1, -1)]
SIDES = [(1, -1), (1, 1), (-1, -1), (-1, 1)]


def printed(geometry, pose, joints):
    """J_x = A and J_q = B with r_i folded in, from (47) by hand."""
    a, b = ByHand(geometry).a_and_b(pose, joints)
    return b * np.array([1, 1, *geometry.proximal_lengths]), a


# Jacobians.


def test_jacobians_are_a_and_b_as_printed():
    robot, pose = Peppermill(), box(100_000, seed=1)
    j_q, j_x = robot.jacobians(pose)
    wanted_q, wanted_x = printed(GEOMETRY, pose, robot.inverse(pose))
    assert np.abs(j_q - wanted_q).max() < 1e-14
    assert np.abs(j_x - wanted_x).max() < 1e-14
    assert np.abs(robot.inverse_jacobian(pose) - np.linalg.solve(wanted_q, wanted_x)).max() < 1e-13


@pytest.mark.parametrize("elbows", ELBOWS)
@pytest.mark.parametrize("sides", SIDES)
def test_jacobians_of_every_layout_are_a_and_b_as_printed(elbows, sides):
    pose, joints = assembled(UNLIKE, np.random.default_rng(2), 2000, elbows, sides)
    for found, wanted in zip(Peppermill(UNLIKE).jacobians(pose, joints), printed(UNLIKE, pose, joints), strict=True):
        assert np.abs(found - wanted).max() < 1e-14


@few_or_many(30, 1000)
def test_jacobians_of_random_geometries(count):
    rng = np.random.default_rng(3)
    for _ in range(count):
        geometry = random_geometry(rng)
        pose, joints = assembled(geometry, rng, 5)
        found, wanted = Peppermill(geometry).jacobians(pose), printed(geometry, pose, joints)
        assert max(np.abs(f - w).max() for f, w in zip(found, wanted, strict=True)) < 1e-11


def test_inverse_jacobian_is_the_derivative_of_the_closed_form():
    """By automatic differentiation of theta_i themselves, which never see the closure."""
    robot, pose = Peppermill(UNLIKE), assembled(UNLIKE, np.random.default_rng(4), 500)[0]
    model = robot.model()
    function = ca.Function("ad", [model.pose, model.geometry], [ca.jacobian(model.inverse, model.pose)])
    wanted = np.array([function(p, UNLIKE.vector()).full() for p in pose])
    assert np.abs(robot.inverse_jacobian(pose) - wanted).max() < 1e-11


def test_jacobians_against_central_differences_of_the_models():
    robot, pose = Peppermill(), box(20_000, seed=5)
    joints = robot.inverse(pose)
    assert np.abs(robot.inverse_jacobian(pose) - differences(robot.inverse, pose, 1e-4)).max() < 1e-9
    motors = differences(lambda p: robot.motors(robot.inverse(p)), pose, 1e-4)
    assert np.abs(robot.actuator_jacobian(pose) - motors).max() < 1e-7  # entries up to 2 pi / p_c
    there_and_back = differences(robot.forward, joints, 1e-4) @ robot.inverse_jacobian(pose)
    assert np.abs(there_and_back - np.eye(4)).max() < 1e-8


# Singularities.


def angles(theta, link):
    """One limb's theta_i and theta_i + lambda_i for both limbs: limb 2 in general position."""
    pose, joints = ByHand(GEOMETRY).assembled(np.array([theta, 0.3]), np.array([link, np.pi + 0.4]))
    return pose, joints


@pytest.mark.parametrize(
    ("theta", "link", "kinds"),
    [
        (0.4, 1.3, (False, False, False)),
        (0.7, 0.7, (True, False, False)),  # 4.2: straight, Fig. 2
        (0.7 - np.pi, 0.7, (True, False, False)),  # 4.2: folded
        (0.7, 0.0, (False, True, False)),  # 4.3: distal link level, Fig. 3
        (0.7, np.pi, (False, True, False)),
        (0.0, 0.0, (True, True, True)),  # 4.4: straight and level
        (np.pi, 0.0, (True, True, True)),
    ],
)
def test_each_kind_of_singularity_is_where_the_paper_puts_it(theta, link, kinds):
    pose, joints = angles(theta, link)
    robot = Peppermill()
    assert tuple(bool(k) for k in singularity_kinds(robot, pose, joints)) == kinds
    j_q, j_x = robot.jacobians(pose, joints)
    assert (abs(np.linalg.det(j_q)) < 1e-15, abs(np.linalg.det(j_x)) < 1e-15) == kinds[:2]


def test_the_second_limb_alone_and_both_limbs_together_are_singular_too():
    robot, hand = Peppermill(), ByHand(GEOMETRY)
    straight_2 = hand.assembled(np.array([0.4, 2.0]), np.array([1.3, 2.0]))
    assert tuple(singularity_kinds(robot, *straight_2)) == (True, False, False)
    level_2 = hand.assembled(np.array([0.4, 2.0]), np.array([1.3, np.pi / 2]))
    assert tuple(singularity_kinds(robot, *level_2)) == (False, True, False)
    mixed = hand.assembled(np.array([0.4, 2.0]), np.array([0.4, np.pi / 2]))  # limb 1 straight, limb 2 level
    assert tuple(singularity_kinds(robot, *mixed)) == (True, True, True)


def test_the_third_kind_lets_the_platform_move_with_all_motors_locked():
    """Limb 1 straight and level: lifting its nut costs no joint anything to first order, nor does turning theta_1."""
    pose, joints = angles(0.0, 0.0)
    j_q, j_x = Peppermill().jacobians(pose, joints)
    free = np.linalg.svd(j_x)[2][-1]
    assert np.abs(j_x @ free).max() < 1e-15
    assert np.abs(j_q @ [0, 0, 1, 0]).max() < 1e-15
    assert np.abs(free[:2]).max() < 1e-15  # z and phi, together such that limb 2 stays
    assert abs(free[2] + GEOMETRY.pitches[1] / TURN * free[3]) < 1e-15


def test_factors_are_those_of_both_determinants():
    robot, pose = Peppermill(UNLIKE), assembled(UNLIKE, np.random.default_rng(6), 5000)[0]
    found, (j_q, j_x) = links(robot, pose), robot.jacobians(pose)
    lead = (UNLIKE.pitches[1] - UNLIKE.pitches[0]) / TURN
    np.testing.assert_allclose(np.linalg.det(j_x), found.second.prod(-1) * lead, rtol=1e-11)
    near = np.prod(UNLIKE.proximal_lengths)
    np.testing.assert_allclose(np.linalg.det(j_q), found.first.prod(-1) * near, rtol=1e-11)
    np.testing.assert_allclose(robot.margin("det_J_x", pose), np.abs(found.second.prod(-1)), rtol=1e-11)
    np.testing.assert_allclose(robot.margin("det_J_q", pose), np.abs(found.first.prod(-1)), rtol=1e-11)
    np.testing.assert_allclose(robot.margin("J_q", pose), np.abs(found.first).min(-1), rtol=1e-11)
    assert found.first.min() > 0
    assert found.second[:, 0].min() > 0 > found.second[:, 1].max()


def test_the_box_holds_no_singularity():
    robot, pose = Peppermill(), box(1_000_000, seed=7)
    assert robot.margin("J_q", pose).min() > 0.51
    assert robot.margin("det_J_x", pose).min() > 0.41
    kinds = singularity_kinds(robot, pose[:10_000])
    assert not np.any([kinds.first, kinds.second, kinds.third])


def test_singularities_never_answer_for_joints_of_another_pose():
    robot = Peppermill()
    pose, joints = angles(0.4, 1.3)
    for call in (links, singularity_kinds):
        with pytest.raises(InvalidValue, match="close the loop at the pose"):
            call(robot, pose + np.array([0, 0, 1e-3, 0]), joints)
    with pytest.raises(UnreachablePose):
        singularity_kinds(robot, np.array([0, 0, 3.0, 0]))
    with pytest.raises(InvalidValue, match="NaN"):
        singularity_kinds(robot, pose, joints * np.nan)
    assert np.isnan(links(robot, np.array([0, 0, 3.0, 0])).first).all()
