"""A search or a proof that runs out of time says what it reached."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest

from design import Box, Cylinder, best_bound, certified_cells, certified_cylinder, certify, replay, worst_poses
from kinematics import Heli4, InvalidValue, Redundant3T1R

ROBOT = Heli4()
REGION = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-math.pi, math.pi))


def test_a_proof_out_of_time_is_undecided_with_its_boxes_and_what_is_left() -> None:
    certify(ROBOT, REGION, "clearance", at_least=0.003, most_boxes=10)  # the kernel is compiled now
    started = time.perf_counter()
    found = certify(ROBOT, REGION, "clearance", at_least=0.003, seconds=0.3)
    assert time.perf_counter() - started < 10.0
    assert found.status == "undecided"
    assert found.counterexample is None
    assert len(found.left) > 0
    low, high = found.left[:, 0], found.left[:, 1]
    assert (low <= high).all()
    assert found.boxes >= 0


def test_time_that_is_enough_changes_nothing() -> None:
    with_end = certify(ROBOT, REGION, "J_q", at_least=0.4, seconds=1000.0)
    assert with_end.status == "proved"
    assert (with_end.codes == certify(ROBOT, REGION, "J_q", at_least=0.4).codes).all()
    assert replay(with_end, ROBOT) > 0


def test_a_dense_search_out_of_time_says_that_it_is_not_complete() -> None:
    found = worst_poses(ROBOT, REGION, "fvi", about=10_000_000, seconds=1e-3)
    assert not found.complete
    assert 0 < found.sampled < 10_000_000
    assert np.isfinite(found.value)
    assert worst_poses(ROBOT, REGION, "fvi", about=1000, seconds=1000.0).complete


def test_a_best_bound_out_of_time_is_what_was_proved_by_then_or_none() -> None:
    found = best_bound(ROBOT, REGION, "fvi", 1e-6, seconds=1e-3)
    assert found is None or found.certificate.status == "proved"


def test_a_certified_region_out_of_time_says_so() -> None:
    found = certified_cylinder(ROBOT, REGION, "fvi", at_least=0.98, seconds=0.2)
    assert not found.complete
    assert found.radius <= REGION.radius
    plane = Box(x=0.0, y=(0.2, 0.3), z=(0.3, 0.6), theta=(-0.5, 0.5))
    cells = certified_cells(Redundant3T1R(), plane, ("y", "z"), "fvi", at_least=1.0, depth=4, seconds=1000.0)
    assert cells.complete
    short = certified_cells(Redundant3T1R(), plane, ("y", "z"), "fvi", at_least=1.0, depth=4, seconds=1.0)
    assert short.area(("y", "z")) <= cells.area(("y", "z")) * (1 + 1e-12)


@pytest.mark.parametrize("tolerance", [5e-324, 1e-18, 5.6e-17])
def test_a_radius_finer_than_doubles_is_refused_and_the_finest_ends(tolerance: float) -> None:
    with pytest.raises(InvalidValue, match="step between radii"):
        certified_cylinder(ROBOT, REGION, "reach", at_least=0.01, tolerance=tolerance)


@pytest.mark.long
def test_the_finest_tolerance_of_a_radius_ends() -> None:
    found = certified_cylinder(
        ROBOT, Cylinder(0.9, z=-0.7, theta=0.0), "reach", at_least=0.01, tolerance=1.2e-16, most_boxes=200
    )
    assert 0.0 < found.radius < 0.9


@pytest.mark.parametrize("seconds", [0.0, -1.0, math.nan, "1", True, None])
def test_a_time_that_means_nothing_is_named(seconds: object) -> None:
    for ask in (
        lambda: certify(ROBOT, REGION, "J_q", at_least=0.4, seconds=seconds),  # type: ignore[arg-type]
        lambda: worst_poses(ROBOT, REGION, "J_q", seconds=seconds),  # type: ignore[arg-type]
        lambda: best_bound(ROBOT, REGION, "J_q", 0.1, seconds=seconds),  # type: ignore[arg-type]
        lambda: certified_cylinder(ROBOT, REGION, "J_q", at_least=0.4, seconds=seconds),  # type: ignore[arg-type]
    ):
        with pytest.raises(InvalidValue, match="seconds"):
            ask()
