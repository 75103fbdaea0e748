"""What the paper prints wrong: each printed relation contradicts the closure, the corrected one holds."""

from itertools import combinations

import numpy as np
import pytest

from kinematics import Redundant3T1R
from tests.kinematics.robots.redundant_3t1r.redundant_by_hand import (
    LEVELS,
    NINE_ANGLES,
    OUTER,
    ByHand,
    box,
    poses_at,
    quarter,
    reachable,
)

E_Z = np.array([0.0, 0, 1])


@pytest.fixture(scope="module")
def robot():
    return Redundant3T1R()


@pytest.fixture(scope="module")
def poses(robot):
    return reachable(robot, box(300, seed=1), margin=0.01)


def test_d_is_the_difference_of_two_x_components(robot):
    local, d = ByHand().local, robot.geometry.platform_length
    assert not np.isclose(abs(local[0, 0] - local[2, 2]), d)  # printed: |p_x1 - p_z3|
    assert np.isclose(abs(local[0, 0] - local[2, 0]), d)


def test_13_a_is_p_z1_less_p_z5(robot, poses):
    """With the printed sign arms 5 and 6 start from points that no pose of these joints has."""
    hand, errors = ByHand(), {1.0: [], -1.0: []}
    for pose in poses:
        joints = robot.inverse(pose)
        for sign, found in errors.items():
            with np.errstate(invalid="ignore"):
                candidates = np.array([c[2] for c in hand.direct(joints, height_of_b5=sign)])
            found.append(np.nan_to_num(np.abs(candidates - pose).max(axis=1), nan=9.0).min())
    assert max(errors[1.0]) < 1e-11
    assert np.isclose(hand.local[0, 2] - hand.local[4, 2], robot.geometry.platform_height)
    assert min(errors[-1.0]) > 1e-5
    assert np.median(errors[-1.0]) > 0.05


def test_before_35_the_added_column_is_that_of_p_1(robot, poses):
    hand = ByHand()
    n, levers = hand.directions(poses), hand.levers(poses)
    j_x = robot.jacobians(poses)[1]
    printed = np.einsum("kij,kij->ki", n, np.cross(levers, E_Z))  # ends in n_6 . (p_6 x e_z)
    corrected = np.einsum("kij,kj->ki", n, np.cross(levers[:, 0], E_Z))
    assert np.abs(j_x[..., 3] + printed).max() < 1e-14  # the printed one would leave a column of zeros
    r = hand.platform(poses)[:, 2] - hand.platform(poses)[:, 0]
    expected = -np.einsum("kij,kj->ki", n, np.cross(r, E_Z)) * [0, 0, 1, 1, 0, 0]  # (35)
    assert np.abs(j_x[..., 3] + corrected - expected).max() < 1e-14
    first_three = n @ np.cross(levers[:, 0], E_Z)[..., None]  # and it is a combination of the first three columns
    assert np.abs(first_three[..., 0] - corrected).max() < 1e-15


def test_37_the_second_plane_holds_b_5_not_b_3(poses):
    hand = ByHand()
    n, b = hand.directions(poses), hand.platform(poses)
    normal = np.cross(n[:, 4], n[:, 5])
    rails = hand.rails(hand.inverse(poses))
    for point, inside in ((4, True), (2, False)):
        off = np.abs(np.einsum("ki,ki->k", normal, b[:, point] - rails[:, 4]))
        assert (off < 1e-14).all() if inside else (off > 1e-6).all()


def test_38_it_is_n1_n2_n5_n6_that_span_space(poses):
    """Only these are the rows of M, (37): with z_1 -> a/2 they lose rank at z = 0, the printed set does not notice."""
    hand = ByHand()
    assert (np.linalg.svd(hand.directions(poses)[:, OUTER])[1][:, 2] > 0.1).all()
    flat = ByHand()
    flat.z = LEVELS * (0.1 + 1e-9)
    pose = np.array([0.0, 0.05, 0.0, 0.4])
    n = flat.directions(pose)
    assert np.linalg.svd(n[OUTER])[1][2] < 1e-8
    assert np.linalg.matrix_rank(flat.jacobians(pose)[1], tol=1e-8) == 3  # nothing holds z
    tilted = flat.directions(pose + 0.1 * np.eye(4)[2])
    assert np.linalg.svd(tilted[[0, 1, 2, 5]])[1][2] > 0.01
    assert np.linalg.svd(tilted[OUTER])[1][2] < 1e-7


def test_z1_need_only_differ_from_half_the_platforms_height():
    """|z_1 - z_3| > |p_z1 - p_z3| is called necessary; with z_1 = 0.02 < a/2 = 0.1 the robot is as regular."""
    low = Redundant3T1R(Redundant3T1R.Geometry(outer_rail_z=0.02))
    poses = reachable(low, box(20_000, seed=2, z=0.6), margin=1e-3)
    assert np.abs(low.forward(low.inverse(poses)) - poses).max() < 1e-11
    assert low.margin("det_J_x", poses).min() > 0.01
    n = ByHand(low.geometry).directions(poses)
    assert (np.einsum("ki,ki->k", n[:, 0], np.cross(n[:, 1], n[:, 4])) > 0.01).all()


def test_39_40_the_polytopes_are_slabs_not_zonotopes(robot, poses):
    """v_w of (40) is right for {t : |J_mw t| <= 1}; the zonotope J_w [-1, 1]^6 holds velocities no drives give."""
    directions = np.random.default_rng(3).normal(size=(4000, 4))
    excess = []
    for pose in poses[:20]:
        j_mw = ByHand().homogeneous(pose)
        j_w, (v_w, f_w) = np.linalg.pinv(j_mw), robot.isotropic(pose)
        excess.append([zonotope_radius(j_w.T) / v_w, zonotope_radius(j_mw) / f_w])
        for rows, radius in ((j_mw, v_w), (j_w.T, f_w)):
            unit = directions / np.linalg.norm(directions, axis=1, keepdims=True)
            worst = rows[np.linalg.norm(rows, axis=1).argmax()]
            unit = np.vstack([unit, worst / np.linalg.norm(worst)])
            assert np.isclose((1 / np.abs(unit @ rows.T).max(axis=1)).min(), radius, rtol=1e-12)
    assert np.min(excess) > 1.001
    assert (np.max(excess, axis=0) > 1.1).all()


def zonotope_radius(generators):
    """Largest ball about 0 in sum of [-1, 1] g_i, over the normals of all triples."""
    radii = []
    for triple in combinations(generators, 3):
        _, values, vectors = np.linalg.svd(np.array(triple))
        if values[2] > 1e-12 * values[0]:
            radii.append(np.abs(generators @ vectors[3]).sum())
    return min(radii)


def test_between_the_nine_angles_the_fvi_dips_below_one_near_the_regions_edge(robot):
    nodes, area = quarter()
    nine = np.min([np.nan_to_num(robot.fvi(poses_at(nodes, t))) for t in NINE_ANGLES], axis=0)
    dense = np.min([np.nan_to_num(robot.fvi(poses_at(nodes, np.deg2rad(t)))) for t in range(-90, 91, 3)], axis=0)
    dips = (nine >= 1) & (dense < 1)
    assert dips.any()
    assert dense[dips].min() > 0.99  # by two thousandths only
    assert nine[dips].max() < 1.005  # and at the edge only
    assert area[dips].sum() < 0.01


def test_the_placement_that_reproduces_table_1_matters(robot):
    """Points 1, 2 and 5, 6 at one end of the platform, 3, 4 at the other: d is their distance seen from above."""
    b = ByHand().platform(np.array([0.0, 0, 0, 0.7]))
    apart = b[2] - b[0]
    assert np.isclose(np.hypot(apart[0], apart[1]), robot.geometry.platform_length)
    assert np.isclose(apart[2], -robot.geometry.platform_height / 2)
