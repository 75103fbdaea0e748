"""Rod by rod: the parallelograms must hold the platform upright; and how near the arms come to each other."""

import re

import casadi as ca
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import brentq, lsq_linear, minimize

from kinematics import Redundant3T1R
from kinematics.mathematics.segment_distance import nearest_symbolic, segment_distances
from tests.kinematics.robots.redundant_3t1r.redundant_by_hand import (
    NINE_ANGLES,
    ByHand,
    box,
    poses_at,
    quarter,
    random_geometry,
    reachable,
)

LIMBS = [0, 1, 2, 2, 3, 3, 4, 5]
SIDES = np.array([0, 0, -0.5, 0.5, -0.5, 0.5, 0, 0])


@pytest.fixture(scope="module")
def robot():
    return Redundant3T1R()


def rotation(vector):
    """Rodrigues' formula."""
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    x, y, z = vector / angle
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


def rod_lengths(robot, pose, joints, moved, short_side=(0.0, 0, 1)):
    """Lengths of all eight rods after a finite displacement (3) and rotation vector (3) of the platform."""
    hand = ByHand(robot.geometry)
    offsets = np.outer(SIDES * robot.geometry.parallelogram_width, short_side)
    rails = hand.rails(joints)[LIMBS] + offsets
    levers = hand.levers(pose)[LIMBS] + offsets
    ends = pose[:3] + moved[:3] + levers @ rotation(moved[3:]).T
    return np.linalg.norm(ends - rails, axis=1)


def test_rod_system_is_the_rods_lengths_by_central_differences(robot):
    for pose in reachable(robot, box(20, seed=1)):
        joints, step = robot.inverse(pose), 1e-6
        j_l, j_r = robot.rod_system(pose)
        assert j_l.shape == (8, 6)
        assert j_r.shape == (8, 6)
        for k in range(6):
            push = step * np.eye(6)[k]
            by_platform = rod_lengths(robot, pose, joints, push) - rod_lengths(robot, pose, joints, -push)
            by_joint = rod_lengths(robot, pose, joints + push, 0 * push) - rod_lengths(
                robot, pose, joints - push, 0 * push
            )
            assert np.abs(by_platform / (2 * step) - j_r[:, k]).max() < 1e-8
            assert np.abs(by_joint / (2 * step) + j_l[:, k]).max() < 1e-8


def test_only_upright_short_sides_let_the_platform_turn(robot):
    """A turn about e_z by the inverse model keeps every rod's length; with level short sides it would not."""
    pose, turned = np.array([0.0, 0.1, 0.2, 0.1]), np.array([0.0, 0.1, 0.2, 0.7])
    joints, turn = robot.inverse(turned), np.array([0, 0, 0, 0, 0, 0.6])
    wanted = ByHand().lengths[LIMBS]
    assert np.abs(rod_lengths(robot, pose, joints, turn) - wanted).max() < 1e-15
    for level in ([1.0, 0, 0], [0.0, 1, 0], [0.6, 0.8, 0]):
        assert np.abs(rod_lengths(robot, pose, joints, turn, level) - wanted).max() > 1e-3


def test_blocks_are_triangular_and_their_corners_are_j_q_j_x_and_j_int(robot):
    poses = reachable(robot, box(2_000, seed=2), margin=1e-3)
    j_l, j_r = robot.rod_system(poses)
    rows, columns = robot.row_combinations, robot.column_combinations
    assert np.abs((rows @ j_l)[:, 6:]).max() < 1e-15
    assert np.abs((rows @ j_r @ columns)[:, 6:, :4]).max() < 1e-15
    blocks, (j_q, j_x) = robot.block_triangular(poses), robot.jacobians(poses)
    assert np.abs(blocks.j_q - j_q).max() < 1e-14
    assert np.abs(blocks.j_x - j_x).max() < 1e-14
    width = robot.geometry.parallelogram_width
    assert np.abs(np.linalg.det(blocks.j_int) / width**2 - robot.internal_determinant(poses)).max() < 1e-13


def test_internal_determinant_is_n3_cross_n4_along_e_z_and_does_not_know_the_width(robot):
    poses = reachable(robot, box(5_000, seed=3))
    n = ByHand().directions(poses)
    expected = np.cross(n[:, 2], n[:, 3])[:, 2]
    wide = Redundant3T1R(robot.geometry.with_values(parallelogram_width=0.3))
    for tested in (robot, wide):
        assert np.abs(tested.internal_determinant(poses) - expected).max() < 1e-14
    assert np.allclose(robot.margin("internal_determinant", poses), np.abs(expected), rtol=1e-13)


def test_the_parallelograms_hold_the_tilt_everywhere_inside_reach():
    """The determinant keeps the sign of y_3: n_3 and n_4 are parallel, seen from above, only at the edge of reach."""
    rng = np.random.default_rng(4)
    for seed in range(40):
        geometry = random_geometry(rng)
        other = Redundant3T1R(geometry)
        poses = reachable(other, box(3_000, seed=seed, y=1.5, z=1.5))
        value = other.internal_determinant(poses)
        assert (value * np.sign(geometry.middle_rail_y) > 0).all()
        assert (np.abs(value) <= 1).all()


def test_with_all_rods_the_machine_has_four_freedoms_and_none_is_a_tilt(robot):
    for pose in reachable(robot, box(100, seed=5)):
        j_l, j_r = robot.rod_system(pose)
        _, values, vectors = np.linalg.svd(np.hstack([j_l, -j_r]))
        assert (values > 1e-4).all()
        assert len(vectors[8:]) == 4
        assert np.abs(vectors[8:, [9, 10]]).max() < 1e-10  # omega_x, omega_y


# Distances.


def nearest_by_search(one, two):
    """The same as a bounded linear least-squares problem."""
    across = np.column_stack([one[1] - one[0], two[0] - two[1]])
    solution = lsq_linear(across, two[0] - one[0], bounds=(0, 1), tol=1e-15, max_iter=500)
    return np.linalg.norm(across @ solution.x - two[0] + one[0])


coordinate = st.integers(-3, 3).map(float)
point = st.tuples(coordinate, coordinate, coordinate)


@given(point, point, point, point)
def test_segment_distance_against_a_numeric_search(a, b, c, d):
    """Integer coordinates make parallel, crossing, touching and point-like segments common."""
    one, two = np.array([a, b]), np.array([c, d])
    assert np.isclose(segment_distances(one, two), nearest_by_search(one, two), atol=1e-7)
    assert np.isclose(segment_distances(one, two), segment_distances(two[::-1], one), atol=1e-12)


def test_arms_come_within_5_4_mm_inside_the_papers_region(robot):
    """Free of collisions, says the paper: at its region's edge arm 3 passes B_6 and, mirrored, arm 4 passes B_5."""

    def edge(y):
        def worst(z):
            return robot.fvi(poses_at(np.tile([y, z], (9, 1)), NINE_ANGLES)).min() - 1

        return brentq(worst, 0.3, 0.75, xtol=1e-13)

    def clearance(place):
        return float(robot.arm_clearance(np.array([0, place[0], edge(place[0]), place[1]])))

    found = minimize(clearance, [0.01, -0.6], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
    assert abs(found.fun - 5.4e-3) < 5e-5
    pose = np.array([0, found.x[0], edge(found.x[0]), found.x[1]])
    distances = robot.arm_distances(pose)
    assert np.allclose([distances[4, 5], distances[4, 6]], found.fun, atol=1e-9)
    hand = ByHand()
    end = hand.platform(pose)[4]
    assert np.isclose(
        segment_distances([hand.rails(hand.inverse(pose))[3], hand.platform(pose)[3]], [end, end]), found.fun
    )
    mirrored = robot.arm_distances(pose * [1, -1, 1, -1])
    assert np.isclose(mirrored[3, 6], found.fun, atol=1e-9)
    nodes, _ = quarter(41, top=0.75)  # and nowhere in the region is it less
    inside = nodes[np.min([robot.fvi(poses_at(nodes, t)) for t in NINE_ANGLES], axis=0) >= 1]
    assert (
        min(robot.arm_clearance(poses_at(inside, t)).min() for t in np.linspace(-np.pi / 2, np.pi / 2, 61)) >= found.fun
    )


def test_parallelogram_rods_0_1_m_apart_meet_other_arms_inside_the_papers_region(robot):
    """The paper is silent on the width. At 0.1 m a rod of arm 4 touches another arm where its middle line does not."""
    robot = robot.with_geometry(robot.geometry.with_values(parallelogram_width=0.1))
    y, theta = -0.15935, 0.593411945678072
    nodes = np.column_stack([np.full(400, y), np.linspace(0.4, 0.6, 400)])
    poses = poses_at(nodes, theta)
    assert (np.min([robot.fvi(poses_at(nodes, t)) for t in NINE_ANGLES], axis=0) >= 1)[:200].all()
    assert robot.arm_clearance(poses, rods=True).min() < 1e-3
    assert robot.arm_clearance(poses).min() > 5e-3


def test_arm_distances_are_those_of_segments_by_hand(robot):
    poses, hand = reachable(robot, box(20, seed=6)), ByHand()
    distances = robot.arm_distances(poses)
    assert len(distances) == 12
    rails, platform = hand.rails(hand.inverse(poses)), hand.platform(poses)
    for (i, j), found in distances.items():
        for k in range(len(poses)):
            one, two = (np.array([rails[k, m - 1], platform[k, m - 1]]) for m in (i, j))
            assert np.isclose(found[k], nearest_by_search(one, two), atol=1e-8)
    assert np.array_equal(robot.arm_clearance(poses), np.min(list(distances.values()), axis=0))
    assert np.isnan(robot.arm_clearance(np.array([0.0, 0, 3, 0])))


def symbolic_distance():
    one, two = ca.SX.sym("one", 3, 2), ca.SX.sym("two", 3, 2)
    return ca.Function("distance", [one, two], [ca.norm_2(nearest_symbolic(one, two)[0])])


SYMBOLIC = symbolic_distance()


@given(point, point, point, point)
def test_the_symbolic_segment_distance_is_the_numeric_one(a, b, c, d):
    assume(a != b and c != d)
    one, two = np.array([a, b]), np.array([c, d])
    assert np.isclose(float(SYMBOLIC(one.T, two.T)), segment_distances(one, two), rtol=0, atol=1e-12)


def test_the_clearance_of_the_rods_is_that_of_their_axes_less_two_radii(robot):
    poses = reachable(robot, box(60, seed=17, y=0.6, z=0.8), margin=0.01)
    model = robot.model()
    parts = robot.margin_components("clearance", robot.fvi_bounds, robot.characteristic_length)
    places = robot.margins["clearance"].places(robot)
    pairs = [re.fullmatch(r"rod (\d)( [ab])? and rod (\d)( [ab])?", place) for place in places]
    rods = [i for i, pair in enumerate(pairs) if pair and {pair[1], pair[3]} not in ({"3"}, {"4"}, {"3", "4"})]
    at = ca.Function("rods", [model.pose, model.geometry], [ca.mmin(parts[rods])])
    found = np.array([float(at(pose, robot.geometry.vector())) for pose in poses])
    by_axes = robot.arm_clearance(poses, rods=True) - 2 * robot.geometry.rod_radius
    assert len(poses) > 20
    assert np.abs(found - by_axes).max() < 1e-9


def test_the_clearance_margin_has_the_slopes_of_central_differences(robot):
    model = robot.model()
    components = robot.margin_components("clearance", robot.fvi_bounds, robot.characteristic_length)
    slopes = ca.Function("slopes", [model.pose, model.geometry], [components, ca.jacobian(components, model.pose)])

    def at(pose):
        return [v.full() for v in slopes(pose, robot.geometry.vector())]

    for pose in reachable(robot, box(30, seed=18), margin=0.05):
        (values, found), h = at(pose), 1e-6
        numeric = np.hstack([(at(pose + h * e)[0] - at(pose - h * e)[0]) / (2 * h) for e in np.eye(4)])
        smooth = values[:, 0] > 0.01
        assert np.abs(found - numeric)[smooth].max() < 1e-5


def test_the_real_rods_of_the_parallelograms_are_half_a_width_off_the_axis(robot):
    poses, half = reachable(robot, box(50, seed=7)), robot.geometry.parallelogram_width / 2
    by_axis, by_rods = robot.arm_distances(poses), robot.arm_distances(poses, rods=True)
    for pair, distance in by_rods.items():
        if 3 in pair or 4 in pair:
            assert (np.abs(distance - by_axis[pair]) <= half + 1e-12).all()
            assert (np.abs(distance - by_axis[pair]) > 1e-6).any()
        else:
            assert np.array_equal(distance, by_axis[pair])
