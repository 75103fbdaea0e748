"""The certified region is proved, lies inside the sampled one, and is nearly as large."""

from __future__ import annotations

import math

import numpy as np
import pytest

from design import (
    Box,
    Cylinder,
    InvalidRegion,
    InvalidSection,
    Section,
    certified_cells,
    certified_cylinder,
    certify,
    index_of,
    level_set,
    replay,
)
from kinematics import Heli4, InvalidValue, Redundant3T1R

PI = math.pi
AXES = ("y", "z")
ROBOT = Redundant3T1R()
# Where the boundary of FVI >= 1 crosses the plane.
CORNER = Box(x=0.0, y=(0.2, 0.3), z=(0.3, 0.6), theta=(-PI / 2, PI / 2))
SLIM = Cylinder(radius=0.6, z=(-0.7, -0.7), theta=(-PI, PI))


def test_the_cells_are_proved_and_lie_inside_the_sampled_region() -> None:
    found = certified_cells(ROBOT, CORNER, AXES, "fvi", at_least=1.0, depth=5)
    sampled = level_set(index_of(ROBOT, "fvi"), Section(CORNER, AXES), ROBOT.pose_names, 1.0).figures.area
    assert 0.9 * sampled < found.area(AXES) < sampled
    cells, rng = found.cells(AXES), np.random.default_rng(1)
    assert (cells[:, 0] < cells[:, 1]).all()
    poses = np.zeros((len(cells), 200, 4))
    poses[..., 1:3] = rng.uniform(cells[:, None, 0], cells[:, None, 1], (len(cells), 200, 2))
    poses[..., 3] = rng.uniform(-PI / 2, PI / 2, poses.shape[:2])
    assert ROBOT.fvi(poses).min() >= 1.0
    for certificate in found.certificates[::20]:
        assert certificate.region.intervals["theta"] == CORNER.intervals["theta"]
        assert replay(certificate, ROBOT, margin="fvi", at_least=1.0) > 0


def test_the_cells_do_not_overlap() -> None:
    cells = certified_cells(ROBOT, CORNER, AXES, "fvi", at_least=1.0, depth=4).cells(AXES)
    low, high = cells[:, None, 0], cells[:, None, 1]
    common = np.minimum(high, cells[None, :, 1]) - np.maximum(low, cells[None, :, 0])
    shared = np.clip(common, 0.0, None).prod(axis=-1)
    assert np.array_equal(shared > 0.0, np.eye(len(cells), dtype=bool))


def test_finer_cells_prove_more() -> None:
    areas = [certified_cells(ROBOT, CORNER, AXES, "fvi", at_least=1.0, depth=d).area(AXES) for d in (2, 3, 4)]
    assert areas[0] < areas[1] < areas[2]


def test_a_bound_that_nothing_keeps_leaves_nothing() -> None:
    found = certified_cells(ROBOT, CORNER, AXES, "fvi", at_least=3.0, depth=2)
    assert found.certificates == ()
    assert found.area(AXES) == 0.0
    nowhere = certified_cylinder(Heli4(), SLIM, "internal_determinant", at_least=0.99, tolerance=0.1)
    assert (nowhere.radius, nowhere.certificates) == (0.0, ())


def test_too_few_boxes_are_left_undecided_and_not_proved() -> None:
    inner = Box(x=0.0, y=(0.0, 0.1), z=(0.0, 0.1), theta=(-PI / 2, PI / 2))
    found = certified_cells(ROBOT, inner, AXES, "fvi", at_least=1.0, depth=1, most_boxes=1)
    assert found.certificates == ()
    assert len(found.left) >= 4
    assert (found.left[:, 0] <= found.left[:, 1]).all()


def test_the_largest_cylinder_is_proved_and_a_little_more_is_not() -> None:
    robot, tolerance = Heli4(), 5e-3
    found = certified_cylinder(robot, SLIM, "internal_determinant", at_least=0.45, tolerance=tolerance)
    assert 0.1 < found.radius < SLIM.radius
    (certificate,) = found.certificates
    assert replay(certificate, robot, margin="internal_determinant", at_least=0.45) > 0
    beyond = Cylinder(found.radius + tolerance, z=(-0.7, -0.7), theta=(-PI, PI))
    assert certify(robot, beyond, "internal_determinant", at_least=0.45).status != "proved"


def test_a_region_that_holds_as_a_whole_is_its_own_largest() -> None:
    found = certified_cylinder(
        Heli4(), Cylinder(0.3, z=(-0.7, -0.7), theta=(-PI, PI)), "internal_determinant", at_least=0.45
    )
    assert found.radius == 0.3
    inner = Box(x=0.0, y=(0.0, 0.1), z=(0.0, 0.1), theta=(-PI / 2, PI / 2))
    cells = certified_cells(ROBOT, inner, AXES, "fvi", at_least=1.0, depth=3)
    assert len(cells.certificates) == 1
    assert math.isclose(cells.area(AXES), 0.01)


def test_a_tolerance_finer_than_the_step_between_doubles_is_refused_and_that_step_is_reached() -> None:
    robot, finest = Heli4(), float(np.spacing(0.6))
    with pytest.raises(InvalidValue, match=r"tolerance: found .* at least 1\.11e-16 m"):
        certified_cylinder(robot, SLIM, "internal_determinant", at_least=0.45, tolerance=0.5 * finest)
    found = certified_cylinder(robot, SLIM, "reach", at_least=9.0, tolerance=finest)
    assert found.radius == 0.0


def test_what_has_no_such_family_is_refused() -> None:
    with pytest.raises(InvalidSection, match="Box"):
        certified_cells(Heli4(), SLIM, ("x", "y"), "fvi", at_least=1.0)
    with pytest.raises(InvalidSection, match="different"):
        certified_cells(ROBOT, CORNER, ("y", "y"), "fvi", at_least=1.0)
    with pytest.raises(InvalidValue, match="depth"):
        certified_cells(ROBOT, CORNER, AXES, "fvi", at_least=1.0, depth=11)
    with pytest.raises(InvalidValue, match="margin"):
        certified_cells(ROBOT, CORNER, AXES, "speed", at_least=1.0)
    with pytest.raises(InvalidValue, match="at_least"):
        certified_cells(ROBOT, CORNER, AXES, "fvi", at_least=math.nan)
    with pytest.raises(InvalidValue, match="tolerance"):
        certified_cylinder(Heli4(), SLIM, "fvi", at_least=1.0, tolerance=0.0)
    with pytest.raises(InvalidRegion):
        certified_cylinder(Heli4(), Cylinder(0.3, z=-0.7), "fvi", at_least=1.0)
