"""Every real pose of given joints is found, none is invented, and the working one comes first.

The oracle eliminates as the paper does, slips mended, down to a quartic in y that mpmath solves with 40 digits: other
unknowns and other algebra than the model's own quartic.
"""

import mpmath as mp
import numpy as np
import pytest

from kinematics import Heli4, InvalidShape
from tests.kinematics.by_hand import OBLIQUE, UPPER, ByHand, cylinder, random_geometry
from tests.kinematics.robots.redundant_3t1r.printed_forward import poses_by_elimination


def exact_real_roots(coefficients):
    """Real roots, or None where two roots are too close for double precision to tell."""
    with mp.workdps(40):
        companion = mp.matrix(4, 4)
        for i, c in enumerate(coefficients[1:]):
            companion[0, i] = -mp.mpf(float(c)) / mp.mpf(float(coefficients[0]))
        for i in range(3):
            companion[i + 1, i] = 1
        roots = mp.eig(companion, left=False, right=False)
        size = max(abs(r) for r in roots)
        apart = min(abs(a - b) for i, a in enumerate(roots) for b in roots[:i])
        if apart < 1e-5 * size:
            return None
        return sorted(float(r.real) for r in roots if abs(r.imag) < 1e-20 * size)


def joint_samples(geometry, count, seed):
    """Joints of poses in the workspace, and joints at random."""
    rng = np.random.default_rng(seed)
    near = Heli4(geometry).inverse(cylinder(count, seed, radius=0.3))
    far = rng.uniform(0.0, np.pi, (count, 4))
    return np.concatenate([near[~np.isnan(near).any(-1)], far])


def check(geometry, joints):
    """Number of modes, or None for a sample that the oracle leaves out."""
    robot, hand = Heli4(geometry), ByHand(geometry)
    undecided = []

    def roots_of(coefficients):
        roots = exact_real_roots(coefficients)
        undecided.append(roots is None)
        return roots or []

    expected = poses_by_elimination(hand, joints, roots_of)
    if any(undecided):
        return None
    modes = robot.assembly_modes(joints)
    assert len(modes) == len(expected)
    assert np.abs(hand.gaps(modes, joints)).max(initial=0.0) < 1e-12
    assert all(np.abs(a - b).max() > 1e-6 for i, a in enumerate(modes) for b in modes[:i])
    return len(modes)


SHORT_RODS = Heli4.Geometry(rod_length=0.55, height_step=0.05)


@pytest.mark.parametrize(
    ("geometry", "possible"),
    [(Heli4.Geometry(), {4}), (OBLIQUE, {4}), (SHORT_RODS, {0, 2, 4})],
    ids=["prototype", "oblique", "short rods"],
)
def test_no_real_solution_is_lost(geometry, possible):
    counts = [check(geometry, joints) for joints in joint_samples(geometry, 25, seed=1)]
    assert counts.count(None) <= 0.06 * len(counts)
    assert set(counts) - {None} == possible


@pytest.mark.parametrize("geometry", [Heli4.Geometry(), Heli4.Geometry(height_step=0.05, pitch=-0.02)], ids=str)
@pytest.mark.parametrize("turn", [0.0, 1e-12, 1e-7, 1e-3])
def test_all_four_modes_where_every_joint_is_alike(geometry, turn):
    """On the axis the quartic has a double root at zero: the two modes with one plate up and one down."""
    robot = Heli4(geometry)
    joints = robot.inverse([0.0, 0.0, -0.7, turn])
    modes = robot.assembly_modes(joints)
    below = ((modes[:, 2] < 0) * 2 + (modes[:, 2] + modes[:, 3] * ByHand(geometry).pitch < 0)).tolist()
    assert sorted(below) == [0, 1, 2, 3]
    assert np.abs(ByHand(geometry).gaps(modes, joints)).max() < 1e-14


def test_no_real_solution_is_lost_on_random_geometries():
    rng = np.random.default_rng(2)
    counts = []
    for _ in range(12):
        geometry = random_geometry(rng)
        counts += [check(geometry, joints) for joints in joint_samples(geometry, 2, seed=3)]
    assert counts.count(None) < 0.1 * len(counts)


def test_newton_from_everywhere_finds_nothing_more():
    """Newton's method on the closure itself, from 2000 starts, ends on the listed poses only, and on all of them."""
    robot, hand = Heli4(OBLIQUE), ByHand(OBLIQUE)
    longest = np.array([0.5, 0.5, 0.5, 60.0])
    rng = np.random.default_rng(4)
    for joints in robot.inverse(cylinder(4, seed=5, radius=0.2)):
        x = rng.uniform([-1, -1, -1.2, -90], [1, 1, 1.2, 90], (2000, 4))
        for _ in range(60):
            rods = hand.rods(x, joints)
            residual = ((rods**2).sum(-1) - OBLIQUE.rod_length**2) / 2
            slope = -np.concatenate([rods, hand.pitch * UPPER[:, None] * rods[..., 2:]], axis=-1)
            x = x - np.clip(np.linalg.solve(slope, residual[..., None])[..., 0], -longest, longest)
        solved = x[np.abs(hand.gaps(x, joints)).max(-1) < 1e-12]
        distance = np.abs(solved[:, None] - robot.assembly_modes(joints))[..., :3].max(-1)
        assert len(solved) > 500
        assert distance.min(axis=1).max() < 1e-8
        assert distance.min(axis=0).max() < 1e-8


def test_the_working_mode_comes_first_and_is_what_forward_gives():
    robot, poses = Heli4(OBLIQUE), cylinder(300, seed=6, radius=0.25)
    for pose, joints in zip(poses, robot.inverse(poses), strict=True):
        modes = robot.assembly_modes(joints)
        assert np.abs(modes[0] - pose).max() < 1e-11
        assert np.array_equal(modes[0], robot.forward(joints))


def test_joints_that_no_pose_has_give_none():
    """Arms stretched apart, and rods too short to meet."""
    robot = Heli4(Heli4.Geometry(rod_length=0.6))
    joints = np.full(4, np.pi / 2)
    assert robot.assembly_modes(joints).shape == (0, 4)
    assert np.isnan(robot.forward(joints)).all()


def test_one_set_of_joints_at_a_time():
    with pytest.raises(InvalidShape, match="one at a time"):
        Heli4().assembly_modes(np.zeros((2, 4)))
