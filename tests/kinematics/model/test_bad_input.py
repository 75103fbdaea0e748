"""What is wrong is named; what cannot be reached is NaN, and only that."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematics import Heli4, InvalidGeometry, InvalidShape, LinkwrightError, UnreachablePose
from tests.kinematics.by_hand import ByHand, cylinder

_COUNT = sum(Heli4.Geometry.sizes().values())

ROBOT = Heli4()


@pytest.mark.parametrize("shape", [(), (3,), (5,), (4, 3), (2, 4, 1), (0,)], ids=str)
@pytest.mark.parametrize(
    "method",
    [
        *("inverse", "inverse_jacobian", "jacobians", "fvi", "isotropic", "condition_number", "internal_determinant"),
        *("rod_system", "block_triangular", "require_reachable", "forward", "assembly_modes"),
    ],
)
def test_wrong_shape_is_refused_with_the_names_wanted(method, shape):
    with pytest.raises(InvalidShape) as error:
        getattr(ROBOT, method)(np.zeros(shape))
    wanted = ROBOT.joint_names if method in ("forward", "assembly_modes") else ROBOT.pose_names
    assert error.value.names == wanted
    assert error.value.found == shape
    assert str(shape) in str(error.value)


@pytest.mark.parametrize("column", range(4))
@pytest.mark.parametrize("method", ["inverse", "inverse_jacobian", "fvi", "internal_determinant", "condition_number"])
def test_a_nan_pose_gives_nan_and_spoils_no_other(method, column):
    poses = cylinder(300, seed=1)
    clean = getattr(ROBOT, method)(poses)
    poses[100, column] = np.nan
    found = getattr(ROBOT, method)(poses)
    assert np.isnan(found[100]).all()
    assert np.array_equal(np.delete(found, 100, axis=0), np.delete(clean, 100, axis=0))


def test_a_nan_pose_gives_a_row_of_nan_joints_and_back():
    poses = np.array([Heli4().home, [0, 0, np.nan, 0]])
    assert np.isnan(ROBOT.inverse(poses)).tolist() == [[False] * 4, [True] * 4]
    joints = ROBOT.inverse([Heli4().home] * 2)
    joints[1, 2] = np.nan
    assert np.isnan(ROBOT.forward(joints)).tolist() == [[False] * 4, [True] * 4]
    assert ROBOT.assembly_modes(joints[1]).shape == (0, 4)


def test_joints_that_cannot_close_give_nan():
    robot = Heli4(Heli4.Geometry(rod_length=0.6))
    assert np.isnan(robot.forward(np.full((2, 4), np.pi / 2))).all()


def test_out_of_reach_names_the_worst_pose_its_limb_and_margin():
    poses = np.array([Heli4().home, [0.3, 0.0, -0.7, 0.0], [0.0, -0.95, -0.7, 0.0], [0.85, 0.0, -0.7, 0.0]])
    with pytest.raises(UnreachablePose) as error:
        ROBOT.require_reachable(poses)
    assert error.value.pose == tuple(poses[2])
    assert error.value.limb == 3
    hand = ByHand(ROBOT.geometry)
    farthest = np.linalg.norm(hand.rods(poses[2], np.linspace(-np.pi, np.pi, 5001)[:, None] * np.ones(4)), axis=-1)
    assert abs(error.value.margin - (0.8 - farthest.min(0)[2])) < 1e-6
    assert "limb 3" in str(error.value)
    assert f"{error.value.margin:.6g} m" in str(error.value)


def test_within_reach_nothing_is_raised():
    ROBOT.require_reachable(cylinder(1000, seed=2))
    ROBOT.require_reachable(np.zeros((0, 4)))


def test_nan_is_not_reachable():
    with pytest.raises(UnreachablePose):
        ROBOT.require_reachable([0.0, 0.0, np.nan, 0.0])


@pytest.mark.parametrize(
    ("field", "value", "expected"),
    [
        ("base_radius", -0.1, "> 0 m"),
        ("arm_length", 0.0, "> 0 m"),
        ("rod_length", np.nan, "finite"),
        ("platform_radius", np.inf, "finite"),
        ("height_step", "low", "a number"),
        ("height_step", "0.1", "a number"),
        ("height_step", True, "a number"),
        ("plate_offset", None, "a number"),
        ("azimuths", (0.0, (1.0, 2.0), 2.0, 3.0), "4 numbers"),
        ("rod_length", (0.8, 0.8), "a number"),
        ("pitch", 0.0, "other than 0"),
        ("azimuths", (0.0, 1.0, 2.0), "4 numbers"),
        ("azimuths", 0.0, "4 numbers"),
        ("azimuths", (0.0, 1.0, 2.0, np.nan), "finite"),
        ("azimuths", ("a", "b", "c", "d"), "4 numbers"),
        ("parallelogram_width", -1e-9, "> 0 m"),
    ],
)
def test_a_geometry_error_names_its_field(field, value, expected):
    with pytest.raises(InvalidGeometry) as error:
        Heli4.Geometry(**{field: value})
    assert error.value.field == field
    assert str(error.value).startswith(f"Heli4 geometry, {field}: found {value}; expected ")
    assert expected in str(error.value)
    assert isinstance(error.value, LinkwrightError)


def test_signed_lengths_and_left_handed_screws_are_fine():
    geometry = Heli4.Geometry(height_step=-0.1, plate_offset=-0.02, pitch=-0.05)
    assert np.isfinite(Heli4(geometry).inverse(Heli4().home)).all()


@given(st.lists(st.floats(0.01, 2.0), min_size=_COUNT, max_size=_COUNT))
@settings(max_examples=50, deadline=None)
def test_geometry_to_vector_and_back(values):
    fields = list(Heli4.Geometry.sizes())
    for wall, radius in Heli4.Geometry.walls().items():
        places = [sum(list(Heli4.Geometry.sizes().values())[: fields.index(name)]) for name in (wall, radius)]
        values[places[0]] = min(values[k] for k in places)
    values[8] += 2.5  # limbs of one plate, apart
    values[10] += 2.5
    geometry = Heli4.Geometry.from_vector(np.array(values))
    assert np.array_equal(geometry.vector(), values)
    assert Heli4.Geometry(**geometry.as_dict()) == geometry
    assert Heli4.Geometry(**geometry.as_dict()).digest == geometry.digest
