"""The Peppermill's displacement analysis: every mode closes the loop, and the working ones undo each other."""

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematics import MECHANISMS, Peppermill
from tests.kinematics.robots.peppermill.peppermill_by_hand import TURN, ByHand, assembled, box, faces, random_geometry
from tests.sizes import few_or_many

ELBOWS = [(1, 1), (1, -1), (-1, 1), (-1, -1)]
SIDES = [(1, -1), (1, 1), (-1, -1), (-1, 1)]
GEOMETRY = Peppermill.Geometry()
HALF_TURN = np.array([0, 0, 0, TURN / 2])
UNLIKE = Peppermill.Geometry((0.22, 0.17), (0.48, 0.61), 0.55, (0.09, -0.13), 0.06)


def same_joints(found, wanted):
    """Largest difference, angles by whole turns aside."""
    gap = np.asarray(found) - wanted
    gap[..., 2:] -= TURN * np.round(gap[..., 2:] / TURN)
    return np.abs(gap).max()


# Round trips.


@few_or_many(50_000, 1_000_000)
def test_poses_of_the_box_close_the_loop_and_come_back(count):
    robot, poses = Peppermill(), box(count, seed=1)
    joints = robot.inverse(poses)
    assert np.abs(robot.forward(joints) - poses).max() < 1e-11
    assert np.abs(ByHand(GEOMETRY).gaps(poses, joints)).max() < 1e-15 * 4


@few_or_many(30, 1000)
def test_random_geometries_come_back_in_the_working_mode_of_their_home(count):
    rng = np.random.default_rng(2)
    for _ in range(count):
        geometry = random_geometry(rng)
        poses, joints = assembled(geometry, rng, 20)
        robot = Peppermill(geometry, home=poses[0], home_joints=joints[0])
        assert np.abs(robot.forward(joints) - poses).max() < 1e-11, robot
        assert same_joints(robot.inverse(poses), joints) < 1e-11, robot


@pytest.mark.parametrize("elbows", ELBOWS)
@pytest.mark.parametrize("sides", SIDES)
def test_each_of_the_sixteen_layouts_is_found_by_its_inverse_and_its_forward_mode(elbows, sides):
    rng = np.random.default_rng(3)
    for geometry in (GEOMETRY, UNLIKE):
        robot, hand = Peppermill(geometry), ByHand(geometry)
        poses, joints = assembled(geometry, rng, 2000, elbows, sides)
        assert np.abs(hand.gaps(poses, joints)).max() < 1e-14  # the oracle itself
        inverse, forward = robot.inverse_modes(poses), robot.forward_modes(joints)
        assert same_joints(inverse[:, ELBOWS.index(elbows)], joints) < 1e-11
        assert np.abs(forward[:, SIDES.index(sides)] - poses).max() < 1e-11
        assert np.abs(hand.gaps(poses[:, None], inverse)).max() < 1e-14
        assert np.abs(hand.gaps(forward, joints[:, None])).max() < 1e-14


def test_the_modes_are_four_and_different_and_the_working_one_is_the_first():
    robot = Peppermill(UNLIKE)
    poses = assembled(UNLIKE, np.random.default_rng(4), 5000)[0]
    joints = robot.inverse(poses)
    inverse, forward = robot.inverse_modes(poses), robot.forward_modes(joints)
    for modes in (inverse, forward):
        for i in range(4):
            for j in range(i):
                assert np.abs(modes[:, i] - modes[:, j]).max(axis=-1).min() > 1e-3
    np.testing.assert_array_equal(inverse[:, 0], joints)
    np.testing.assert_array_equal(forward[:, 0], robot.forward(joints))


def test_assembly_modes_are_the_real_forward_modes_without_repetition():
    robot = Peppermill(Peppermill.Geometry(proximal_lengths=(0.25, 0.25)))
    joints = robot.inverse(np.array([0.1, -0.05, 0.02, 3.0]))
    modes = robot.assembly_modes(joints)
    assert modes.shape == (4, 4)
    np.testing.assert_array_equal(modes, robot.forward_modes(joints))
    np.testing.assert_array_equal(modes[0], robot.forward(joints))
    level = np.array([0.2, 0.75, 0.0, 0.3])  # d_2 = r_1 + l_1: distal link 1 lies level and its two modes are one
    assert robot.assembly_modes(level).shape == (2, 4)
    assert robot.assembly_modes(np.array([0.0, 5.0, 0.0, 0.0])).shape == (0, 4)


def test_forward_model_against_a_root_of_the_closure_in_fifty_digits():
    robot = Peppermill(UNLIKE)
    pose = np.array([0.07, -0.11, 0.02, 2.5])
    d1, d2, t1, t2 = (mpmath.mpf(float(v)) for v in robot.inverse(pose))
    (r1, r2), (l1, l2) = UNLIKE.proximal_lengths, UNLIKE.distal_lengths
    b0, p1, p2 = UNLIKE.half_distance, *UNLIKE.pitches
    with mpmath.workdps(50):

        def closure(z, phi, link1, link2):
            c, s = mpmath.cos, mpmath.sin
            return (
                r1 * c(t1) + l1 * c(link1) - d2,
                r1 * s(t1) + l1 * s(link1) - b0 - z - p1 * phi / (2 * mpmath.pi),
                r2 * s(t2) + l2 * s(link2) - d1,
                r2 * c(t2) + l2 * c(link2) + b0 - z - p2 * phi / (2 * mpmath.pi),
            )

        root = mpmath.findroot(closure, (0.02, 2.5, t1 + 1, t2 + 1))
        wanted = [float(root[0]), float(root[1])]
    assert np.abs(robot.forward(robot.inverse(pose))[2:] - wanted).max() < 1e-14


# What the paper says of the screws.


@pytest.mark.parametrize("limb", [0, 1])
def test_a_turn_moves_each_nut_by_its_own_pitch(limb):
    robot, poses = Peppermill(UNLIKE), box(20_000, seed=5) * [1, 1, 0.5, 0.4]
    turned, lifted = poses + HALF_TURN, poses + np.array([0, 0, UNLIKE.pitches[limb] / 2, 0])
    by_turn, by_lift = (robot.inverse(p)[:, 2 + limb] for p in (turned, lifted))
    both = np.isfinite(by_turn) & np.isfinite(by_lift)
    assert both.mean() > 0.5
    assert np.abs(by_turn - by_lift)[both].max() < 1e-12


def test_phi_counts_turns_and_is_not_folded():
    fine = Peppermill(Peppermill.Geometry(pitches=(0.01, -0.01)))
    poses = box(100_000, seed=6) * [0.7, 0.7, 1.0, 9.0]
    found = fine.forward(fine.inverse(poses))
    assert np.abs(poses[:, 3]).max() > 8.9 * TURN
    assert np.abs(found - poses).max() < 1e-11
    away = fine.inverse(poses + 2 * HALF_TURN) - fine.inverse(poses)
    assert np.nanmin(np.abs(away[:, 2:])) > 1e-4


def test_forward_gives_the_height_and_turn_of_equation_35():
    robot = Peppermill(UNLIKE)
    rng = np.random.default_rng(7)
    poses, joints = assembled(UNLIKE, rng, 1000)
    tips = ByHand(UNLIKE).nuts(robot.forward(joints))[..., 2]
    lead = np.array(UNLIKE.pitches) / TURN
    np.testing.assert_allclose(tips, poses[:, 2:3] + poses[:, 3:] * lead, atol=1e-13)


# The default's workspace.


def test_the_default_reaches_the_whole_box_with_a_full_turn_either_way():
    robot = Peppermill()
    for poses in (faces(), box(1_000_000, seed=8)):
        assert robot.margin("reach", poses).min() > 0.0199
        robot.require_reachable(poses)


def test_the_box_lies_inside_both_rings_by_exact_bounds():
    """|q_i|^2 = s^2 + h^2 with |s| <= 0.2 and 0.35 <= |h| <= 0.65, against the ring [0.3, 0.7]."""
    low, high = 0.5 - 0.05 - 0.1, 0.5 + 0.05 + 0.1
    assert low - 0.3 > 0.049
    assert 0.7 - np.hypot(0.2, high) == pytest.approx(0.0199264, abs=1e-7)


def test_home_is_the_middle_of_the_box_and_no_other_height_leaves_more_reach():
    robot = Peppermill()
    assert robot.home.tolist() == [0.0, 0.0, 0.0, 0.0]
    corners = faces()[np.abs(faces()[:, :2]).min(axis=1) > 0.19]
    centres = np.linspace(-0.03, 0.03, 61)
    worst = [robot.margin("reach", corners + np.array([0, 0, c, 0])).min() for c in centres]
    assert np.argmax(worst) == 30
    assert (np.array(worst) > 0).sum() == 41  # the box fits with its centre within 20 mm of the origin, and not at 21
    assert worst[9] < 0 < worst[10]


def test_joints_never_jump_inside_the_box():
    robot = Peppermill()
    grid = robot.inverse(faces()).reshape(31, 31, 21, 41, 4)
    for axis in range(4):
        assert np.abs(np.diff(grid, axis=axis)).max() < 0.2


def test_the_working_layout_holds_all_over_the_box():
    poses = box(200_000, seed=9)
    joints = Peppermill().inverse(poses)
    v = ByHand(GEOMETRY).distal(poses, joints) / 0.5
    assert v[:, 0, 2].min() > 0.6
    assert v[:, 1, 2].max() < -0.6


# Symmetries.

inside = st.tuples(*(st.floats(-h, h) for h in (0.2, 0.2, 0.05, TURN)))


@settings(max_examples=100, deadline=None, derandomize=True)
@given(inside)
def test_a_half_turn_about_the_diagonal_swaps_the_limbs(pose):
    """(i + j) / sqrt 2: x and y change places, z turns round and with it phi; the pitches change places."""
    robot = Peppermill(UNLIKE)
    other = Peppermill(
        UNLIKE.with_values(**{n: getattr(UNLIKE, n)[::-1] for n in ("proximal_lengths", "distal_lengths", "pitches")})
    )
    x, y, z, phi = pose
    d1, d2, t1, t2 = robot.inverse(np.array(pose))
    found = other.inverse(np.array([y, x, -z, -phi]))
    if np.isnan(d1):
        assert np.isnan(found).all()
    else:
        assert same_joints(found, np.array([d2, d1, t2 - np.pi / 2, t1 + np.pi / 2])) < 1e-12


@settings(max_examples=100, deadline=None, derandomize=True)
@given(inside)
def test_mirroring_y_or_x_mirrors_one_elbow(pose):
    robot, pose = Peppermill(), np.array(pose)
    modes = robot.inverse_modes(pose)
    in_y, in_x = robot.inverse_modes(pose * [1, -1, 1, 1]), robot.inverse_modes(pose * [-1, 1, 1, 1])
    mirrored = np.stack([modes[2, 0], -modes[2, 1], np.pi - modes[2, 2], modes[2, 3]])
    assert same_joints(in_y[0], mirrored) < 1e-12
    mirrored = np.stack([-modes[1, 0], modes[1, 1], modes[1, 2], -modes[1, 3]])
    assert same_joints(in_x[0], mirrored) < 1e-12


@settings(max_examples=100, deadline=None, derandomize=True)
@given(inside, st.floats(0.01, 100.0))
def test_a_larger_robot_has_the_same_angles(pose, scale):
    larger = Peppermill(Peppermill.Geometry.from_vector(GEOMETRY.vector() * scale))
    wanted = Peppermill().inverse(np.array(pose)) * [scale, scale, 1, 1]
    found = larger.inverse(np.array(pose) * [scale, scale, scale, 1])
    np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-12 * max(scale, 1))


# Reach.


def test_reach_is_the_distance_to_the_ring_and_negative_exactly_where_there_are_no_joints():
    for geometry in (GEOMETRY, UNLIKE):
        robot, hand = Peppermill(geometry), ByHand(geometry)
        poses = box(100_000, seed=10) * [4, 4, 12, 1]
        q = hand.nuts(poses) - hand.origins
        distance = np.linalg.norm(np.stack([q[:, 0, 1:], q[:, 1, ::2]], axis=1), axis=-1)
        near, far = np.array(geometry.proximal_lengths), np.array(geometry.distal_lengths)
        too_close, too_far = distance < np.abs(near - far), distance > near + far
        assert min(too_close.any(axis=1).mean(), too_far.any(axis=1).mean()) > 0.1
        wanted = np.minimum(near + far - distance, distance - np.abs(near - far)).min(axis=1)
        assert np.abs(robot.margin("reach", poses) - wanted).max() < 1e-14
        np.testing.assert_array_equal(np.isnan(robot.inverse(poses)).any(axis=1), (too_close | too_far).any(axis=1))


def test_the_mechanism_is_listed():
    assert MECHANISMS["Peppermill"] is Peppermill
