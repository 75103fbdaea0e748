"""What the Peppermill's paper prints, what contradicts its own loop closure, and what holds."""

import numpy as np

from kinematics import Peppermill
from kinematics.robots.peppermill.singularities import links
from tests.kinematics.robots.peppermill.peppermill_by_hand import TURN, A, ByHand, K, X, Y, assembled

GEOMETRY = Peppermill.Geometry((0.22, 0.17), (0.48, 0.61), 0.55, (0.09, -0.13), 0.06)
HAND = ByHand(GEOMETRY)
PROXIMAL, DISTAL, LEAD = (
    np.array(v) for v in (GEOMETRY.proximal_lengths, GEOMETRY.distal_lengths, np.array(GEOMETRY.pitches) / TURN)
)
B0 = GEOMETRY.half_distance


def working(count=2000, seed=1):
    return assembled(GEOMETRY, np.random.default_rng(seed), count)


def passive(pose, joints):
    """lambda_i from the loop as it stands, by atan2 in the limb's plane."""
    link = HAND.distal(pose, joints)
    angle = np.arctan2((link * Y).sum(-1), (link * X).sum(-1))
    return angle - joints[:, 2:]


def test_equation_3_slides_the_second_limb_from_its_own_axis():
    """Printed O1A1 = d2 j; O2A2 holds."""
    pose, joints = working()
    link = HAND.nuts(pose)[:, 1] - PROXIMAL[1] * HAND.u(joints)[:, 1] - joints[:, 1:2] * A[1]
    printed, holds = (np.abs(np.linalg.norm(link - o, axis=-1) - DISTAL[1]) for o in HAND.origins)
    assert np.median(printed) > 0.1  # the wrong length passes the right one now and then
    assert holds.max() < 1e-14


def test_equations_13_and_14_need_the_base_heights_signs():
    """Printed -b_0 k for both limbs; -b_0i k with b_01 = -b_0, b_02 = b_0 holds, as in (17), (29), (30)."""
    pose, joints = working()
    lam = passive(pose, joints)
    v = np.cos(joints[:, 2:] + lam)[..., None] * X + np.sin(joints[:, 2:] + lam)[..., None] * Y
    chain = joints[:, :2, None] * A + PROXIMAL[:, None] * HAND.u(joints) + DISTAL[:, None] * v  # (12)
    platform = HAND.nuts(pose)  # c + p_i phi / 2 pi k
    printed = np.linalg.norm(chain - (platform - B0 * K), axis=-1)
    holds = np.linalg.norm(chain - (platform - np.array([[-B0], [B0]]) * K), axis=-1)
    assert printed[:, 0].min() > 1.0  # 2 b_0 away
    assert printed[:, 1].max() < 1e-14
    assert holds.max() < 1e-14


def half_angle(pose, sign):
    """(25), (26) as printed: (..., 2) theta_i."""
    q = HAND.nuts(pose) - HAND.origins
    e1, e2 = (q * Y).sum(-1), (q * X).sum(-1)
    square = e1**2 + e2**2  # along a_i, q_i has nothing: d_i takes it
    e3 = -(square + PROXIMAL**2 - DISTAL**2) / (2 * PROXIMAL)
    with np.errstate(divide="ignore", invalid="ignore"):
        return 2 * np.arctan((-e1 + sign * np.sqrt(square - e3**2)) / (e3 - e2))


def test_equation_25_with_the_plus_root_is_the_working_mode():
    pose, joints = working()
    for sign, mode in ((1, 0), (-1, 3)):
        found = Peppermill(GEOMETRY).inverse_modes(pose)[:, mode, 2:]
        gap = half_angle(pose, sign) - found
        assert np.abs(gap - TURN * np.round(gap / TURN)).max() < 1e-9
    gap = half_angle(pose, 1) - joints[:, 2:]
    assert np.abs(gap - TURN * np.round(gap / TURN)).max() < 1e-9


def test_equation_25_is_undefined_where_an_angle_is_pi():
    """r = 1/4, l = 1/2, q_1 = (-1/4, 1/2): one root is theta = pi and the half angle of the other is 0 / 0."""
    robot = Peppermill(Peppermill.Geometry(proximal_lengths=(0.25, 0.25)))
    e1, e2 = 0.5, -0.25
    e3 = -(e1**2 + e2**2 + 0.25**2 - 0.5**2) / (2 * 0.25)
    with np.errstate(invalid="ignore"):
        printed = 2 * np.arctan(np.divide(-e1 + np.sqrt(e1**2 + e2**2 - e3**2), e3 - e2))
    assert np.isnan(printed)
    pose = np.array([0.0, -0.25, 0.0, 0.0])
    assert abs(robot.inverse(pose)[2] - 2 * np.arctan(0.5)) < 1e-15
    assert robot.inverse_modes(pose)[2, 2] == np.pi
    assert np.abs(robot.closure_residual(pose, robot.inverse_modes(pose))).max() < 1e-15


def forward_as_printed(joints, principal):
    """(28), (32)-(35); `principal` takes the arcsine as printed, else pi minus it."""
    d1, d2, t1, t2 = joints.T
    arcsine = np.arcsin((d1 - PROXIMAL[1] * np.sin(t2)) / DISTAL[1])
    lam2 = (arcsine if principal else np.pi - arcsine) - t2
    lam1 = np.arccos((d2 - PROXIMAL[0] * np.cos(t1)) / DISTAL[0]) - t1
    right = np.stack(
        [
            PROXIMAL[0] * np.sin(t1) + DISTAL[0] * np.sin(t1 + lam1) - B0,
            PROXIMAL[1] * np.cos(t2) + DISTAL[1] * np.cos(t2 + lam2) + B0,
        ],
        axis=-1,
    )
    matrix = np.stack([np.ones(2), LEAD], axis=-1)
    return np.concatenate([joints[:, :2], np.linalg.solve(matrix, right[..., None])[..., 0]], axis=-1)


def test_equation_32_needs_pi_minus_the_arcsine_in_the_working_layout():
    """The printed branch closes the loop too, but with limb 2 reaching up: it is the second forward mode."""
    pose, joints = working()
    printed, holds = (forward_as_printed(joints, principal) for principal in (True, False))
    assert np.abs(printed - pose)[:, 2].min() > 0.01
    assert np.abs(HAND.gaps(printed, joints)).max() < 1e-13
    assert np.abs(printed - Peppermill(GEOMETRY).forward_modes(joints)[:, 1]).max() < 1e-11
    assert np.abs(holds - pose).max() < 1e-11


def test_section_4_2_calls_u_the_distal_link_but_it_is_the_proximal_one():
    pose, joints = working()
    found = links(Peppermill(GEOMETRY), pose, joints)
    proximal = (HAND.elbows(joints) - HAND.carriages(joints)) / PROXIMAL[:, None]
    distal = (HAND.nuts(pose) - HAND.elbows(joints)) / DISTAL[:, None]
    assert np.abs(found.proximal - proximal).max() < 1e-14
    assert np.abs(found.distal - distal).max() < 1e-14
    assert np.abs(found.proximal - distal).max(axis=-1).min() > 0.01


def test_equations_44_and_46_hold_with_r_dtheta_in_the_joint_vector_only():
    """Small joint steps from the inverse model; B and A as printed in (47)."""
    robot, pose = Peppermill(GEOMETRY), working()[0]
    pose = pose[robot.margin("J_q", pose) > 0.5]  # elsewhere a finite step says less
    step = 1e-6 * np.random.default_rng(2).normal(size=pose.shape)
    joints = robot.inverse(pose)
    moved = robot.inverse(pose + step) - robot.inverse(pose - step)
    a, b = HAND.a_and_b(pose, joints)
    right = (a @ (2 * step)[..., None])[..., 0]
    with_r = (b @ (moved * [1, 1, *PROXIMAL])[..., None])[..., 0]
    without = (b @ moved[..., None])[..., 0]
    assert np.abs(with_r - right).max() < 1e-8 * np.abs(right).max()
    assert np.abs(without - right).max() > 0.1 * np.abs(right).max()


def test_equation_45_means_the_first_entry_of_u_theta_2_along_x():
    """Printed u_theta2z twice; only (x, 0, z) gives the B that differentiation of the closure gives."""
    pose, joints = working()
    j_q, _ = Peppermill(GEOMETRY).jacobians(pose, joints)
    v, u_theta = HAND.distal(pose, joints)[:, 1] / DISTAL[1], HAND.u_theta(joints)[:, 1]
    printed = (v * np.stack([u_theta[:, 2], 0 * v[:, 0], u_theta[:, 2]], axis=-1)).sum(-1)
    holds = (v * u_theta).sum(-1)
    assert np.abs(holds * PROXIMAL[1] - j_q[:, 3, 3]).max() < 1e-14
    assert np.median(np.abs(printed * PROXIMAL[1] - j_q[:, 3, 3])) > 0.05


def test_equation_48_is_the_determinant_of_a():
    pose, joints = working()
    a, _ = HAND.a_and_b(pose, joints)
    v = HAND.distal(pose, joints)[..., 2] / DISTAL
    wanted = v[:, 0] * v[:, 1] * (LEAD[1] - LEAD[0])
    np.testing.assert_allclose(np.linalg.det(a), wanted, rtol=1e-12, atol=1e-16)


def test_equations_a1_to_a4_agree_and_a5_prints_twice_their_inverse():
    """First row of (A.5): +- p_c / 4 pi, not / 2 pi; the Jacobian J_c is the same matrix."""
    p_c = GEOMETRY.drive_pitch
    a4 = np.array([[TURN / p_c, 1], [-TURN / p_c, 1]])
    matrix = np.array([[1, p_c / TURN], [1, -p_c / TURN]])
    a3 = np.diag([1, -1]) @ matrix * TURN / p_c  # (A.3) solved for the motors
    np.testing.assert_allclose(a3, a4, rtol=1e-15)
    printed = np.array([[p_c / TURN, -p_c / TURN], [0.5, 0.5]])
    middle = p_c / TURN * np.linalg.inv(matrix) @ np.diag([1, -1])  # what (A.5) itself starts from
    holds = np.array([[p_c / (2 * TURN), -p_c / (2 * TURN)], [0.5, 0.5]])
    np.testing.assert_allclose(middle, holds, rtol=1e-14)
    np.testing.assert_allclose(holds @ a4, np.eye(2), atol=1e-15)
    np.testing.assert_allclose(printed @ a4, np.diag([2, 1]), atol=1e-15)

    robot, joints = Peppermill(GEOMETRY), Peppermill(GEOMETRY).inverse(working()[0])
    eta = robot.motors(joints)
    for limb in range(2):
        pair = eta[:, 2 * limb : 2 * limb + 2]
        d, theta = joints[:, limb], joints[:, 2 + limb]
        for k, pitch in enumerate((p_c, -p_c)):
            np.testing.assert_allclose(pitch / TURN * (pair[:, k] - theta), d, atol=1e-14)  # (A.1), (A.2)
        np.testing.assert_allclose(pair @ holds.T, np.stack([d, theta], axis=-1), atol=1e-13)
    assert np.abs(robot.from_motors(eta) - joints).max() < 1e-13
