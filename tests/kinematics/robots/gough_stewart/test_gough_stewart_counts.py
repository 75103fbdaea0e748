"""Gough-Stewart: how many complex poses a geometry has; 8.6.4.1, each count tried on its own."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics import Array, GoughStewart, LostPaths
from kinematics.robots.gough_stewart import assembly_modes as modes
from tests.kinematics.robots.gough_stewart.gough_stewart_by_hand import anywhere, matrix_of, random_points
from tests.sizes import later

Geometry = GoughStewart.Geometry


def count(base: Array, platform: Array) -> int:
    """Complex poses of a geometry for generic leg lengths."""
    base, platform = (np.asarray(p) - np.mean(p, axis=0) for p in (base, platform))
    unit = np.sqrt(np.mean(np.sum(base**2 + platform**2, axis=1)))
    return modes.solver((base / unit).tobytes(), (platform / unit).tobytes()).count


@pytest.mark.long
@pytest.mark.parametrize("seed", [0, *(later(seed) for seed in range(1, 5)), 5])
def test_a_generic_real_platform_has_forty_complex_poses(seed: int) -> None:
    rng = np.random.default_rng(seed)
    assert count(random_points(rng, planar=seed > 3), random_points(rng, planar=seed > 3)) == 40


# Special geometries: 8.6.4.1, each count tried on its own.


def merged(points: Array, *groups: tuple[int, ...]) -> Array:
    """Joint centres of each group (legs counted from 1) made to coincide."""
    points = points.copy()
    for group in groups:
        points[[leg - 1 for leg in group]] = points[group[0] - 1]
    return points


@pytest.mark.parametrize("planar", [True, later(False)])
@pytest.mark.parametrize(
    ("on_base", "on_platform", "expected"),
    [
        ((), ((1, 2), (3, 4), (5, 6)), 16),  # TSSM: the chapter's 16
        (((2, 3), (4, 5), (6, 1)), ((1, 2), (3, 4), (5, 6)), 16),  # MSSM
        (((1, 2), (3, 4)), ((2, 3), (4, 5)), 24),  # 4-4: twice its degree 12, above and below
        (((1, 2), (4, 5)), ((2, 3), (5, 6)), 16),  # 4-4 too, but fewer
        (((1, 2),), ((2, 3), (4, 5)), 24),  # 5-4: the chapter's 24
        (((1, 2),), ((3, 4), (5, 6)), 16),  # 5-4 too
        (((1, 2),), ((2, 3), (6, 1)), 32),  # 5-4 too
        (((1, 2),), ((3, 4),), 24),  # 5-5: the chapter's "similar result"
        (((1, 2),), ((2, 3),), 40),  # 5-5 too
        (((1, 2, 3),), ((3, 4, 5),), 8),  # (3-1-1-1)^2: the chapter's 8
    ],
)
def test_number_of_poses_depends_on_which_joint_centres_coincide(
    on_base: tuple[tuple[int, ...], ...], on_platform: tuple[tuple[int, ...], ...], expected: int, planar: bool
) -> None:
    rng = np.random.default_rng(2)
    base, platform = merged(random_points(rng, planar), *on_base), merged(random_points(rng, planar), *on_platform)
    assert count(base, platform) == expected


@pytest.mark.parametrize(
    "half_angles",
    [(0.1, 0.2), (0.2, 0.2), later((0.3, 0.05)), later((0.4, 0.5))],
)
def test_layouts_of_the_builders_have_28_16_and_16_poses(half_angles: tuple[float, float]) -> None:
    base, platform = half_angles
    assert count(*points_of(Geometry.ssm(0.7, 0.3, base, platform))) == 28
    assert count(*points_of(Geometry.tssm(0.7, 0.3, base))) == 16
    assert count(*points_of(Geometry.mssm(0.7, 0.3 + base))) == 16


@pytest.mark.parametrize("apart", [1e-1, 1e-2, 1e-3])
def test_near_a_singular_architecture_no_pose_is_lost(apart: float) -> None:
    assert count(*points_of(Geometry.ssm(base_half_angle=0.4, platform_half_angle=np.pi / 3 - 0.4 - apart))) == 28


def test_so_near_a_singular_architecture_that_poses_may_be_lost_it_says_so() -> None:
    robot = GoughStewart(Geometry.ssm(base_half_angle=0.4, platform_half_angle=np.pi / 3 - 0.4 - 1e-4))
    with pytest.raises(LostPaths, match="independent by"):
        robot.assembly_modes(robot.inverse(np.array(robot.home)))


def points_of(geometry: Geometry) -> tuple[Array, Array]:  # type: ignore[valid-type]
    return np.array(geometry.base_points), np.array(geometry.platform_points)  # type: ignore[attr-defined]


def test_similar_planar_base_and_platform_have_sixteen_poses() -> None:
    base = random_points(np.random.default_rng(3), planar=True)
    assert count(base, 0.6 * base) == 16


def test_five_points_on_a_line_leave_eight_places_of_the_line_and_two_spins_of_each() -> None:
    """The chapter's 8 counts the line; the sixth leg then turns the platform about it to two places."""
    rng = np.random.default_rng(4)
    platform = random_points(rng)
    platform[:5] = np.outer(rng.normal(size=5), rng.normal(size=3)) + rng.normal(size=3)
    base = random_points(rng, planar=True)
    assert count(base, platform) == 16
    robot = GoughStewart(Geometry(base_points=base, platform_points=platform))
    for pose in anywhere(rng, 10):
        found = robot.assembly_modes(robot.inverse(pose))
        ends = found[:, None, :3] + platform[:2] @ np.swapaxes(matrix_of(found), 1, 2)
        lines = np.unique(np.round(ends, 6).reshape(len(found), -1), axis=0)
        assert len(found) == 2 * len(lines) <= 16
