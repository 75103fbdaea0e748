"""Architectures that are singular at every pose, and their neighbours that are not."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics import Array, GoughStewart, InvalidGeometry, SingularArchitecture
from kinematics.robots.gough_stewart.architecture_singularity import DEPENDENT, dependence
from tests.kinematics.robots.gough_stewart.gough_stewart_by_hand import (
    anywhere,
    printed_inverse_jacobian,
    random_frame,
    random_points,
)

Geometry = GoughStewart.Geometry


def on_conic(rng: np.random.Generator) -> Array:
    """(6, 3) points of a random ellipse in the xy plane."""
    t = np.sort(rng.uniform(0, 2 * np.pi, 6))
    return np.column_stack([np.column_stack([np.cos(t), np.sin(t)]) @ rng.normal(size=(2, 2)), np.zeros(6)])


def affine(points: Array, rng: np.random.Generator) -> Array:
    return np.column_stack([points[:, :2] @ rng.normal(size=(2, 2)) + rng.normal(size=2), np.zeros(6)])


def projective(points: Array, rng: np.random.Generator) -> Array:
    weights = 1 + 0.2 * points[:, :2] @ rng.normal(size=2) / np.abs(points).max()
    return affine(points / weights[:, None], rng)


def placed(points: Array, rng: np.random.Generator) -> Array:
    """The points anywhere in space."""
    frame = random_frame(rng)
    return points @ frame[:3, :3].T + frame[:3, 3]


def smallest_singular_value(base: Array, platform: Array, seed: int) -> float:
    """The largest of the smallest singular values over poses, from the printed [8.20]."""

    class Robot:
        class geometry:  # noqa: N801
            Z = E = np.eye(4)
            base_points, platform_points = base, platform

    jacobians = [printed_inverse_jacobian(Robot, pose) for pose in anywhere(np.random.default_rng(seed), 50)]  # type: ignore[arg-type]
    return max(float(np.linalg.svd(j, compute_uv=False)[-1]) for j in jacobians)


CASES = {
    "similar to": lambda u, rng: u * rng.uniform(0.2, 2.0),
    "an affine image of": affine,
    "a projective image of": projective,
}


@pytest.mark.parametrize("word", CASES)
@pytest.mark.parametrize("seed", range(5))
def test_images_of_six_points_on_a_conic_are_singular_at_every_pose_and_refused(word: str, seed: int) -> None:
    """The chapter names similar regular hexagons only, the best-known case."""
    rng = np.random.default_rng(seed)
    u = on_conic(rng)
    base, platform = placed(u, rng), placed(CASES[word](u, rng), rng)
    assert smallest_singular_value(base, platform, seed) < 1e-13
    with pytest.raises(SingularArchitecture, match=f"{word} the base, whose six points lie on one conic") as caught:
        Geometry(base_points=base, platform_points=platform)
    assert isinstance(caught.value, InvalidGeometry)
    assert caught.value.reason in str(caught.value)


def test_the_chapters_similar_regular_hexagons_are_refused_by_the_builder() -> None:
    with pytest.raises(SingularArchitecture, match="similar to the base"):
        Geometry.ssm(base_half_angle=np.pi / 6, platform_half_angle=np.pi / 6)
    for half in (0.1, 0.4):  # semi-regular ones are similar where the half angles add up to 60 degrees
        with pytest.raises(SingularArchitecture, match="similar to the base"):
            Geometry.ssm(base_half_angle=half, platform_half_angle=np.pi / 3 - half)


@pytest.mark.parametrize("seed", range(5))
def test_the_same_images_of_points_off_a_conic_are_accepted(seed: int) -> None:
    rng = np.random.default_rng(100 + seed)
    u = random_points(rng, planar=True)
    for image in CASES.values():
        platform = placed(image(u, rng), rng)
        Geometry(base_points=placed(u, rng), platform_points=platform)
        assert smallest_singular_value(u, platform, seed) > 1e-6


def test_collineations_that_pair_the_points_of_one_conic_in_another_order_are_accepted() -> None:
    rng = np.random.default_rng(1)
    u = on_conic(rng)
    Geometry(base_points=u, platform_points=0.5 * u[[1, 3, 5, 0, 2, 4]])


def test_recognition_needs_no_more_digits_than_a_drawing_gives_and_no_less() -> None:
    t = np.arange(6) * np.pi / 3
    hexagon = np.column_stack([np.cos(t), np.sin(t), 0 * t])
    moved = 0.6 * hexagon
    moved[2, 0] += 1e-7
    assert dependence(hexagon, moved) < DEPENDENT
    moved[2, 0] += 1e-3
    Geometry(base_points=hexagon, platform_points=moved)


def test_degenerate_joint_centres_are_refused_by_their_own_reasons() -> None:
    rng = np.random.default_rng(2)
    base, platform = random_points(rng), random_points(rng)
    twin = [p.copy() for p in (base, platform)]
    for points in twin:
        points[4] = points[1]
    line = np.outer(rng.normal(size=6), rng.normal(size=3)) + 1.0
    shared = base.copy()
    shared[[0, 2, 3, 5]] = shared[0]
    hubs = [p.copy() for p in (base, platform)]
    hubs[0][:3], hubs[1][3:] = hubs[0][0], hubs[1][3]
    for case, words in (
        (twin, "legs 2 and 5 are one leg"),
        ((line, platform), "base points lie on one line"),
        ((base, line), "platform points lie on one line"),
        ((base, np.ones((6, 3))), "platform points lie on one line"),
        ((shared, platform), "legs 1, 3, 4, 6 meet in one base point"),
        ((base, shared), "legs 1, 3, 4, 6 meet in one platform point"),
        (hubs, "linearly dependent at every pose"),  # all legs meet the line from one hub to the other
    ):
        with pytest.raises(SingularArchitecture, match=words):
            Geometry(base_points=case[0], platform_points=case[1])


def test_a_planar_pair_of_hubs_is_not_called_a_projective_image() -> None:
    rng = np.random.default_rng(3)
    base, platform = random_points(rng, planar=True), random_points(rng, planar=True)
    base[:3], platform[3:] = base[0], platform[3]
    with pytest.raises(SingularArchitecture, match="linearly dependent at every pose"):
        Geometry(base_points=base, platform_points=platform)


def test_random_and_symmetric_architectures_are_accepted() -> None:
    rng = np.random.default_rng(4)
    for _ in range(200):
        Geometry(base_points=random_points(rng), platform_points=random_points(rng))
        Geometry.ssm(*rng.uniform(0.1, 2.0, 2), *rng.uniform(0.0, 0.5, 2))
