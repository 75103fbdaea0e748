"""The rod-level system (49) built by hand, its triangular form (50)-(55), and what its determinants are."""

import numpy as np
import pytest

from kinematics import Heli4
from tests.kinematics.by_hand import OBLIQUE, UPPER, ByHand, cylinder, random_geometry

BOTH = pytest.mark.parametrize("robot", [Heli4(), Heli4(OBLIQUE)], ids=["prototype", "oblique"])
POSES = cylinder(2_000, seed=1, radius=0.3)


def by_hand(robot):
    """l (k, 4, 3), e (k, 4, 2, 3) from M to B_ij, d (4, 3) from B_i1 to B_i2, r (k, 4, 3)."""
    hand, joints = ByHand(robot.geometry), robot.inverse(POSES)
    d = robot.geometry.parallelogram_width * hand.axes
    e = (hand.platforms(POSES) - POSES[:, None, :3])[:, :, None] + np.stack([-d / 2, d / 2], axis=1)
    return hand.rods(POSES, joints), e, d, hand.arm_tangents(joints)


@BOTH
def test_rod_system_is_equiprojectivity_of_each_rods_ends(robot):
    rods, e, _, tangents = by_hand(robot)
    j_l, j_r = np.zeros((len(POSES), 8, 4)), np.zeros((len(POSES), 8, 8))
    for i in range(4):
        for side in range(2):
            row, moment = 2 * i + side, np.cross(e[:, i, side], rods[:, i])
            j_l[:, row, i] = (tangents[:, i] * rods[:, i]).sum(-1)
            j_r[:, row, :3] = rods[:, i]
            j_r[:, row, 3:6] = moment
            j_r[:, row, 6 + i // 2] = moment[:, 2]
            j_r[:, row, 7] -= UPPER[i] * ByHand(robot.geometry).pitch * rods[:, i, 2]
    found_l, found_r = robot.rod_system(POSES)
    assert np.abs(found_l - j_l).max() < 1e-15
    assert np.abs(found_r - j_r).max() < 1e-15


@BOTH
def test_sums_and_differences_of_rods_make_it_block_triangular(robot):
    rods, e, d, _ = by_hand(robot)
    pitch = ByHand(robot.geometry).pitch
    blocks = robot.block_triangular(POSES)
    j_q, j_x = robot.jacobians(POSES)
    middle, twist = np.cross(e.mean(axis=2), rods), np.cross(d, rods)
    zero = 0 * UPPER
    j_int_x = np.stack(
        [middle[..., 0], middle[..., 1], (1 - UPPER) * middle[..., 2], UPPER * (middle[..., 2] - pitch * rods[..., 2])],
        axis=-1,
    )
    j_int = np.stack([twist[..., 0], twist[..., 1], (1 - UPPER) * twist[..., 2], UPPER * twist[..., 2] + zero], axis=-1)
    assert np.abs(blocks.j_q - j_q).max() < 1e-15
    assert np.abs(blocks.j_x - j_x).max() < 1e-15
    assert np.abs(blocks.j_int_x - j_int_x).max() < 1e-15
    assert np.abs(blocks.j_int + j_int).max() < 1e-15  # rod 1 less rod 2, and d points from B_i1 to B_i2


@BOTH
def test_the_lower_left_blocks_vanish(robot):
    j_l, j_r = robot.rod_system(POSES)
    assert np.abs((robot.row_combinations @ j_l)[:, 4:]).max() < 1e-15
    assert np.abs((robot.row_combinations @ j_r @ robot.column_combinations)[:, 4:, :4]).max() < 1e-15


def test_combinations_keep_every_determinant():
    assert abs(np.linalg.det(Heli4.row_combinations) - 1) < 1e-14
    assert abs(np.linalg.det(Heli4.column_combinations) - 1) < 1e-14


@BOTH
def test_the_whole_determinant_is_the_product_of_two(robot):
    _, j_r = robot.rod_system(POSES)
    _, j_x, _, j_int = robot.block_triangular(POSES)
    whole, product = np.linalg.det(j_r), np.linalg.det(j_x) * np.linalg.det(j_int)
    signs = np.linalg.det(robot.row_combinations) * np.linalg.det(robot.column_combinations)
    assert np.abs(whole - signs * product).max() < 1e-12 * np.abs(product).max()


@BOTH
def test_both_determinants_are_one_triple_vector_product(robot):
    rods, _, d, _ = by_hand(robot)
    _, j_x, _, j_int = robot.block_triangular(POSES)

    def of(normals):
        first = np.cross(normals[:, 0], normals[:, 1])
        return np.cross(first, np.cross(normals[:, 2], normals[:, 3]))[:, 2]

    def in_parallel(vectors):
        return np.cross(np.cross(vectors[:, 0], vectors[:, 1]), np.cross(vectors[:, 2], vectors[:, 3]))[:, 2]

    expression = of(np.cross(d, rods))
    g = robot.geometry
    scale = g.parallelogram_width**4 * g.rod_length**4
    assert np.abs(np.linalg.det(j_int) + expression).max() < 1e-13 * scale
    assert np.abs(robot.internal_determinant(POSES) - expression / scale).max() < 1e-13
    expected = ByHand(g).pitch * in_parallel(rods)
    assert np.abs(np.linalg.det(j_x) + expected).max() < 1e-14


def test_normalised_determinants_stay_within_one_on_any_geometry():
    rng = np.random.default_rng(2)
    for _ in range(20):
        robot = Heli4(random_geometry(rng))
        poses = cylinder(2_000, seed=3, radius=0.8, z=(-1.0, 0.2))
        for values in (robot.internal_determinant(poses), robot.margin("det_J_x", poses), robot.margin("J_q", poses)):
            known = values[~np.isnan(values)]
            assert known.size > 50
            assert np.abs(known).max() <= 1.0


def test_the_workspace_holds_no_singularity_of_any_kind():
    robot, poses = Heli4(), cylinder(1_000_000, seed=4)
    for name, least in (("J_q", 0.4), ("det_J_x", 0.4), ("internal_determinant", 0.4)):
        assert robot.margin(name, poses).min() > least


def test_the_rods_distance_drops_out():
    narrow, wide = (Heli4(OBLIQUE.with_values(parallelogram_width=d)) for d in (0.01, 0.3))
    assert np.array_equal(narrow.internal_determinant(POSES), wide.internal_determinant(POSES))


def test_adjacent_limbs_on_one_plate_make_home_singular():
    robot = Heli4(Heli4.Geometry(azimuths=(0.0, np.pi / 2, np.pi, 3 * np.pi / 2)))
    assert abs(robot.internal_determinant(robot.home)) < 1e-15
    assert robot.margin("det_J_x", robot.home) < 1e-15
    assert abs(Heli4().internal_determinant(Heli4().home)) > 0.9
