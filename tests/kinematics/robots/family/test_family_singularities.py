"""Singularities built by geometry, found by the margins: legs through one point, limbs stretched, rods in a plane."""

import numpy as np
import pytest

from design import Box, worst_poses
from kinematics import Delta, Hexa, Par4, Planar3PRR, Planar3RPR, Planar3RRR
from tests.kinematics.robots.family.family_by_hand import ByHand, poses_of, radial, random_geometry, robots

DEG = np.pi / 180


def rows(points):
    return tuple(map(tuple, np.asarray(points)[:, :2].tolist()))


def through_one_point(kind, pose, point, rng):
    """(3, 3) where rods begin whose lines all pass the point, and the platform's geometry."""
    ends = ByHand(kind()).platform(pose)
    return ends, point + rng.uniform(1.5, 3.0, (3, 1)) * (ends - point)


@pytest.mark.parametrize("seed", range(5))
def test_3rpr_with_legs_through_one_point_is_singular(seed):
    rng = np.random.default_rng(seed)
    pose = poses_of(Planar3RPR, 1, seed)[0]
    _, base = through_one_point(Planar3RPR, pose, np.array([*rng.uniform(-0.3, 0.3, 2), 0.0]), rng)
    robot = Planar3RPR(Planar3RPR.Geometry(base_points=rows(base)))
    assert robot.margin("det_J_x", pose) < 1e-15
    assert robot.margin("det_J_x", pose + np.array([0, 0, 0.1])) > 1e-3
    assert robot.isotropic(pose)[1] < 1e-14
    assert robot.margin("J_q", pose) == 1.0


@pytest.mark.parametrize("seed", range(5))
def test_3prr_with_rods_through_one_point_is_singular(seed):
    rng = np.random.default_rng(seed)
    pose = poses_of(Planar3PRR, 1, seed)[0]
    ends, sliders = through_one_point(Planar3PRR, pose, np.array([*rng.uniform(-0.3, 0.3, 2), 0.0]), rng)
    rods = ends - sliders
    rails = np.arctan2(rods[:, 1], rods[:, 0]) + rng.uniform(-1, 1, 3)  # each rod leads up its rail
    base = sliders - rng.uniform(-0.2, 0.2, (3, 1)) * radial(rails)
    geometry = Planar3PRR.Geometry(
        base_points=rows(base), rod_lengths=tuple(np.linalg.norm(rods, axis=1)), rail_angles=tuple(rails)
    )
    robot = Planar3PRR(geometry)
    assert robot.margin("det_J_x", pose) < 1e-14
    assert robot.margin("J_q", pose) > 0.1


@pytest.mark.parametrize("seed", range(5))
def test_3rrr_with_rods_through_one_point_is_singular(seed):
    rng = np.random.default_rng(seed)
    pose = poses_of(Planar3RRR, 1, seed)[0]
    ends, elbows = through_one_point(Planar3RRR, pose, np.array([*rng.uniform(-0.3, 0.3, 2), 0.0]), rng)
    to_elbow = elbows - ends
    turn = np.arctan2(to_elbow[:, 1], to_elbow[:, 0]) + rng.uniform(0.5, 2.5, 3)  # of the arms: elbows on the kept side
    zero, arms = rng.uniform(-1, 1, 3) + turn - 1.0, rng.uniform(0.1, 0.3, 3)
    geometry = Planar3RRR.Geometry(
        base_points=rows(elbows - arms[:, None] * radial(turn)),
        arm_lengths=tuple(arms),
        rod_lengths=tuple(np.linalg.norm(to_elbow, axis=1)),
        zero_angles=tuple(zero),
    )
    robot = Planar3RRR(geometry)
    assert np.abs(np.exp(1j * robot.inverse(pose)) - np.exp(1j * (turn - zero))).max() < 1e-12
    assert robot.margin("det_J_x", pose) < 1e-14
    assert robot.margin("J_q", pose) > 0.1


def test_3rpr_becomes_singular_after_a_quarter_turn_and_a_search_finds_it():
    """There every leg points at the centre."""
    robot = Planar3RPR()
    worst = worst_poses(robot, Box(x=0.0, y=0.0, theta=(0.0, 2.0)), "det_J_x", about=100)
    assert worst.pose[2] == pytest.approx(np.pi / 2, abs=1e-6)
    assert worst.value < 1e-6


def test_a_stretched_limb_is_at_the_end_of_its_reach_and_its_joint_is_singular():
    for kind, field in ((Planar3PRR, "rod_lengths"), (Planar3RRR, "rod_lengths")):
        robot = kind()
        reach = robot.margin("reach", robot.home)
        rods = tuple(length - reach for length in getattr(robot.geometry, field))
        edge = kind(robot.geometry.with_values(**{field: tuple(r + 1e-12 for r in rods)}))
        assert abs(edge.margin("reach", edge.home)) < 1e-11
        assert edge.margin("J_q", edge.home) < 1e-5
        beyond = kind(robot.geometry.with_values(**{field: tuple(r - 1e-9 for r in rods)}))
        assert np.isnan(beyond.inverse(beyond.home)).all()


@pytest.mark.parametrize("kind", [Delta, Par4, Hexa], ids=lambda kind: kind.__name__)
def test_arm_and_rod_in_line_are_the_end_of_reach(kind):
    robot = kind()
    low, high = np.array(kind().home), np.array(kind().home)
    high[2] = -2.0
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (low, middle) if np.isnan(robot.inverse(middle)).any() else (middle, high)
    assert abs(robot.margin("reach", low)) < 1e-12
    assert robot.margin("J_q", low) < 1e-6
    arm, rod = robot.geometry.arm_length, robot.geometry.rod_length
    hand = ByHand(robot)
    tangents, ends = hand.tangents_and_ends(robot.inverse(low))
    assert np.abs((tangents * hand.rods(low, robot.inverse(low))).sum(-1)).max() < 1e-6 * arm * rod
    assert np.isfinite(ends).all()


def test_delta_with_its_rods_in_one_plane_is_singular():
    q = 2.0
    g = Delta.Geometry()
    flat = g.base_radius + g.arm_length * np.sin(q) - g.platform_radius
    robot = Delta(g.with_values(rod_length=flat))
    pose = np.array([0.0, 0.0, g.arm_length * np.cos(q)])
    assert np.abs(robot.inverse(pose) - q).max() < 1e-12
    assert robot.margin("det_J_x", pose) < 1e-14
    assert robot.margin("det_J_x", pose - [0, 0, 0.1]) > 0.01
    for change in (1e-3, -1e-3):  # on one side of it the two modes have met and gone
        modes = robot.assembly_modes(np.full(3, q + change))
        assert len(modes) == (2 if change > 0 else 0)
    assert np.ptp(robot.assembly_modes(np.full(3, q + 1e-3))[:, 2]) < 0.1


@pytest.mark.parametrize("which", [0, 1], ids=["default", "oblique"])
def test_par4s_determinant_is_a_product_of_its_rods(which):
    """det J_x = +- b / k ((l1 x l2) x (l3 x l4)) . e, e the horizontal normal of the bars."""
    robot = robots(Par4)[which]
    g, poses = robot.geometry, poses_of(Par4, 2_000, 1)
    rods = ByHand(robot).rods(poses, robot.inverse(poses))
    turned = g.bar_angle + poses[:, 3] / g.amplification
    normal = np.stack([-np.sin(turned), np.cos(turned), 0 * turned], axis=-1)
    lines = np.cross(np.cross(rods[:, 0], rods[:, 1]), np.cross(rods[:, 2], rods[:, 3]))
    expected = g.bar_length / g.amplification * (lines * normal).sum(-1)
    found = np.linalg.det(robot.jacobians(poses)[1])
    assert np.abs(found - np.sign(found[0] * expected[0]) * expected).max() < 1e-14
    assert robot.margin("det_J_x", poses) == pytest.approx(
        np.abs(expected) / (g.bar_length / g.amplification * g.rod_length**4), abs=1e-13
    )


def test_par4_with_bars_across_is_singular_at_home():
    """Bars along x: turning them moves both halves along y, which spreads or lifts the limbs as z does."""
    robot = Par4(Par4.Geometry(bar_angle=0.0))
    assert robot.margin("det_J_x", robot.home) < 1e-14


def test_par4s_parallelogram_is_flat_a_quarter_turn_of_its_bars_on():
    robot = Par4()
    pose = np.array([0.0, 0.0, -0.8, robot.geometry.amplification * np.pi / 2])
    assert abs(robot.margin("pi_joint", pose)) < 1e-15
    assert robot.margin("pi_joint", robot.home) == 1.0
    assert robot.margin("pi_joint", pose / [1, 1, 1, 1.5]) == pytest.approx(0.5)


def test_par4_without_a_gear_turns_with_its_bars():
    geared, plain = Par4(), Par4(Par4.Geometry(amplification=1.0))
    poses = poses_of(Par4, 500, 2)
    assert np.abs(plain.inverse(poses / [1, 1, 1, 4]) - geared.inverse(poses)).max() < 1e-14


def test_par4s_halves_stay_a_bar_apart_and_level():
    robot = Par4(random_geometry(Par4, np.random.default_rng(3)))
    g, poses = robot.geometry, poses_of(Par4, 500, 3)
    ends = ByHand(robot).platform(poses)
    own = g.platform_radius * radial(g.azimuths) - g.bar_length / 2 * radial(g.bar_angle) * np.array(
        [[-1], [-1], [1], [1]]
    )
    pivots = ends - own
    assert np.abs(pivots[:, 0] - pivots[:, 1]).max() < 1e-15
    assert np.abs(pivots[:, 2] - pivots[:, 3]).max() < 1e-15
    between = pivots[:, 2] - pivots[:, 0]
    assert np.abs(np.linalg.norm(between, axis=1) - g.bar_length).max() < 1e-15
    assert np.abs(between[:, 2]).max() < 1e-15


def test_hexa_with_a_platform_similar_to_its_elbows_is_singular():
    """The rods then lie on the lines of a Gough-Stewart platform with similar hexagons, level with each other."""
    base = Hexa()
    joints = base.inverse(base.home)
    elbows = ByHand(base).tangents_and_ends(joints)[1]
    points = 0.3 * elbows * [1, 1, 0]
    rod = float(np.linalg.norm(elbows[0] - points[0] - base.home[:3]))
    robot = Hexa(base.geometry.with_values(platform_points=tuple(map(tuple, points.tolist())), rod_length=rod))
    assert np.abs(robot.inverse(base.home) - joints).max() < 1e-12
    assert robot.margin("det_J_x", base.home) < 1e-14
    assert robot.margin("det_J_x", base.home) < 1e-9 * base.margin("det_J_x", base.home)
