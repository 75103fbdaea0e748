"""Single rods of Delta and Par4: what they hold, by differences of their lengths on moved platforms."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinematics import Delta, Heli4, Par4
from tests.kinematics.numeric import differences


def poses(robot, count, seed):
    rng = np.random.default_rng(seed)
    spread = np.array([0.15, 0.15, 0.05, 1.0])[: len(robot.home)]
    return robot.home + spread * rng.uniform(-1, 1, (count, len(spread)))


def ends(robot, pose):
    """(2 m, 3) both ends of each rod, by the picture of the limbs' midlines."""
    lines, g = robot.polylines(pose), robot.geometry
    starts, stops = [], []
    for i, azimuth in enumerate(g.azimuths):
        axis = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
        for side in (-0.5, 0.5):
            start, stop = lines[f"rod {i + 1}"] + side * g.parallelogram_width * axis
            starts.append(start)
            stops.append(stop)
    return np.array(starts), np.array(stops)


def moved_delta(robot, pose, at):
    """The rods' lengths with the plate moved by `at` as a rigid body."""
    starts, stops = ends(robot, pose)
    turned = Rotation.from_rotvec(at[3:]).apply(stops - pose) + pose + at[:3]
    return np.linalg.norm(turned - starts, axis=1)


def moved_par4(robot, pose, at):
    """x, y, z, omega, theta: the halves turn as one; the bars turn between them by what the gear leaves."""
    g, (starts, stops) = robot.geometry, ends(robot, pose)
    turn = Rotation.from_rotvec(at[3:6])
    angle = g.bar_angle + pose[3] / g.amplification
    psi = (at[6] - at[5]) / g.amplification  # to first order
    lengths = []
    for k, (start, stop) in enumerate(zip(starts, stops, strict=True)):
        side = -0.5 if k < 4 else 0.5
        before, after = (side * g.bar_length * np.array([np.cos(a), np.sin(a), 0.0]) for a in (angle, angle + psi))
        place = turn.apply(stop - pose[:3] - before + after) + pose[:3] + at[:3]
        lengths.append(np.linalg.norm(place - start))
    return np.array(lengths)


CASES = [(Delta(), moved_delta, 6), (Par4(), moved_par4, 7)]
IDS = ["Delta", "Par4"]


@pytest.mark.parametrize(("robot", "moved", "freedoms"), CASES, ids=IDS)
def test_the_rod_system_is_that_of_lengths_on_a_moved_platform(robot, moved, freedoms):
    rod = robot.geometry.rod_length
    for pose in poses(robot, 10, seed=1):
        j_r = robot.rod_system(pose)[1]
        by_differences = differences(lambda at, p=pose: np.array(moved(robot, p, at)), np.zeros(freedoms), 1e-4)
        assert np.abs(j_r + rod * by_differences).max() < 1e-9  # rod_closure is half of squares, J_r its negative


@pytest.mark.parametrize("robot", [Delta(), Par4()], ids=IDS)
def test_means_and_differences_make_the_system_block_triangular(robot):
    at = poses(robot, 50, seed=2)
    j_l, j_r = robot.rod_system(at)
    n, m = len(robot.pose_names), len(robot.joint_names)
    assert np.abs((robot.row_combinations @ j_l)[:, m:]).max() < 1e-15
    assert np.abs((robot.row_combinations @ j_r @ robot.column_combinations)[:, m:, :n]).max() < 1e-15
    blocks, (j_q, j_x) = robot.block_triangular(at), robot.jacobians(at)
    np.testing.assert_allclose(blocks.j_q, j_q, atol=1e-14)
    np.testing.assert_allclose(blocks.j_x, j_x, atol=1e-14)


@pytest.mark.parametrize("robot", [Delta(), Par4()], ids=IDS)
def test_the_internal_determinant_is_the_volume_of_j_int_over_width_and_rods(robot):
    at = poses(robot, 200, seed=3)
    g, j_int = robot.geometry, robot.block_triangular(at).j_int
    unit = j_int / (g.parallelogram_width * g.rod_length)
    volume = np.sqrt(np.linalg.det(np.swapaxes(unit, -1, -2) @ unit))
    rows = unit.shape[1]
    expected = volume / (rows / 3) ** 1.5
    np.testing.assert_allclose(np.abs(robot.internal_determinant(at)), expected, rtol=1e-10)
    assert (expected <= 1.0).all()
    np.testing.assert_allclose(np.linalg.norm(unit, axis=-1).max(), 1.0, atol=0.05)  # its rows are shorter than 1


def test_the_internal_determinant_of_three_square_normals_is_one():
    """Delta's three limbs at 120 degrees: the plate where the normals lean by atan(1 / sqrt 2) from level."""
    robot = Delta()
    heights = np.linspace(-1.1, -0.2, 20_001)
    found = robot.internal_determinant(np.column_stack([np.zeros((len(heights), 2)), heights]))
    assert np.nanmax(np.abs(found)) == pytest.approx(1.0, abs=1e-6)


def test_delta_loses_its_plates_orientation_where_all_rods_are_parallel():
    """With L + r = R all rods hang straight down from level arms: no pair holds a turn about e_z."""
    robot = Delta(Delta.Geometry(base_radius=0.2, platform_radius=0.55, arm_length=0.35))
    down = np.array([0.0, 0.0, -0.8])
    assert abs(robot.internal_determinant(down)) < 1e-12
    assert robot.singularities(down)["internal"]
    assert robot.margin("internal_stiffness", down) < 1e-9 * robot.margin("internal_stiffness", [0.05, 0.02, -0.75])


@pytest.mark.parametrize("robot", [Heli4(), Delta(), Par4()], ids=["Heli4", *IDS])
def test_a_wider_parallelogram_keeps_the_determinant_and_holds_tilts_better(robot):
    wide = robot.with_geometry(robot.geometry.with_values(parallelogram_width=2 * robot.geometry.parallelogram_width))
    at = poses(robot, 5, seed=4)
    np.testing.assert_allclose(wide.internal_determinant(at), robot.internal_determinant(at), rtol=1e-9)
    ratio = wide.margin("internal_stiffness", at) / robot.margin("internal_stiffness", at)
    assert (ratio > 1.2).all()
    assert (ratio < 4.0).all()  # its square, but that arms twist, whatever the width
