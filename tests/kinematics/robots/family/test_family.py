"""What holds for each of the six: round trips, Jacobians, scales, symmetries; all by the same base."""

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from design import Box, worst_poses
from kinematics import MECHANISMS, Delta, FviBounds, Hexa, Par4, Planar3RPR, Planar3RRR, inverse_dynamics
from kinematics.dynamics.drive_torque import GRAVITY
from tests.kinematics.numeric import differences
from tests.kinematics.robots.family.family_by_hand import FAMILY, PLANAR, ByHand, poses_of, random_geometry, robots
from tests.sizes import few_or_many

EACH = pytest.mark.parametrize("kind", FAMILY, ids=lambda kind: kind.__name__)
BOTH = pytest.mark.parametrize("which", [0, 1], ids=["default", "oblique"])


def reached(robot, count, seed, share=1.0):
    """Poses with their joints."""
    poses = poses_of(type(robot), count, seed, share)
    joints = robot.inverse(poses)
    good = ~np.isnan(joints).any(axis=1)
    assert good.mean() > 0.9
    return poses[good], joints[good]


def assert_round_trip(robot, poses, joints):
    found = robot.forward(joints)
    assert np.abs(found - poses).max() < 1e-11
    assert np.abs(ByHand(robot).gaps(found, joints)).max() < 1e-13


@EACH
def test_it_is_listed(kind):
    assert MECHANISMS[kind.__name__] is kind


@EACH
@few_or_many(20_000, 1_000_000)
def test_poses_of_the_workspace_come_back(kind, count):
    robot, total, part = robots(kind)[0], 0, 0
    while total < count:
        poses, joints = reached(robot, 100_000 if count > 100_000 else count, seed=part)
        assert_round_trip(robot, poses, joints)
        total, part = total + len(poses), part + 1
    assert part < 1.2 * count / 100_000 + 2


@EACH
@few_or_many(8, 1000)
def test_round_trips_of_random_geometries(kind, count):
    rng = np.random.default_rng(2)
    for _ in range(count):
        robot = kind(random_geometry(kind, rng))
        assert_round_trip(robot, *reached(robot, 10, seed=3, share=0.4))


@EACH
@BOTH
def test_the_inverse_closes_every_loop(kind, which):
    robot = robots(kind)[which]
    poses, joints = reached(robot, 20_000, seed=4)
    assert np.abs(ByHand(robot).gaps(poses, joints)).max() < 1e-14
    assert np.abs(robot.closure_residual(poses, joints)).max() < 1e-14


@EACH
@BOTH
def test_jacobians_are_those_built_by_hand(kind, which):
    robot = robots(kind)[which]
    poses, joints = reached(robot, 2_000, seed=5)
    hand = ByHand(robot)
    ends = hand.platform(poses)
    if kind is Planar3RPR:
        legs = ends - np.column_stack([np.array(robot.geometry.base_points), np.zeros(3)])
        rods, diagonal = legs / np.linalg.norm(legs, axis=-1, keepdims=True), np.ones((len(poses), 3))
    else:
        rods = hand.rods(poses, joints)
        diagonal = (rods * hand.tangents_and_ends(joints)[0]).sum(axis=-1)
    place = np.column_stack([poses[:, :2], 0 * poses[:, 0]]) if kind in PLANAR else poses[:, :3]
    moments = np.cross(ends - place[:, None], rods)
    columns = {Delta: [rods], Hexa: [rods, moments]}.get(kind, [rods[..., :2], moments[..., 2:]])
    if kind is Par4:
        g = robot.geometry
        turned = g.bar_angle + poses[:, 3] / g.amplification
        normal = np.stack([-np.sin(turned), np.cos(turned), 0 * turned], axis=-1)
        slide = g.bar_length / 2 / g.amplification * (rods * normal[:, None]).sum(-1) * [-1, -1, 1, 1]
        columns = [rods, slide[..., None]]
    j_q, j_x = robot.jacobians(poses)
    assert np.abs(j_q - diagonal[..., None] * np.eye(len(kind.joint_names))).max() < 1e-13
    assert np.abs(j_x - np.concatenate(columns, axis=-1)).max() < 1e-13


@EACH
@BOTH
def test_jacobians_are_derivatives_of_the_closure_by_differences_and_by_differentiation(kind, which):
    robot = robots(kind)[which]
    poses, joints = reached(robot, 500, seed=6)
    j_q, j_x = robot.jacobians(poses)
    assert np.abs(j_q - differences(lambda q: robot.closure_residual(poses, q), joints, 1e-3)).max() < 1e-9
    by_pose = differences(lambda x: robot.closure_residual(x, joints), poses, 1e-3)
    pose = ca.SX.sym("pose", len(kind.pose_names))
    rates = ca.Function("rates", [pose], [kind.pose_rate_map(pose)])
    maps = np.array([np.array(rates(p)) for p in poses])
    assert np.abs(j_x + by_pose @ maps).max() < 1e-9
    model = robot.model()
    exact = ca.Function("exact", [model.pose, model.joints, model.geometry], [ca.jacobian(model.closure, model.pose)])
    by_ad = np.array([np.array(exact(p, q, robot.geometry.vector())) for p, q in zip(poses, joints, strict=True)])
    assert np.abs(j_x + by_ad @ maps).max() < 1e-12


@EACH
@BOTH
def test_the_inverse_jacobian_undoes_the_derivative_of_the_forward_model(kind, which):
    robot = robots(kind)[which]
    poses, joints = reached(robot, 300, seed=7, share=0.5)
    if kind is Hexa:
        by_pose = differences(robot.inverse, poses, 1e-4)
        pose = ca.SX.sym("pose", 6)
        rates = ca.Function("rates", [pose], [kind.pose_rate_map(pose)])
        by_twist = by_pose @ np.array([np.array(rates(p)) for p in poses])
        assert np.abs(robot.inverse_jacobian(poses) - by_twist).max() < 1e-7
    else:
        product = robot.inverse_jacobian(poses) @ differences(robot.forward, joints, 1e-4)
        assert np.abs(product - np.eye(len(kind.joint_names))).max() < 1e-6


@EACH
def test_determinants_are_within_one_all_over_and_for_random_geometries(kind):
    rng = np.random.default_rng(8)
    for robot in [robots(kind)[0], *(kind(random_geometry(kind, rng)) for _ in range(10))]:
        poses = poses_of(kind, 3_000, 9, share=3.0)
        _, j_x = robot.jacobians(poses)
        names = ("J_q", "det_J_q", "det_J_x")
        margins = {name: robot.margin(name, poses) for name in names}
        good = np.isfinite(margins["det_J_x"]) & np.isfinite(j_x).all(axis=(1, 2))
        assert good.sum() > 100
        for name in names:
            assert margins[name][good].min() >= 0.0
            assert margins[name][good].max() <= 1.0 + 1e-12
        ratio = np.abs(np.linalg.det(j_x[good])) / margins["det_J_x"][good]
        assert np.ptp(ratio) < 1e-6 * ratio.mean()


@EACH
def test_fvi_and_determinants_do_not_depend_on_the_size_of_the_robot(kind):
    small, size = robots(kind)[1], 3.0
    lengths = {
        f: (np.array(v) * size).tolist()
        for f, v in small.geometry.as_dict().items()
        if not f.endswith(("azimuths", "angles", "angle", "amplification"))
    }
    lengths = {f: tuple(map(tuple, v)) if np.ndim(v) == 2 else v for f, v in lengths.items()}
    big = kind(small.geometry.with_values(**{f: tuple(v) if isinstance(v, list) else v for f, v in lengths.items()}))
    poses, _ = reached(small, 500, seed=10, share=0.5)
    scaled = poses * [1.0 if i in kind.rotations else size for i in range(poses.shape[1])]
    for name in ("J_q", "det_J_q", "det_J_x"):
        assert np.abs(small.margin(name, poses) - big.margin(name, scaled)).max() < 1e-12
    rotary = kind.joint_units[0] == "rad"
    speed, force = (size, 1 / size) if rotary else (1.0, 1.0)
    bounds = kind.fvi_bounds
    same = FviBounds(bounds.joint_speed, bounds.joint_effort, bounds.speed * speed, bounds.force * force)
    assert np.abs(small.fvi(poses) / big.fvi(scaled, same) - 1).max() < 1e-9


@EACH
@settings(max_examples=15, deadline=None)
@given(turn=st.floats(-3.0, 3.0))
def test_turning_the_base_turns_the_pose_and_no_joint(kind, turn):
    robot = robots(kind)[1]
    g = robot.geometry.as_dict()
    c, s = np.cos(turn), np.sin(turn)
    changes = {}
    for name, value in g.items():
        if name == "base_points":
            points = np.array(value)
            points[:, :2] = points[:, :2] @ np.array([[c, s], [-s, c]])
            changes[name] = tuple(map(tuple, points.tolist()))
        elif name.endswith(("azimuths", "angles")) or name == "bar_angle":
            changes[name] = (np.array(value) + turn).tolist()
            changes[name] = tuple(changes[name]) if np.ndim(value) else changes[name]
    turned = kind(robot.geometry.with_values(**changes))
    poses, joints = reached(robot, 50, seed=11, share=0.5)
    moved = poses.copy()
    moved[:, :2] = poses[:, :2] @ np.array([[c, s], [-s, c]])
    if kind in PLANAR or kind is Hexa:
        moved[:, -1] += turn
    assert np.abs(turned.inverse(moved) - joints).max() < 1e-12
    assert np.abs(turned.margin("det_J_x", moved) - robot.margin("det_J_x", poses)).max() < 1e-12


@EACH
def test_reach_is_what_a_rod_can_lose_or_gain(kind):
    if kind is Planar3RPR:
        return
    robot = robots(kind)[0]
    poses = poses_of(kind, 200, 12, 2.0)
    reach = robot.margin("reach", poses)
    field = "rod_lengths" if kind in PLANAR else "rod_length"
    rod = getattr(robot.geometry, field)
    for change in (-0.03, 0.03):
        longer = tuple(v + change for v in rod) if isinstance(rod, tuple) else rod + change
        other = kind(robot.geometry.with_values(**{field: longer}))
        closes = ~np.isnan(other.inverse(poses)).any(axis=1)
        assert closes[reach > 0.03].all()


@EACH
def test_a_resting_robot_bears_its_weight(kind):
    """Virtual work: the torques of rest are the gradient of the potential energy by the joints."""
    robot = robots(kind)[1]
    poses, _ = reached(robot, 20, seed=13, share=0.4)
    rest = np.zeros_like(poses)
    model = robot.model()
    bodies = robot.bodies(model.pose, model.joints, model.g, 2.0)
    energy = sum((p.mass * GRAVITY * p.point[2] for p in bodies.all_particles()), ca.SX(0))
    height = ca.Function("e", [model.pose, model.joints, model.geometry], [energy])

    def potential(x):
        q = robot.inverse(x)
        return np.array([[float(height(p, j, robot.geometry.vector()))] for p, j in zip(x, q, strict=True)])

    torques = inverse_dynamics(robot, 2.0, poses, rest, rest)
    by_pose = differences(potential, poses, 1e-4)[:, 0]
    rates = ca.Function("rates", [model.pose], [kind.pose_rate_map(model.pose)])
    by_twist = np.einsum("ki,kij->kj", by_pose, np.array([np.array(rates(p)) for p in poses]))
    assert np.abs(np.einsum("kij,ki->kj", robot.inverse_jacobian(poses), torques) - by_twist).max() < 1e-6


@EACH
def test_the_drawing_starts_at_the_base_and_ends_at_the_platform(kind):
    robot = robots(kind)[1]
    lines = robot.polylines(kind().home)
    ends = ByHand(robot).platform(kind().home)
    limbs = [line for name, line in lines.items() if name.startswith(("rod", "leg"))]
    assert np.abs(np.array([line[-1] for line in limbs]) - ends).max() < 1e-14
    assert all(np.isfinite(line).all() and line.shape[1] == 3 for line in lines.values())


@EACH
def test_a_box_by_the_poses_names_is_searched_for_its_worst_pose(kind):
    robot, centre = kind(), np.array(kind().home)
    names = kind.pose_names
    half = np.where([i in kind.rotations for i in range(len(names))], 0.2, 0.02)
    region = Box(**{name: (c - h, c + h) for name, c, h in zip(names, centre, half, strict=True)})
    worst = worst_poses(robot, region, "det_J_x", about=2_000, descents=8)
    at_random = robot.margin("det_J_x", region.random(names, 5_000, np.random.default_rng(14)))
    assert worst.value <= at_random.min() + 1e-12
    assert robot.margin("det_J_x", worst.pose) == pytest.approx(worst.value, abs=1e-15)


@pytest.mark.parametrize("kind", [Planar3RRR, Delta, Hexa, Par4], ids=lambda kind: kind.__name__)
@BOTH
def test_every_elbow_is_kept_on_one_side_of_the_line_from_platform_to_drive(kind, which):
    """Counter-clockwise about the arm's axis as the joint is counted: left of that line, or outside and below it."""
    robot = robots(kind)[which]
    poses, joints = reached(robot, 2_000, seed=15)
    hand = ByHand(robot)
    tangents, _ = hand.tangents_and_ends(joints)
    assert ((hand.rods(poses, joints) * tangents).sum(-1) < 0.0).all()
    if kind is Planar3RRR:
        base = np.column_stack([np.array(robot.geometry.base_points), np.zeros(3)])
        line, rods = base - hand.platform(poses), hand.rods(poses, joints)
        assert (np.cross(line, rods)[..., 2] > 0.0).all()
