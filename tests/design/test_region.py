"""Regions: what is inside, what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from design import Box, Cylinder, InvalidRegion

NAMES = ("x", "y", "z", "theta")
CYLINDER = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-math.pi, math.pi))
BOX = Box(x=0.0, y=(-0.25, 0.25), z=(-0.2, 0.2), theta=(-1.0, 1.0))
unit = st.floats(0.0, 1.0)


@given(st.lists(unit, min_size=4, max_size=4))
def test_every_point_of_the_unit_cube_lands_inside_the_cylinder(u: list[float]) -> None:
    pose = CYLINDER.from_unit(np.array(u), NAMES)
    assert CYLINDER.contains(pose, NAMES)


@given(st.lists(unit, min_size=3, max_size=3))
def test_every_point_of_the_unit_cube_lands_inside_the_box_and_keeps_its_fixed_coordinate(u: list[float]) -> None:
    pose = BOX.from_unit(np.array(u), NAMES)
    assert BOX.contains(pose, NAMES)
    assert pose[0] == 0.0


def test_a_grid_holds_the_boundary_in_every_coordinate() -> None:
    grid = CYLINDER.grid(NAMES, (3, 5, 3, 3))
    assert np.hypot(grid[:, 0], grid[:, 1]).max() == pytest.approx(0.5)
    assert (grid[:, 2].min(), grid[:, 2].max()) == (-0.8, -0.6)
    assert (grid[:, 3].min(), grid[:, 3].max()) == (-math.pi, math.pi)


def test_random_poses_of_the_cylinder_are_uniform_over_its_area() -> None:
    rng = np.random.default_rng(7)
    poses = CYLINDER.random(NAMES, 200_000, rng)
    inner = np.hypot(poses[:, 0], poses[:, 1]) <= 0.25
    assert inner.mean() == pytest.approx(0.25, abs=0.005), "seed 7"


def test_the_coordinates_may_come_in_any_order() -> None:
    u = np.random.default_rng(0).random((10, 4))
    swapped = ("theta", "z", "y", "x")
    poses = CYLINDER.from_unit(u, swapped)
    assert CYLINDER.contains(poses, swapped).all()
    assert CYLINDER.contains(poses[:, ::-1], NAMES).all()


@pytest.mark.parametrize(
    ("build", "key"),
    [
        (lambda: Cylinder(radius=0.0, z=(0, 1), theta=0.0), "radius"),
        (lambda: Cylinder(radius=math.nan, z=(0, 1), theta=0.0), "radius"),
        (lambda: Cylinder(radius=1.0, x=(0, 1)), "x"),
        (lambda: Box(z=(1.0, 0.0)), "z"),
        (lambda: Box(z=(0.0, math.inf)), "z"),
        (lambda: Box(z=(0.0, 1.0, 2.0)), "z"),
        (lambda: Box(z="a"), "z"),
        (lambda: Box(z=True), "z"),
        (lambda: Box(z=1e300), "z"),
        (lambda: Cylinder(radius=1e300), "radius"),
        (lambda: Cylinder(radius=True), "radius"),
        (lambda: Cylinder(radius=math.nan), "radius"),
        (lambda: Cylinder(radius="a"), "radius"),
    ],
)
def test_an_impossible_region_is_refused_by_its_key(build: object, key: str) -> None:
    with pytest.raises(InvalidRegion) as error:
        build()  # type: ignore[operator]
    assert error.value.key == key


def test_a_region_that_misses_or_invents_a_coordinate_is_refused() -> None:
    with pytest.raises(InvalidRegion, match="theta"):
        Box(x=0.0, y=0.0, z=(0, 1)).check(NAMES)
    with pytest.raises(InvalidRegion, match="roll"):
        Box(x=0.0, y=0.0, z=(0, 1), theta=0.0, roll=0.0).check(NAMES)


def test_the_outline_of_a_cylinder_lies_on_its_wall() -> None:
    for ring in CYLINDER.outline():
        np.testing.assert_allclose(np.hypot(ring[:, 0], ring[:, 1]), 0.5)
    assert len(BOX.outline()) == 12


def test_a_pose_beyond_a_bound_by_rounding_is_inside_in_every_size() -> None:
    for size in (1e-6, 1.0, 1e6):
        box = Box(x=(0.0, size), y=0.0, z=0.0, theta=0.0)
        disc = Cylinder(radius=size, z=0.0, theta=0.0)
        for region in (box, disc):
            for beyond, inside in ((1e-13, True), (1e-11, False)):
                pose = np.array([size * (1.0 + beyond), 0.0, 0.0, 0.0])
                assert region.contains(pose, NAMES) == inside


def test_six_coordinates_are_spread_over_corners_and_middles() -> None:
    names = ("x", "y", "z", "roll", "pitch", "yaw")
    spread = Box(**dict.fromkeys(names, (-1.0, 1.0))).spread(names)
    assert len(spread) == 2**6 + 2 * 6 + 1
    assert (np.abs(spread).min(axis=0) == 0.0).all()
    assert set(np.unique(spread)) == {-1.0, 0.0, 1.0}


def test_numpy_numbers_are_numbers() -> None:
    assert Box(z=np.float32(0.5), theta=np.int64(0)).intervals == {"z": (0.5, 0.5), "theta": (0.0, 0.0)}


def test_the_spread_of_a_cylinder_reaches_all_sides_without_repeating_itself() -> None:
    spread = CYLINDER.spread(NAMES)
    for column, (low, high) in enumerate(CYLINDER.intervals.values()):
        assert spread[:, column].min() == pytest.approx(low)
        assert spread[:, column].max() == pytest.approx(high)
    assert len(np.unique(np.round(spread, 9), axis=0)) == len(spread)
