"""Gough-Stewart: geometry, inverse model, invariances and bad input."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematics import GoughStewart, InvalidGeometry, InvalidShape, InvalidValue
from kinematics.robots.gough_stewart.geometry import GoughStewartRanges
from tests.kinematics.robots.gough_stewart.gough_stewart_by_hand import (
    anywhere,
    leg_vectors,
    pose_errors,
    pose_of,
    random_frame,
    random_poses,
    random_robot,
    transform_of,
)
from tests.sizes import few_or_many

Geometry = GoughStewart.Geometry
SEEDS = st.integers(0, 2**32 - 1)


def test_leg_lengths_are_the_distances_of_the_joint_centres_taken_through_all_four_frames() -> None:
    rng = np.random.default_rng(1)
    for _ in range(50):
        robot = random_robot(rng)
        pose = anywhere(rng, 1)[0]
        by_hand = np.linalg.norm(leg_vectors(robot, pose)[0], axis=1)
        np.testing.assert_allclose(robot.inverse(pose), by_hand, rtol=0, atol=1e-14)


def test_closure_vanishes_at_the_inverse_and_grows_with_a_leg() -> None:
    robot, poses = GoughStewart(), random_poses(np.random.default_rng(2), 1000)
    joints = robot.inverse(poses)
    assert np.abs(robot.closure_residual(poses, joints)).max() < 1e-15
    np.testing.assert_allclose(robot.closure_residual(poses, joints + 0.01), 0.01, atol=1e-14)


def test_home_and_the_home_agree_for_the_default_geometry() -> None:
    robot = GoughStewart()
    np.testing.assert_allclose(robot.home, robot.home, atol=1e-15)
    assert robot.characteristic_length == pytest.approx(0.3, abs=1e-15)


@settings(max_examples=30)
@given(SEEDS)
def test_moving_both_frames_moves_the_poses_and_no_leg(seed: int) -> None:
    """Z -> W Z and E -> E T turn a pose P into W P T; leg lengths, det J and the initial pose follow."""
    rng = np.random.default_rng(seed)
    robot, w, t = random_robot(rng), random_frame(rng), random_frame(rng)
    g = robot.geometry
    other = GoughStewart(g.with_values(Z=w @ np.array(g.Z), E=np.array(g.E) @ t))
    pose = anywhere(rng, 1)[0]
    there = pose_of(w @ transform_of(pose) @ t)
    np.testing.assert_allclose(other.inverse(there), robot.inverse(pose), rtol=0, atol=1e-12)
    dets = [np.linalg.det(r.inverse_jacobian(p)) for r, p in ((robot, pose), (other, there))]
    assert dets[0] == pytest.approx(dets[1], rel=1e-9, abs=1e-11)
    begin = pose_of(w @ transform_of(robot.home) @ t)
    assert pose_errors(other.home, begin) < 1e-9


@settings(max_examples=30)
@given(SEEDS)
def test_the_chapters_frames_leave_24_coordinates_and_the_same_robot(seed: int) -> None:
    """8.6.1: A_1, B_1 at the origins, A_2, B_2 on x, A_6, B_6 in xy: twelve coordinates are zero."""
    rng = np.random.default_rng(seed)
    robot = random_robot(rng)
    chapter = robot.geometry.canonical()
    zeros = np.zeros((6, 3), dtype=bool)
    zeros[0], zeros[1, 1:], zeros[5, 2] = True, True, True
    for points in (chapter.base_points, chapter.platform_points):
        assert np.abs(np.array(points)[zeros]).max() < 1e-14
        assert np.count_nonzero(np.abs(points) > 1e-14) == 12
    pose = anywhere(rng, 1)[0]
    np.testing.assert_allclose(GoughStewart(chapter).inverse(pose), robot.inverse(pose), rtol=0, atol=1e-12)


@few_or_many(3, 20)
def test_counting_the_legs_in_another_order_only_reorders_the_joints(count: int) -> None:
    rng = np.random.default_rng(14)
    for _ in range(count):
        assert_order_only_reorders(rng, rng.permutation(6).tolist())


def assert_order_only_reorders(rng: np.random.Generator, order: list[int]) -> None:
    robot = random_robot(rng)
    g = robot.geometry
    points = {name: [getattr(g, name)[i] for i in order] for name in ("base_points", "platform_points")}
    other, pose = GoughStewart(g.with_values(**points)), anywhere(rng, 1)[0]
    np.testing.assert_allclose(other.inverse(pose), robot.inverse(pose)[order], rtol=0, atol=1e-14)
    assert other.fvi(pose) == pytest.approx(robot.fvi(pose), rel=1e-9)
    assert other.margin("det_J_x", pose) == pytest.approx(robot.margin("det_J_x", pose), rel=1e-9, abs=1e-12)


@few_or_many(3, 20)
def test_a_robot_of_another_scale_has_the_same_fvi_and_normalised_determinant(count: int) -> None:
    rng = np.random.default_rng(15)
    for scale in (0.01, 100.0, *rng.uniform(0.01, 100.0, count - 2)):
        assert_scale_changes_neither(rng, scale)


def assert_scale_changes_neither(rng: np.random.Generator, scale: float) -> None:
    robot = random_robot(rng, frames=False)
    g = robot.geometry
    points = {name: scale * np.array(getattr(g, name)) for name in ("base_points", "platform_points")}
    other, pose = GoughStewart(g.with_values(**points)), anywhere(rng, 1)[0]
    large = pose * [scale, scale, scale, 1.0, 1.0, 1.0]
    np.testing.assert_allclose(other.inverse(large), scale * robot.inverse(pose), rtol=1e-12)
    for name in ("fvi", "det_J_x"):
        assert other.margin(name, large) == pytest.approx(robot.margin(name, pose), rel=1e-8, abs=1e-11)


def test_symmetric_layouts_share_joint_centres_as_their_names_say() -> None:
    for geometry, base, platform in ((Geometry.ssm(), 6, 6), (Geometry.tssm(), 6, 3), (Geometry.mssm(), 3, 3)):
        for points, count in ((geometry.base_points, base), (geometry.platform_points, platform)):
            assert len(np.unique(np.round(points, 12) + 0.0, axis=0)) == count
        robot = GoughStewart(geometry)
        lengths = robot.inverse(robot.home)
        np.testing.assert_allclose(lengths, lengths[0], rtol=1e-12)  # symmetric: all legs are alike at the start
        assert robot.margin("det_J_x", robot.home) > 0.1
    ssm = np.array(Geometry.ssm(0.7, 0.2, 0.1, 0.25).base_points)
    np.testing.assert_allclose(np.linalg.norm(ssm, axis=1), 0.7)
    np.testing.assert_allclose(np.arctan2(ssm[:2, 1], ssm[:2, 0]), [-0.1, 0.1])


def test_octahedron_joins_each_vertex_of_one_triangle_to_two_of_the_other() -> None:
    g = Geometry.mssm()
    pairs = {
        (tuple(np.round(a, 9)), tuple(np.round(b, 9))) for a, b in zip(g.base_points, g.platform_points, strict=True)
    }
    assert len(pairs) == 6
    for end in (0, 1):
        counts = [sum(pair[end] == point for pair in pairs) for point in {pair[end] for pair in pairs}]
        assert counts == [2, 2, 2]


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ({"base_radius": 0.0}, "base_radius"),
        ({"platform_radius": math.inf}, "platform_radius"),
        ({"base_half_angle": -0.1}, "base_half_angle"),
        ({"platform_half_angle": 1.2}, "platform_half_angle"),
    ],
)
def test_symmetric_layout_names_the_argument_that_it_refuses(arguments: dict[str, float], word: str) -> None:
    with pytest.raises(InvalidValue, match=word):
        Geometry.ssm(**arguments)


def _sheared() -> np.ndarray:
    frame = np.eye(4)
    frame[0, 1] = 0.1
    return frame


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("base_points", np.zeros((5, 3))),
        ("base_points", np.full((6, 3), np.nan)),
        ("platform_points", [[0.0, 0.0]] * 6),
        ("platform_points", [[0.0], [0.0, 1.0]]),
        ("platform_points", 1.0),
        ("Z", np.zeros((4, 4))),
        ("Z", np.diag([1.0, 1.0, -1.0, 1.0])),
        ("E", _sheared()),
        ("E", np.eye(4) + np.eye(4)[[3, 0, 1, 2]] * 1e-3),
        ("E", np.full((4, 4), np.inf)),
    ],
)
def test_impossible_geometry_names_its_field(field: str, value: object) -> None:
    with pytest.raises(InvalidGeometry) as caught:
        Geometry(**{field: value})
    assert caught.value.field == field
    assert caught.value.mechanism.startswith("GoughStewart")


def test_chapters_frames_need_three_points_off_a_line() -> None:
    points = np.array(Geometry().base_points)
    points[5] = 2 * points[1] - points[0]
    with pytest.raises(InvalidGeometry, match="points 1, 2 and 6"):
        Geometry(base_points=points).canonical()


def test_geometry_is_frozen_hashable_and_comes_back_from_its_vector_and_dictionary() -> None:
    g = Geometry(Z=random_frame(np.random.default_rng(6)))
    assert g == Geometry.from_vector(g.vector()) == Geometry(**g.as_dict())
    assert hash(g) == hash(Geometry(**g.as_dict()))
    assert g.vector().shape == (sum(Geometry.sizes().values()),) == (18 + 18 + 16 + 16 + 3,)
    np.testing.assert_array_equal(g.vector()[3:6], g.base_points[1])  # row by row
    np.testing.assert_array_equal(g.vector()[36:40], g.Z[0])
    symbols, named = Geometry.symbols()
    assert symbols.shape == (71, 1)
    assert named.base_points.shape == (18, 1)
    assert len({g.digest, Geometry().digest}) == 2
    with pytest.raises(AttributeError):
        g.Z = None  # type: ignore[misc,assignment]


def test_a_stroke_bounds_the_travel_and_neither_model() -> None:
    free, poses = GoughStewart(), random_poses(np.random.default_rng(7), 2000)
    lengths = free.inverse(poses)
    low, high = np.quantile(lengths, [0.02, 0.98])
    robot = GoughStewart(ranges=GoughStewartRanges(joints=(low, high)))
    inside = ((lengths >= low) & (lengths <= high)).all(axis=1)
    assert 0.1 < inside.mean() < 0.95
    np.testing.assert_array_equal(robot.margin("joint_travel", poses) >= 0.0, inside)
    np.testing.assert_array_equal(robot.inverse(poses), lengths)
    np.testing.assert_array_equal(robot.forward(lengths), free.forward(lengths))
    robot.require_reachable(poses)


def test_bad_input_is_refused_or_stays_nan() -> None:
    robot = GoughStewart()
    for call in (robot.inverse, robot.jacobians, robot.fvi, robot.forward, robot.assembly_modes):
        with pytest.raises(InvalidShape):
            call(np.zeros(5))
    for call in (robot.leg_rates, robot.legs_wrench, robot.leg_forces):
        with pytest.raises(InvalidShape):
            call(np.array(robot.home), np.zeros(4))
    with pytest.raises(InvalidShape):
        robot.assembly_modes(np.ones((2, 6)))
    with pytest.raises(InvalidShape):
        robot.forward(np.ones(6), np.zeros(3))
    poses = np.array([robot.home, [np.nan, 0, 0.6, 0, 0, 0]])
    joints = robot.inverse(poses)
    np.testing.assert_array_equal(np.isnan(joints).all(axis=1), [False, True])
    np.testing.assert_array_equal(np.isnan(robot.forward(joints)).all(axis=1), [False, True])
    assert np.isnan(robot.fvi(poses)[1])
    assert np.isnan(robot.leg_forces(poses, np.ones(6))[1]).all()
    assert robot.assembly_modes(joints[1]).shape == (0, 6)
    for wrong in (-1.0, 0.0, np.inf):
        assert np.isnan(robot.forward(np.where(np.arange(6) == 2, wrong, joints[0]))).all()


def test_a_leg_without_length_has_no_inverse() -> None:
    robot = GoughStewart(Geometry(platform_points=np.array(Geometry().platform_points) - Geometry().platform_points[0]))
    pose = np.concatenate([Geometry().base_points[0], np.zeros(3)])
    assert robot.margin("reach", pose) == 0.0
    assert np.isnan(robot.inverse(pose)).all()
    assert np.isnan(robot.inverse_jacobian(pose)).any()


def test_drawing_starts_and_ends_at_the_joint_centres() -> None:
    robot = random_robot(np.random.default_rng(8))
    pose = anywhere(np.random.default_rng(9), 1)[0]
    lines = robot.polylines(pose)
    for i, leg in enumerate(leg_vectors(robot, pose)[0]):
        np.testing.assert_allclose(np.diff(lines[f"leg {i + 1}"], axis=0)[0], leg, atol=1e-13)
        np.testing.assert_allclose(lines["platform"][i], lines[f"leg {i + 1}"][1], atol=1e-13)
    np.testing.assert_array_equal(lines["base"][0], lines["base"][-1])
    np.testing.assert_allclose(lines["tool"][1], pose[:3])
