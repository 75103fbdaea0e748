"""A sweep says of poses that pass by what numpy says of the whole list, in memory that does not grow with them."""

from __future__ import annotations

import math
import tracemalloc

import numpy as np
import pytest

from design import Box, Cylinder, Region, sweep
from kinematics import Heli4, Redundant3T1R

CYLINDER = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-math.pi, math.pi))
BOX = Box(x=0.0, y=(-0.3, 0.3), z=(-0.3, 0.3), theta=(-math.pi / 2, math.pi / 2))
NAMES = Heli4.pose_names


@pytest.mark.parametrize("chunk", [1, 7, 105, 1000])
@pytest.mark.parametrize(
    "region", [CYLINDER, BOX, Box(x=0.1, y=0.0, z=-0.7, theta=0.0)], ids=lambda r: type(r).__name__
)
def test_a_walk_is_the_grid_in_its_order(region: Region, chunk: int) -> None:
    counts = (3, 5, 1, 7)[: region.dimension]
    chunks = list(region.walk(NAMES, counts, chunk))
    assert max(map(len, chunks)) <= chunk
    axes = [np.linspace(0, 1, c) if c > 1 else np.array([0.5]) for c in counts]
    unit = np.array(np.meshgrid(*axes, indexing="ij")).reshape(len(counts), math.prod(counts)).T
    np.testing.assert_array_equal(np.concatenate(chunks), region.from_unit(unit, NAMES))
    np.testing.assert_array_equal(region.grid(NAMES, counts), np.concatenate(chunks))


@pytest.mark.parametrize("chunk", [1, 10, 999, 10_000])
def test_a_sweep_is_what_numpy_says_of_all_poses_at_once(chunk: int) -> None:
    """A cylinder that is partly out of reach, so some values are NaN."""
    robot, region = Heli4(), Cylinder(radius=1.0, z=(-0.8, -0.6), theta=(-math.pi, math.pi))
    counts, levels = (5, 9, 5, 11), (0.9, 1.1, -math.inf)
    poses = region.grid(NAMES, counts)
    values = robot.fvi(poses)
    good = ~np.isnan(values)
    assert 0 < good.sum() < len(poses)
    found = sweep(robot.fvi, region.walk(NAMES, counts, chunk), keep=20, levels=levels)
    order = np.argsort(values, kind="stable")[:20]
    assert (found.poses, found.lost) == (len(poses), (~good).sum())
    np.testing.assert_array_equal(found.values, values[order])
    np.testing.assert_array_equal(found.at, poses[order])
    np.testing.assert_array_equal(found.below, [(values[good] < level).sum() for level in levels])
    assert found.mean == pytest.approx(values[good].mean(), rel=1e-13)
    assert found.deviation == pytest.approx(values[good].std(), rel=1e-12)


def test_a_mean_far_from_zero_keeps_the_digits_of_its_deviation() -> None:
    values = 1e9 + np.random.default_rng(1).normal(size=(100, 1000))
    found = sweep(lambda chunk: chunk[:, 0], (v[:, None] for v in values))
    assert found.deviation == pytest.approx(values.std(), rel=1e-7)


def test_where_nothing_has_a_value_there_is_no_mean() -> None:
    found = sweep(Heli4().fvi, [np.full((5, 4), 9.0), np.empty((0, 4))], levels=(1.0,))
    assert (found.poses, found.lost, len(found.values), found.below.tolist()) == (5, 5, 0, [0])
    assert math.isnan(found.mean)
    assert math.isnan(found.deviation)


def test_memory_does_not_grow_with_the_poses() -> None:
    """A million poses take 32 MB and their values 8 MB; the sweep, chunks and all, stays below a fraction of that."""
    robot = Redundant3T1R()
    robot.fvi(np.array(robot.home))
    peaks: list[int] = []
    for counts in ((50, 50, 40), (100, 100, 100)):
        tracemalloc.start()
        found = sweep(robot.fvi, BOX.walk(robot.pose_names, counts, 10_000), levels=(1.1,))
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert found.poses == math.prod(counts)
    assert peaks[1] < 1.1 * peaks[0] < 4e6


@pytest.mark.parametrize("method", ["fvi", "inverse", "condition_number"])
def test_a_large_array_takes_no_more_than_its_result_and_a_little(method: str) -> None:
    robot = Heli4()
    call = getattr(robot, method)
    poses = CYLINDER.random(NAMES, 200_000, np.random.default_rng(2))
    call(poses[:10])
    tracemalloc.start()
    found = call(poses)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < found.nbytes + 5e6
