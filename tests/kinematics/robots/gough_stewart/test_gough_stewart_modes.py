"""Gough-Stewart: every assembly mode, and the continuation that finds them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinematics import Array, GoughStewart, LostPaths, SelfMotion
from kinematics.mathematics.rigid_displacements import displacement, leg_quadrics, point, study_quadric
from kinematics.robots.gough_stewart import assembly_modes as modes
from kinematics.robots.gough_stewart import forward
from tests.kinematics.robots.gough_stewart.gough_stewart_by_hand import (
    anywhere,
    matrix_of,
    pose_errors,
    pose_of,
    random_frame,
    random_points,
    random_poses,
    random_robot,
    transform_of,
)
from tests.sizes import few_or_many

Geometry = GoughStewart.Geometry

# Dietmaier 1998, the geometry of the chapter's reference with forty real poses.
DIETMAIER_BASE = [
    (0.0, 0.0, 0.0), (1.107915, 0.0, 0.0), (0.549094, 0.756063, 0.0),
    (0.735077, -0.223935, 0.525991), (0.514188, -0.526063, -0.368418), (0.590473, 0.094733, -0.205018),
]  # fmt: skip
DIETMAIER_PLATFORM = [
    (0.0, 0.0, 0.0), (0.542805, 0.0, 0.0), (0.956919, -0.528915, 0.0),
    (0.665885, -0.353482, 1.402538), (0.478359, 1.158742, 0.107672), (-0.137087, -0.235121, 0.353913),
]  # fmt: skip
DIETMAIER_LEGS = np.array([1.0, 0.645275, 1.086284, 1.503439, 1.281933, 0.771071])


def nearest(found: Array, pose: Array) -> float:
    """Distance of the nearest pose found; infinite where none was."""
    return float(pose_errors(found, pose).min(initial=np.inf))


# The continuation's start.


def test_study_coordinates_turn_the_legs_into_quadrics_and_come_back() -> None:
    rng = np.random.default_rng(1)
    poses, base, platform = anywhere(rng, 200), random_points(rng), random_points(rng)
    rotations = matrix_of(poses)
    squares = np.sum((poses[:, None, :3] + platform @ np.swapaxes(rotations, 1, 2) - base) ** 2, axis=2)
    x = point(rotations, poses[:, :3])
    system = leg_quadrics(base[None], platform[None], squares)
    np.testing.assert_allclose(np.einsum("ki,klij,kj->kl", x, system, x) / np.abs(system).max(), 0, atol=1e-15)
    np.testing.assert_allclose(np.einsum("ki,ij,kj->k", x, study_quadric()[0], x), 0, atol=1e-15)
    turned, place = displacement((0.3 - 2.0j) * x)
    np.testing.assert_allclose(turned, rotations, atol=1e-14)
    np.testing.assert_allclose(place, poses[:, :3], atol=1e-14)


def test_a_generic_complex_platform_has_forty_poses_certified_by_smales_alpha() -> None:
    """alpha = beta gamma below 0.15767 proves a true solution within 2 beta of each point; none overlap."""
    platform, known = modes.generic()
    assert known.shape == (40, 8)
    system = platform.system()
    radii = []
    for x in known:
        jacobian = np.vstack([2 * system @ x, x.conj()])
        inverse = np.linalg.inv(jacobian)
        beta = np.linalg.norm(inverse @ np.append(np.einsum("kij,i,j->k", system, x, x), 0.0))
        gamma = np.linalg.norm(inverse, 2) * np.sqrt(sum(np.linalg.norm(m, 2) ** 2 for m in system))
        assert beta * gamma < 0.15767
        radii.append(2 * beta)
    inner = np.abs(known.conj() @ known.T)
    apart = np.sqrt(np.maximum(0.0, 2.0 - 2.0 * inner)) + np.eye(40)
    assert apart.min() > 1e-3 > 100 * max(radii)


# The real poses.


def test_dietmaiers_platform_has_forty_real_poses() -> None:
    robot = GoughStewart(Geometry(base_points=DIETMAIER_BASE, platform_points=DIETMAIER_PLATFORM))
    found = robot.assembly_modes(DIETMAIER_LEGS)
    assert found.shape == (40, 6)
    assert np.abs(robot.inverse(found) - DIETMAIER_LEGS).max() < 1e-12
    apart = np.array([pose_errors(found, pose) for pose in found]) + np.eye(40)
    assert apart.min() > 1e-3


@few_or_many(2, 12)
def test_a_known_pose_is_always_among_the_modes(count: int) -> None:
    """So many random poses of each: the default robot, the octahedron, planar and spatial random ones, any frames."""
    rng = np.random.default_rng(5)
    robots = [GoughStewart(), GoughStewart(Geometry.mssm()), GoughStewart(Geometry.tssm())]
    robots += [random_robot(rng, planar=k % 2 == 0) for k in range(5)]
    for robot in robots:
        poses = anywhere(rng, count)
        for pose, joints in zip(poses, robot.inverse(poses), strict=True):
            found = robot.assembly_modes(joints)
            assert nearest(found, pose) < 1e-8
            assert np.abs(robot.inverse(found) - joints).max() < 1e-12
            assert len(found) % 2 == 0


@few_or_many(1, 3)
def test_newtons_method_from_thousands_of_starts_finds_no_pose_that_is_missing(count: int) -> None:
    """And it finds nearly all of them, so that the check has teeth."""
    rng = np.random.default_rng(6)
    reached = total = 0
    for robot in (GoughStewart(), GoughStewart(Geometry.mssm()), random_robot(rng), random_robot(rng, planar=True)):
        place = robot.geometry.in_reference_frame().mean(axis=0)
        for pose in anywhere(rng, count) + np.append(place, np.zeros(3)):
            joints = robot.inverse(pose)
            modes_found = robot.assembly_modes(joints)
            starts = anywhere(rng, 2000) * [2.0, 2.0, 2.0, 1.0, 1.0, 1.0] + np.append(place, np.zeros(3))
            tried = robot.newton(joints, starts, iterations=100)
            hits = tried.pose[tried.converged]
            errors = np.stack([pose_errors(hits, mode) for mode in modes_found])
            assert errors.min(axis=0).max() < 1e-6
            reached += int((errors.min(axis=1) < 1e-6).sum())
            total += len(modes_found)
    assert reached > 0.95 * total


def test_dietmaiers_forty_are_all_that_newtons_method_finds() -> None:
    robot = GoughStewart(Geometry(base_points=DIETMAIER_BASE, platform_points=DIETMAIER_PLATFORM))
    known = robot.assembly_modes(DIETMAIER_LEGS)
    tried = robot.newton(DIETMAIER_LEGS, anywhere(np.random.default_rng(7), 10_000), iterations=100)
    hits = tried.pose[tried.converged]
    errors = np.stack([pose_errors(hits, mode) for mode in known])
    assert errors.min(axis=0).max() < 1e-6
    assert (errors.min(axis=1) < 1e-6).sum() >= 38


def test_forward_returns_one_of_the_modes_and_home_comes_first() -> None:
    robot = GoughStewart()
    for pose in random_poses(np.random.default_rng(8), 20):
        joints = robot.inverse(pose)
        found = robot.assembly_modes(joints)
        assert nearest(found, robot.forward(joints)) < 1e-9
        np.testing.assert_allclose(found[0], pose, atol=1e-9)


def test_flat_base_and_platform_mirror_every_mode_in_the_base() -> None:
    """Reflect the platform's pose in the base's plane, then the flat platform in its own: R -> S R S, z -> -z."""
    robot, s = GoughStewart(), np.diag([1.0, 1.0, -1.0])
    found = robot.assembly_modes(robot.inverse(np.array([0.05, 0.02, 0.55, 0.1, 0.2, 0.3])))
    for pose in found:
        mirrored = np.eye(4)
        mirrored[:3, :3], mirrored[:3, 3] = s @ matrix_of(pose) @ s, s @ pose[:3]
        assert nearest(found, pose_of(mirrored)) < 1e-9


def test_a_pose_on_a_singularity_is_found_though_two_modes_meet_there() -> None:
    """Exactly singular (octahedron at a quarter turn), and 10 poses brought there by bisection of the determinant."""
    octahedron = GoughStewart(Geometry.mssm())
    cases = [(octahedron, np.array([0.0, 0.0, 0.6, 0.0, 0.0, np.pi / 2]))]
    rng = np.random.default_rng(9)
    robot = GoughStewart()

    def det(pose: Array) -> float:
        return float(np.linalg.det(robot.inverse_jacobian(pose)))

    while len(cases) < 11:
        a, b = anywhere(rng, 2)
        if det(a) * det(b) > 0:
            continue
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if det(a) * det(a + middle * (b - a)) > 0 else (low, middle)
        cases.append((robot, a + low * (b - a)))
    for which, pose in cases:
        joints = which.inverse(pose)
        found = which.assembly_modes(joints)
        assert nearest(found, pose) < 1e-5  # a double root is known to half the digits
        assert np.abs(which.inverse(found) - joints).max() < 1e-12


_SPATIAL = random_points(np.random.default_rng(13))


@pytest.mark.parametrize(
    ("geometry", "pose", "dimension"),
    [
        (Geometry(_SPATIAL, _SPATIAL), [0.5, 0.3, 1.5, 0.0, 0.0, 0.0], 2),  # a sphere of pure translations
        (Geometry(_SPATIAL * [1, 1, 0], _SPATIAL * [1, 1, 0]), [0.5, 0.3, 1.5, 0.0, 0.0, 0.0], 2),
        (Geometry.mssm(0.4, 0.4), [0.0, 0.0, 0.6, 0.0, 0.0, 0.0], 1),
        (Geometry.ssm(0.4, 0.4), [0.0, 0.0, 0.6, 0.0, 0.0, 0.0], 1),
    ],
    ids=["congruent", "congruent and flat", "equal triangles", "equal hexagons"],
)
def test_a_self_motion_is_refused_by_name(geometry: Geometry, pose: list[float], dimension: int) -> None:
    """And its pose has these legs; a step along the Jacobian's null space, polished, is another pose that has them."""
    robot = GoughStewart(geometry)
    joints = robot.inverse(np.array(pose))
    with pytest.raises(SelfMotion, match="joints locked") as caught:
        robot.assembly_modes(joints)
    assert caught.value.dimension == dimension
    here = np.array(caught.value.pose)
    assert np.abs(robot.inverse(here) - joints).max() < 1e-11
    _, values, vectors = np.linalg.svd(robot.inverse_jacobian(here))
    steps = 0.05 * vectors[values < 1e-5]
    others = np.array([polished(robot, moved(here, step), joints) for step in steps])
    closed = np.abs(robot.inverse(others) - joints).max(axis=1) < 1e-11
    assert (closed & (pose_errors(others, here) > 0.01)).sum() >= dimension


def moved(pose: Array, twist: Array) -> Array:
    transform = transform_of(pose)
    transform[:3, :3] = Rotation.from_rotvec(twist[3:]).as_matrix() @ transform[:3, :3]
    transform[:3, 3] += twist[:3]
    return pose_of(transform)


def polished(robot: GoughStewart, pose: Array, joints: Array) -> Array:
    for _ in range(40):
        pose = moved(pose, np.linalg.pinv(robot.inverse_jacobian(pose), rcond=1e-6) @ (joints - robot.inverse(pose)))
    return pose


def test_a_continuum_of_complex_poses_is_never_passed_over(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where no real pose on it is known, the modes are not certain either."""
    monkeypatch.setattr(forward, "real_point", lambda *_: None)
    robot = GoughStewart(Geometry.mssm(0.4, 0.4))
    with pytest.raises(LostPaths, match="continuum"):
        robot.assembly_modes(robot.inverse(np.array([0.0, 0.0, 0.6, 0.0, 0.0, 0.0])))


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_modes_do_not_depend_on_the_unit_of_length(scale: float) -> None:
    rng = np.random.default_rng(10)
    robot = random_robot(rng, frames=False)
    pose = anywhere(rng, 1)[0]
    units = np.array([scale] * 3 + [1.0] * 3)
    g = robot.geometry
    other = GoughStewart(
        g.with_values(base_points=scale * np.array(g.base_points), platform_points=scale * np.array(g.platform_points))
    )
    joints = robot.inverse(pose)
    first, second = robot.assembly_modes(joints), other.assembly_modes(scale * joints)
    assert len(first) == len(second)
    for mode in second / units:
        assert nearest(first, mode) < 1e-7


@few_or_many(3, 20)
def test_modes_move_with_the_frames(count: int) -> None:
    for seed in range(count):
        assert_modes_move_with_the_frames(seed)


def assert_modes_move_with_the_frames(seed: int) -> None:
    rng = np.random.default_rng(seed)
    robot, w, t = random_robot(rng), random_frame(rng), random_frame(rng)
    g = robot.geometry
    other = GoughStewart(g.with_values(Z=w @ np.array(g.Z), E=np.array(g.E) @ t))
    joints = robot.inverse(anywhere(rng, 1)[0])
    first, second = robot.assembly_modes(joints), other.assembly_modes(joints)
    assert len(first) == len(second)
    for mode in first:
        assert nearest(second, pose_of(w @ transform_of(mode) @ t)) < 1e-6


def test_legs_that_cannot_close_have_no_mode() -> None:
    assert GoughStewart().assembly_modes([5.0, 0.1, 5.0, 0.1, 5.0, 0.1]).shape == (0, 6)


def test_a_geometry_is_solved_once_and_kept() -> None:
    robot = random_robot(np.random.default_rng(11))
    joints = robot.inverse(anywhere(np.random.default_rng(12), 1)[0])
    before = modes.solver.cache_info()
    first = robot.assembly_modes(joints)
    again = GoughStewart(robot.geometry).assembly_modes(joints)
    after = modes.solver.cache_info()
    assert (after.misses - before.misses, after.hits - before.hits) == (1, 1)
    np.testing.assert_array_equal(first, again)


def test_ends_that_cannot_be_certified_raise_instead_of_returning(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = GoughStewart()
    joints = robot.inverse(np.array(robot.home) + 0.01)
    monkeypatch.setattr(modes, "_certified", lambda *_: False)
    with pytest.raises(LostPaths, match="ways with a lost path") as caught:
        robot.assembly_modes(joints)
    assert caught.value.stage == "these leg lengths"
