"""The Peppermill names bad input, or answers NaN rows; it never gives a silent number."""

import numpy as np
import pytest

from kinematics import InvalidGeometry, InvalidShape, Peppermill, UnreachablePose


def test_poses_out_of_reach_are_nan_rows_and_named_on_demand():
    robot = Peppermill()
    poses = np.array([[0, 0, 0, 0], [0, 0.3, 0.2, 0], [0, 0, -0.25, 0], [np.nan, 0, 0, 0], [0, 0, np.inf, 0.0]])
    joints = robot.inverse(poses)
    np.testing.assert_array_equal(np.isnan(joints).all(axis=-1), [False, True, True, True, True])
    np.testing.assert_array_equal(np.isnan(joints).any(axis=-1), [False, True, True, True, True])
    np.testing.assert_array_equal(np.isnan(robot.inverse_modes(poses)).all(axis=(1, 2)), np.isnan(joints[:, 0]))
    with pytest.raises(UnreachablePose) as caught:
        robot.require_reachable(poses[:2])
    assert (caught.value.limb, round(caught.value.margin, 6)) == (1, round(0.7 - np.hypot(0.3, 0.7), 6))
    with pytest.raises(UnreachablePose) as caught:
        robot.require_reachable(poses[2])
    assert caught.value.limb == 2  # h_2 = -0.75; limb 1, folded to 0.25, is no worse
    assert caught.value.margin == pytest.approx(-0.05)


def test_joints_without_a_pose_give_nan_rows():
    robot = Peppermill()
    for joints in ([0, 5.0, 0, 0], [5.0, 0, 0, 0], [0, np.nan, 0, 0]):
        assert np.isnan(robot.forward(np.array(joints))).all()
        assert np.isnan(robot.forward_modes(np.array(joints))).all()


def test_wrong_shapes_are_named():
    robot = Peppermill()
    for call in (robot.inverse, robot.inverse_modes, robot.forward, robot.forward_modes, robot.motors):
        with pytest.raises(InvalidShape):
            call(np.zeros((5, 3)))
    with pytest.raises(InvalidShape, match="1L"):
        robot.from_motors(np.zeros(5))
    with pytest.raises(InvalidShape):
        robot.assembly_modes(np.zeros((2, 4)))


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"pitches": (0.1, 0.1)}, "pitches"),
        ({"pitches": (-0.05, -0.05 * (1 + 1e-14))}, "pitches"),
        ({"pitches": (0.1, 0.0)}, "pitches"),
        ({"pitches": (0.1, -0.1, 0.1)}, "pitches"),
        ({"drive_pitch": -0.1}, "drive_pitch"),
        ({"drive_pitch": 0.0}, "drive_pitch"),
        ({"proximal_lengths": (0.2, 0.0)}, "proximal_lengths"),
        ({"distal_lengths": (-0.5, 0.5)}, "distal_lengths"),
        ({"half_distance": 0.0}, "half_distance"),
        ({"half_distance": np.nan}, "half_distance"),
    ],
)
def test_degenerate_geometry_is_refused_by_field(change, field):
    with pytest.raises(InvalidGeometry) as caught:
        Peppermill.Geometry(**change)
    assert caught.value.field == field


def test_equal_pitches_are_refused_as_what_they_are():
    with pytest.raises(InvalidGeometry, match="architecture singularity"):
        Peppermill.Geometry(pitches=(0.1, 0.1))
    with pytest.raises(InvalidGeometry, match="architecture singularity"):
        Peppermill.Geometry(pitches=(0.1, 0.1 * (1 - 0.9e-6)))
    Peppermill.Geometry(pitches=(0.1, 0.1 * (1 - 1.1e-6)))  # poor, but not singular


def test_the_closest_pitches_return_the_nuts_to_rounding_and_the_turn_to_what_rounding_becomes():
    robot = Peppermill(Peppermill.Geometry(pitches=(0.1, 0.1 * (1 - 1.1e-6))))
    rng = np.random.default_rng(11)
    poses = rng.uniform([-0.1, -0.1, -0.05, -1.0], [0.1, 0.1, 0.05, 1.0], (10_000, 4))
    error = np.abs(robot.forward(robot.inverse(poses)) - poses).max(axis=0)
    assert error[:3].max() < 1e-9
    nuts = 4 * np.finfo(float).eps * robot.geometry.half_distance  # [m], a few roundings of a nut's height
    assert error[3] < nuts * 2 * np.pi / 1.1e-7  # 2.6e-8 rad: no forward model can know theta better from doubles
    assert error[3] > 1e-9


def test_equal_links_folded_onto_the_drive_axis_have_no_angle():
    robot = Peppermill(Peppermill.Geometry(proximal_lengths=(0.4, 0.4), distal_lengths=(0.4, 0.4)))
    g = robot.geometry
    folded = np.array([0.0, 0.0, g.half_distance, 0.0])  # nut 2 is on drive axis 2 or nut 1 on drive axis 1
    poses = np.array([folded, -folded, folded - np.array([0, 0, 0.45, 0])])
    free = poses[:2]
    gap = np.abs([robot.closure_residual(free, np.array([0.0, 0.0, a, 2 * a])) for a in (0.3, 1.0, 2.0)])
    assert (gap.min(axis=-1) < 1e-15).all()  # one limb closes at any angle
    joints = robot.inverse(poses)
    assert np.isnan(joints).tolist() == [[True] * 4] * 2 + [[False] * 4]
    assert np.isnan(robot.inverse_modes(free)).all()
    assert np.isnan(robot.margin("reach", free)).all()
    assert robot.margin("reach", poses[2]) > 0.0
    with pytest.raises(UnreachablePose):
        robot.require_reachable(free[0])
    unequal = Peppermill(Peppermill.Geometry(proximal_lengths=(0.3, 0.3), distal_lengths=(0.4, 0.4)))
    assert unequal.margin("reach", folded) == pytest.approx(-0.3)  # the other nut is 1 m away, links of 0.7 m
