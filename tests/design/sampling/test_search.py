"""The dense search finds what an independent global optimiser finds."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import differential_evolution

from design import Box, Cylinder, worst_poses
from kinematics import Heli4

REGION = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-math.pi, math.pi))
ROBOT = Heli4()


@pytest.mark.parametrize("margin", ["reach", "fvi", "J_q", "det_J_x", "internal_determinant"])
def test_no_independent_search_finds_a_lower_margin(margin: str) -> None:
    found = worst_poses(ROBOT, REGION, margin, about=200_000)

    def value(u: np.ndarray) -> np.ndarray:
        return ROBOT.margin(margin, REGION.from_unit(u.T, ROBOT.pose_names))

    other = differential_evolution(
        value, [(0, 1)] * 4, seed=3, vectorized=True, updating="deferred", tol=1e-10, maxiter=300, popsize=25
    )
    assert found.value <= other.fun + 1e-7, "seed 3"
    assert found.value == pytest.approx(float(ROBOT.margin(margin, found.pose)), abs=1e-12)


def test_the_descent_goes_below_a_coarse_grid() -> None:
    """With descents a coarse grid finds what only a far finer one would."""
    inside = Box(x=(-0.2, 0.33), y=(-0.31, 0.2), z=(-0.73, -0.6), theta=(-1.0, 1.3))
    coarse = worst_poses(ROBOT, inside, "J_q", about=200)
    fine = worst_poses(ROBOT, inside, "J_q", about=300_000)
    assert coarse.value == pytest.approx(fine.value, abs=1e-9)


def test_a_region_out_of_reach_is_the_worst_there_is() -> None:
    far = Box(x=(0.0, 3.0), y=0.0, z=-0.7, theta=0.0)
    assert worst_poses(ROBOT, far, "fvi", about=1000).value == -math.inf
    assert worst_poses(ROBOT, far, "reach", about=1000).value < 0.0


def test_worst_poses_are_inside_and_in_rising_order() -> None:
    found = worst_poses(ROBOT, REGION, "fvi", about=50_000)
    assert REGION.contains(found.poses, ROBOT.pose_names).all()
    assert (np.diff(found.values) >= 0).all()


def test_a_region_of_one_pose_is_that_pose() -> None:
    point = Box(x=0.1, y=0.0, z=-0.7, theta=0.3)
    found = worst_poses(ROBOT, point, "fvi")
    assert found.value == float(ROBOT.fvi(np.array([0.1, 0.0, -0.7, 0.3])))


def test_local_minima_that_differ_in_y_alone_are_kept_and_near_ones_are_not() -> None:
    found = worst_poses(ROBOT, REGION, "J_q", about=50_000)
    apart = np.abs(found.poses[:, None] - found.poses[None]) / REGION.extent(ROBOT.pose_names)
    apart = apart.max(axis=-1) + np.eye(len(found.poses))
    assert apart.min() > 0.01
