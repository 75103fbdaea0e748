"""Assembly modes of the planar robots, Delta, Par4 and Hexa: none lost, none invented, by Newton from all over."""

import numpy as np
import pytest

from kinematics import Delta, Hexa, Par4, Planar3PRR, Planar3RPR, Planar3RRR
from kinematics.robots.planar.forward import placements
from tests.kinematics.robots.family.family_by_hand import PLANAR, ByHand, poses_of, random_geometry, robots
from tests.sizes import few_or_many

EACH_PLANAR = pytest.mark.parametrize("kind", PLANAR, ids=lambda kind: kind.__name__)
DEG = np.pi / 180
SIZES = ("base_points", "platform_points", "arm_length", "rod_length")  # of Hexa


def equations(hand, joints):
    """(k, n) poses -> (k, m) squared lengths less what they should be."""
    if hand.kind is Planar3RPR:
        base = np.column_stack([np.array(hand.robot.geometry.base_points), np.zeros(3)])
        return lambda poses: ((hand.platform(poses) - base) ** 2).sum(-1) - joints**2
    ends = hand.tangents_and_ends(joints)[1]
    return lambda poses: ((ends - hand.platform(poses)) ** 2).sum(-1) - hand.rod_lengths**2


def multistart(robot, joints, starts):
    """All solutions that a damped Newton's method finds, its Jacobian by differences: (k, n)."""
    f, n = equations(ByHand(robot), joints), starts.shape[1]
    x, damping = starts.copy(), np.full(len(starts), 1e-2)
    error = f(x)
    for _ in range(80):
        step = 1e-6 * np.eye(n)
        jacobian = np.stack([(f(x + e) - f(x - e)) / 2e-6 for e in step], axis=-1)
        normal = np.swapaxes(jacobian, -1, -2) @ jacobian
        right = -np.einsum("kij,ki->kj", jacobian, error)
        change = np.linalg.solve(normal + damping[:, None, None] * np.eye(n), right[..., None])[..., 0]
        after = f(x + change)
        better = (after**2).sum(1) <= (error**2).sum(1)
        x, error = np.where(better[:, None], x + change, x), np.where(better[:, None], after, error)
        damping = np.clip(np.where(better, damping * 0.1, damping * 10.0), 1e-16, 1e3)
    return x[np.abs(error).max(axis=1) < 1e-13]


def as_points(robot, poses):
    """(k, ...) what tells poses apart, whatever their angles count."""
    place = poses[:, : 2 if type(robot) in PLANAR else 3]
    ends = ByHand(robot).platform(poses).reshape(len(poses), -1)
    return np.concatenate([place, ends], axis=1)


def assert_same_set(robot, joints, modes, found, all_found=True):
    apart = np.linalg.norm(as_points(robot, found)[:, None] - as_points(robot, modes)[None], axis=-1)
    assert (apart.min(axis=1) < 1e-5).all()  # every pose found is a mode
    if all_found:
        assert (apart.min(axis=0) < 1e-5).all()  # and every mode was found
    assert np.abs(ByHand(robot).gaps(modes, np.broadcast_to(joints, (len(modes), joints.size)))).max() < 1e-13


def starts_of(robot, count, seed):
    rng = np.random.default_rng(seed)
    sizes = {Par4: [0.6, 0.6, 1.2, np.pi * getattr(robot.geometry, "amplification", 1.0)], Delta: [1.0] * 3}
    return rng.uniform(-1, 1, (count, len(robot.pose_names))) * sizes.get(type(robot), [0.8, 0.8, np.pi])


def wide(kind, rng):
    """Triangles of any shape."""
    points = {
        name: tuple(map(tuple, rng.uniform(-0.5, 0.5, (3, 2)).tolist())) for name in ("base_points", "platform_points")
    }
    return kind(kind.Geometry().with_values(**points))


@EACH_PLANAR
@few_or_many(4, 13)
def test_planar_modes_are_those_that_newtons_method_finds_from_everywhere(kind, count):
    rng, counts = np.random.default_rng(1), set()
    for trial in range(30):
        robot = wide(kind, rng)
        joints = robot.inverse(poses_of(kind, 1, trial)[0])
        if np.isnan(joints).any():
            continue
        modes = robot.assembly_modes(joints)
        counts.add(len(modes))
        assert_same_set(robot, joints, modes, multistart(robot, joints, starts_of(robot, 300, trial)), False)
        if len(counts) == 3 and trial >= count:
            break
    assert 4 in counts
    assert counts <= {2, 4, 6}


@EACH_PLANAR
@few_or_many(40, 150)
def test_planar_modes_come_in_pairs_and_hold_the_pose_that_gave_the_joints(kind, count):
    rng, counted, most = np.random.default_rng(2), 0, 0
    for trial in range(count):
        robot = wide(kind, rng)
        for pose in poses_of(kind, 4, trial):
            joints = robot.inverse(pose)
            if np.isnan(joints).any():
                continue
            modes = robot.assembly_modes(joints)
            counted, most = counted + 1, max(most, len(modes))
            assert len(modes) % 2 == 0
            assert np.abs(modes - pose).max(axis=1).min() < 1e-9
    assert counted > count
    assert most == 6


@EACH_PLANAR
def test_a_platform_turned_upside_down_is_found(kind):
    """theta = pi, where tan(theta / 2) has no value."""
    rods = {Planar3PRR: {"rod_lengths": (0.9,) * 3}, Planar3RRR: {"rod_lengths": (0.6,) * 3}}.get(kind, {})
    robot = kind(kind.Geometry().with_values(**rods))
    poses = np.column_stack([poses_of(kind, 40, 3)[:, :2], np.full(40, np.pi)])
    for pose in poses:
        joints = robot.inverse(pose)
        assert not np.isnan(joints).any()
        modes = robot.assembly_modes(joints)
        turn = np.abs(np.exp(1j * modes[:, 2]) - np.exp(1j * pose[2]))
        assert (np.abs(modes[:, :2] - pose[:2]).max(axis=1) + turn).min() < 1e-9
        assert np.abs(robot.forward(joints, near=pose)[:2] - pose[:2]).max() < 1e-9


def test_two_modes_of_one_angle_are_both_found():
    """Symmetry about the x axis: the three circles' centres u_i are on one line, so the sextic has a double root."""
    base = ((-0.5, 0.0), (0.1, 0.0), (0.6, 0.0))
    robot = Planar3RPR(Planar3RPR.Geometry(base_points=base, platform_points=((-0.1, 0.0), (0.03, 0.0), (0.2, 0.0))))
    pose = np.array([0.05, 0.3, 0.0])
    modes = robot.assembly_modes(robot.inverse(pose))
    for wanted in (pose, pose * [1, -1, 1]):
        assert np.abs(modes - wanted).max(axis=1).min() < 1e-9
    assert len(modes) % 2 == 0


def test_a_negative_leg_has_no_mode():
    robot = Planar3RPR()
    joints = robot.inverse(robot.home) * [1, -1, 1]
    assert robot.assembly_modes(joints).shape == (0, 3)
    assert np.isnan(robot.forward(joints)).all()


def test_forward_goes_where_near_points():
    robot = Planar3RPR()
    joints = robot.inverse(robot.home)
    for mode in robot.assembly_modes(joints):
        found = robot.forward(joints, near=mode)
        assert np.abs(found[:2] - mode[:2]).max() < 1e-12
        assert abs(np.exp(1j * found[2]) - np.exp(1j * mode[2])) < 1e-12


def test_placements_of_no_problem_and_of_no_solution():
    none = placements(np.zeros((0, 3), complex), np.zeros((0, 3)), np.array([0, 1, 1j]))
    assert [len(part) for part in none] == [0, 0, 0]
    far = placements(np.array([[0, 50, 100j]]), np.ones((1, 3)), np.array([0, 1, 1j]), every=True)
    assert [len(part) for part in far] == [0, 0, 0]


@pytest.mark.parametrize("which", [0, 1])
def test_delta_has_the_two_modes_that_newtons_method_finds(which):
    robot = robots(Delta)[which]
    for trial, joints in enumerate(robot.inverse(poses_of(Delta, 10, 4))):
        modes = robot.assembly_modes(joints)
        assert len(modes) == 2
        assert modes[0, 2] < modes[1, 2]
        assert_same_set(robot, joints, modes, multistart(robot, joints, starts_of(robot, 40, trial)))


def test_delta_counted_clockwise_works_below_too():
    robot = Delta(Delta.Geometry(azimuths=(240 * DEG, 120 * DEG, 0.0)))
    poses = poses_of(Delta, 1000, 5)
    assert np.abs(robot.forward(robot.inverse(poses)) - poses).max() < 1e-12


def test_delta_with_equal_elbows_in_one_point_has_no_isolated_mode():
    robot = Delta(Delta.Geometry(base_radius=0.05, platform_radius=0.05))
    assert robot.assembly_modes(np.zeros(3)).shape == (0, 3)
    assert np.isnan(robot.forward(np.zeros(3))).all()


def strange_par4(rng):
    return Par4(
        Par4.Geometry(
            base_radius=rng.uniform(0.1, 0.5),
            platform_radius=rng.uniform(0.05, 0.4),
            arm_length=rng.uniform(0.2, 0.5),
            rod_length=rng.uniform(0.5, 0.8),
            azimuths=tuple(rng.uniform(0, 2 * np.pi, 4)),
            bar_length=rng.uniform(0.1, 0.9),
            bar_angle=rng.uniform(0, 2 * np.pi),
            amplification=1.0,
        )
    )


@few_or_many(8, 25)
def test_par4_modes_are_those_that_newtons_method_finds_from_everywhere(count):
    rng, counts = np.random.default_rng(6), []
    for trial in range(count):
        robot = strange_par4(rng)
        joints = rng.uniform(0, np.pi, 4)
        modes = robot.assembly_modes(joints)
        counts.append(len(modes))
        found = multistart(robot, joints, starts_of(robot, 200, trial))
        if len(modes):
            assert_same_set(robot, joints, modes, found, all_found=False)
        else:
            assert not len(found)
    assert all(count % 2 == 0 for count in counts)
    assert max(counts) >= 4


def test_par4_can_have_as_many_modes_as_its_octic_has_roots():
    robot = Par4(
        Par4.Geometry(
            base_radius=0.32,
            platform_radius=0.19,
            arm_length=0.31,
            rod_length=0.72,
            azimuths=(4.28, 0.08, 1.86, 6.08),
            bar_length=0.53,
            bar_angle=4.37,
            amplification=1.0,
        )
    )
    joints = np.array([0.01, 0.85, 1.05, 0.2])
    modes = robot.assembly_modes(joints)
    assert len(modes) == 8
    assert_same_set(robot, joints, modes, multistart(robot, joints, starts_of(robot, 3_000, 11)))


@pytest.mark.parametrize("pose", [(0, 0, -0.8, 0), (0.1, 0, -0.8, 0), (0, 0.15, -0.75, 0), (0, 0, -0.7, 1.0)], ids=str)
def test_par4_modes_of_symmetric_poses(pose):
    """Where limbs are alike, modes may share a height: double roots of the octic."""
    robot, pose = Par4(), np.array(pose, dtype=float)
    joints = robot.inverse(pose)
    modes = robot.assembly_modes(joints)
    assert np.abs(modes[0] - pose).max() < 1e-9
    found = multistart(robot, joints, starts_of(robot, 400, 7))
    assert_same_set(robot, joints, modes, found)


def test_hexas_modes_close_and_hold_the_pose_and_what_newtons_method_finds():
    robot = Hexa(random_geometry(Hexa, np.random.default_rng(8)))
    pose = poses_of(Hexa, 1, 9)[0]
    joints = robot.inverse(pose)
    modes = robot.assembly_modes(joints)
    assert 2 <= len(modes) <= 40
    assert len(modes) % 2 == 0
    assert np.abs(modes - pose).max(axis=1).min() < 1e-9
    starts = np.random.default_rng(10).uniform(-1, 1, (300, 6)) * [0.4, 0.4, 0.8, np.pi, 1.5, np.pi]
    assert_same_set(robot, joints, modes, multistart(robot, joints, starts), all_found=False)


def test_hexa_says_where_newtons_method_did_not_converge():
    short = Hexa(Hexa.Geometry(rod_length=0.4))  # arms straight out, elbows farther from each other than rods reach
    solution = short.newton(np.full((2, 6), np.pi / 2))
    assert not solution.converged.any()
    assert np.isnan(solution.pose).all()
    assert (solution.residual > 0.01).all()
    robot = Hexa()
    solution = robot.newton(robot.inverse(robot.home))
    assert solution.converged
    assert solution.iterations <= 3


@pytest.mark.parametrize("scale", [0.1, 1.0, 3.0, 10.0])
def test_hexa_of_any_size_finds_the_poses_near_its_home_from_its_own_start(scale):
    g = Hexa().geometry
    sizes = {name: scale * np.array(getattr(g, name)) for name in SIZES}
    robot, units = Hexa(g.with_values(**sizes)), np.array([scale] * 3 + [1.0] * 3)
    np.testing.assert_allclose(robot.home, Hexa().home * units, atol=1e-15 * scale)
    around = np.random.default_rng(21).uniform(-1, 1, (2000, 6)) * [0.1, 0.1, 0.05, 0.4, 0.4, 0.4]
    poses = (np.array(Hexa().home) + around) * units
    assert np.abs((robot.forward(robot.inverse(poses)) - poses) / units).max() < 1e-9
