"""FVI, force capability and dynamics with more drives than freedoms; (39), (40), Table I."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from kinematics import FviBounds, Heli4, InvalidValue, Redundant3T1R, inverse_dynamics
from kinematics.dynamics.drive_torque import GRAVITY
from tests.kinematics.robots.redundant_3t1r.redundant_by_hand import (
    NINE_ANGLES,
    ByHand,
    box,
    poses_at,
    quarter,
    random_geometry,
    reachable,
)
from tests.kinematics.weighed import REDUNDANT

ROBOT = Redundant3T1R(inertia=REDUNDANT)
in_region = st.tuples(st.floats(-5, 5), st.floats(-0.3, 0.3), st.floats(-0.6, 0.6), st.floats(-np.pi, np.pi))


def test_isotropic_speed_and_force_are_40_with_numpys_pseudo_inverse():
    poses = reachable(ROBOT, box(20_000, seed=1), margin=1e-2)
    j_mw = ByHand().homogeneous(poses)
    speed = 1 / np.linalg.norm(j_mw, axis=2).max(axis=1)
    force = 1 / np.linalg.norm(np.linalg.pinv(j_mw), axis=1).max(axis=1)
    v_w, f_w = ROBOT.isotropic(poses)
    assert np.abs(v_w / speed - 1).max() < 1e-12
    assert np.abs(f_w / force - 1).max() < 1e-12
    assert np.allclose(ROBOT.fvi(poses), np.minimum(v_w, f_w) / 0.5, rtol=1e-14)  # half the drives' limits


def test_fvi_takes_other_bounds_and_another_characteristic_length():
    pose, bounds = np.array([0.0, 0.1, 0.2, 0.3]), FviBounds(2.0, 100.0, 0.7, 60.0)
    v_w, f_w = ROBOT.isotropic(pose, characteristic_length=0.2)
    assert np.isclose(ROBOT.fvi(pose, bounds, 0.2), min(2.0 * v_w / 0.7, 100.0 * f_w / 60.0), rtol=1e-14)
    assert v_w != ROBOT.isotropic(pose)[0]
    with pytest.raises(InvalidValue, match="characteristic_length"):
        ROBOT.fvi(pose, characteristic_length=0.0)


def test_table_1_area_mean_and_deviation():
    nodes, area = quarter()
    level = np.nan_to_num(ROBOT.fvi(poses_at(nodes, 0.0)))
    turned = np.min([np.nan_to_num(ROBOT.fvi(poses_at(nodes, t))) for t in NINE_ANGLES], axis=0)
    for fvi, (total, mean, deviation) in ((level, (0.79, 1.21, 0.08)), (turned, (0.69, 1.14, 0.07))):
        inside = fvi >= 1
        weights = area[inside]
        found = np.average(fvi[inside], weights=weights)
        assert abs(weights.sum() - total) < 0.01
        assert abs(found - mean) < 0.005
        assert abs(np.sqrt(np.average((fvi[inside] - found) ** 2, weights=weights)) - deviation) < 0.005


@given(in_region)
def test_fvi_is_symmetric_about_y_and_z_and_ignores_x(pose):
    x, y, z, theta = pose
    mirrored = [[0, y, z, theta], [x, -y, z, -theta], [x, y, -z, theta], [x, y, z, theta + 2 * np.pi]]
    assert np.allclose(ROBOT.fvi(np.array(mirrored)), ROBOT.fvi(np.array(pose)), rtol=1e-11)


@settings(max_examples=30)
@given(st.integers(0, 10_000), st.floats(0.01, 100), in_region)
def test_fvi_does_not_change_with_the_robots_size(seed, scale, pose):
    geometry = random_geometry(np.random.default_rng(seed))
    larger = Redundant3T1R.Geometry.from_vector(scale * geometry.vector())
    robot, pose = Redundant3T1R(geometry), np.array(pose)
    assume(robot.margin("reach", pose) > 1e-3)
    fvi = robot.fvi(pose)
    scaled = Redundant3T1R(larger).fvi(pose * [scale, scale, scale, 1])
    assert np.allclose(fvi, scaled, rtol=1e-10)


@settings(max_examples=30)
@given(st.integers(0, 10_000), st.floats(-0.5, 0.5), in_region)
def test_fvi_depends_on_z1_and_a_only_through_z1_less_half_a(seed, change, pose):
    geometry = random_geometry(np.random.default_rng(seed))
    height = geometry.platform_height * (1 + change)
    rail = geometry.outer_rail_z + (height - geometry.platform_height) / 2
    other = geometry.with_values(platform_height=height, outer_rail_z=rail)
    robot = Redundant3T1R(geometry)
    assume(robot.margin("reach", np.array(pose)) > 1e-3)
    assert np.allclose(robot.fvi(np.array(pose)), Redundant3T1R(other).fvi(np.array(pose)), rtol=1e-10)


def test_worst_speed_is_that_of_the_slab_of_joint_limits():
    """Largest ball in {t : |J_mw t| <= 1}: from a linear programme's support in many directions it is never left."""
    for pose in reachable(ROBOT, box(5, seed=2)):
        j_mw, v_w = ByHand().homogeneous(pose), ROBOT.isotropic(pose)[0]
        directions = np.random.default_rng(3).normal(size=(20_000, 4))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        assert (np.abs(directions @ j_mw.T).max(axis=1) * v_w <= 1 + 1e-12).all()
        worst = j_mw[np.linalg.norm(j_mw, axis=1).argmax()]
        assert np.isclose(np.abs(j_mw @ (v_w * worst / np.linalg.norm(worst))).max(), 1.0)


def brute_force_capability(j_mw):
    """Smallest support of the zonotope over the normals that numpy finds for every three rows."""
    found = []
    for rows in combinations(range(6), 3):
        _, values, vectors = np.linalg.svd(j_mw[list(rows)])
        if values[2] > 1e-12:
            found.append(np.abs(j_mw @ vectors[3]).sum())
    return min(found)


def test_force_capability_is_exact_by_facets_and_by_linear_programming():
    rng = np.random.default_rng(4)
    for pose in reachable(ROBOT, box(25, seed=5)):
        j_mw, radius = ByHand().homogeneous(pose), ROBOT.force_capability(pose)
        assert np.isclose(radius, brute_force_capability(j_mw), rtol=1e-10)
        for direction in rng.normal(size=(20, 4)):
            unit = direction / np.linalg.norm(direction)
            solution = linprog(
                np.r_[np.zeros(6), -1], A_eq=np.c_[j_mw.T, -unit], b_eq=np.zeros(4), bounds=[(-1, 1)] * 6 + [(0, None)]
            )
            assert -solution.fun >= radius * (1 - 1e-9)


def test_true_force_capability_is_never_below_the_minimum_norm_one():
    poses = reachable(ROBOT, box(200_000, seed=6))
    gain = ROBOT.force_capability(poses) / ROBOT.isotropic(poses)[1]
    assert gain.min() >= 1.0
    assert gain.max() > 1.3
    for seed in range(12):
        other = Redundant3T1R(random_geometry(np.random.default_rng(seed)))
        poses = reachable(other, box(500, seed=7), margin=1e-3)
        if len(poses):
            assert (other.force_capability(poses) >= other.isotropic(poses)[1] * (1 - 1e-12)).all()


def test_force_capability_is_nan_out_of_reach_and_zero_on_a_singularity():
    assert np.isnan(ROBOT.force_capability(np.array([0.0, 0, 3, 0])))
    geometry = Redundant3T1R.Geometry()
    object.__setattr__(geometry, "outer_rail_z", 0.1 + 1e-13)  # a geometry that the constructor refuses
    flat = Redundant3T1R(geometry)
    assert flat.force_capability(np.array([0.0, 0.05, 0, 0.4])) < 1e-10


def test_without_redundancy_the_force_capability_is_f_w():
    heli = Heli4()
    poses = np.random.default_rng(8).uniform([-0.3, -0.3, -0.8, -3], [0.3, 0.3, -0.6, 3], (2_000, 4))
    assert np.allclose(heli.force_capability(poses), heli.isotropic(poses)[1], rtol=1e-12)


# Dynamics.


def motion(count, seed):
    rng = np.random.default_rng(seed)
    return reachable(ROBOT, box(count, seed), margin=0.05), rng.normal(size=(4,)), rng.normal(size=(4,))


def energy(robot, poses, velocities, payload):
    """Kinetic and potential energy by hand, each (k,)."""
    i, hand = robot.inertia, ByHand(robot.geometry)
    rods = np.array([1, 1, 2, 2, 1, 1]) * i.rod_mass / 2
    rates = np.einsum("kij,kj->ki", hand.inverse_jacobian(poses), velocities)
    levers = hand.levers(poses)
    of_b = velocities[:, None, :3] + np.cross(velocities[:, None, 3:] * np.array([0.0, 0, 1]), levers)
    mass = i.platform_mass + payload
    kinetic = ((i.slide_mass + rods) * rates**2).sum(axis=1) + (rods * (of_b**2).sum(axis=2)).sum(axis=1)
    kinetic += mass * (velocities[:, :3] ** 2).sum(axis=1) + i.platform_inertia * velocities[:, 3] ** 2
    potential = GRAVITY * (mass * poses[:, 2] + (rods * hand.platform(poses)[..., 2]).sum(axis=1))
    return kinetic / 2, potential, rates


def test_power_of_the_drives_is_the_change_of_energy():
    poses, velocity, acceleration = motion(200, seed=9)
    payload, step = 2.5, 1e-5

    def along(time):
        p = poses + velocity * time + acceleration * time**2 / 2
        return energy(ROBOT, p, np.broadcast_to(velocity + acceleration * time, p.shape), payload)

    before, after = along(-step), along(step)
    power = sum(after[k] - before[k] for k in (0, 1)) / (2 * step)
    torque = inverse_dynamics(ROBOT, payload, poses, velocity, acceleration)
    assert np.abs((torque * along(0.0)[2]).sum(axis=1) / power - 1).max() < 1e-5


def test_what_the_platform_needs_is_shared_with_the_least_norm():
    """At rest nothing but weight: tau = (J_m^T)^+ Q_x, and any other share that holds it has a larger norm."""
    poses = reachable(ROBOT, box(2_000, seed=10), margin=0.01)
    i, payload = ROBOT.inertia, 1.5
    weight = np.array([0, 0, GRAVITY * (i.platform_mass + payload + 4 * i.rod_mass), 0])
    j_m = ByHand().inverse_jacobian(poses)
    torque = inverse_dynamics(ROBOT, payload, poses, np.zeros(4), np.zeros(4))
    expected = np.einsum("kij,j->ki", np.linalg.pinv(np.swapaxes(j_m, 1, 2)), weight)
    assert np.abs(torque - expected).max() < 1e-9 * np.abs(expected).max()
    internal = np.linalg.svd(j_m)[0][:, :, 4:]
    assert np.abs(np.einsum("ki,kij->kj", torque, internal)).max() < 1e-9 * np.abs(expected).max()


def test_dynamics_out_of_reach_is_nan_and_payload_counts():
    assert np.isnan(inverse_dynamics(ROBOT, 1.0, np.array([0.0, 0, 3, 0]), np.zeros(4), np.zeros(4))).all()
    light = Redundant3T1R(inertia=replace(REDUNDANT, platform_mass=1.0))
    pose, still = np.array([0.0, 0.1, 0.2, 0.3]), np.zeros(4)
    assert np.allclose(
        inverse_dynamics(light, 2.0, pose, still, still), inverse_dynamics(ROBOT, 0.0, pose, still, still)
    )
