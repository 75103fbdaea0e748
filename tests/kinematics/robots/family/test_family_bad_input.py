"""What is wrong is named; what cannot be reached is NaN, and only that."""

import numpy as np
import pytest

from kinematics import (
    Delta,
    Heli4,
    Hexa,
    InvalidGeometry,
    InvalidShape,
    Par4,
    Planar3PRR,
    Planar3RPR,
    Planar3RRR,
    UnreachablePose,
)
from tests.kinematics.robots.family.family_by_hand import FAMILY, PLANAR

EACH = pytest.mark.parametrize("kind", FAMILY, ids=lambda kind: kind.__name__)


@EACH
def test_wrong_shapes_and_nan(kind):
    robot, n, m = kind(), len(kind.pose_names), len(kind.joint_names)
    for shape in [(), (n + 1,), (n - 1,), (0,), (2, n + 1)]:
        with pytest.raises(InvalidShape):
            robot.inverse(np.zeros(shape))
        with pytest.raises(InvalidShape):
            robot.forward(np.zeros(shape))
    with pytest.raises(InvalidShape):
        robot.assembly_modes(np.zeros((2, m)))
    joints = robot.inverse(np.array([kind().home, kind().home]))
    assert robot.forward(joints).shape == (2, n)
    assert robot.forward(np.zeros((0, m))).shape == (0, n)
    joints[1, 1] = np.nan
    found = robot.forward(joints)
    assert np.abs(found[0] - kind().home).max() < 1e-12
    assert np.isnan(found[1]).all()
    assert robot.assembly_modes(joints[1]).shape == (0, n)
    pose = np.array(kind().home)
    pose[1] = np.nan
    assert np.isnan(robot.inverse(pose)).all()


@EACH
def test_what_is_out_of_reach_is_nan_and_named(kind):
    robot, pose = kind(), np.array(kind().home)
    if kind is Planar3RPR:
        return
    pose[0] = 5.0
    assert np.isnan(robot.inverse(pose)).all()
    with pytest.raises(UnreachablePose) as error:
        robot.require_reachable(np.array([kind().home, pose]))
    assert error.value.pose == tuple(pose)
    assert error.value.margin < -3.0


@EACH
def test_a_geometry_that_is_impossible_is_refused_by_name(kind):
    field = "base_points" if kind is Planar3RPR else ("rod_length" if kind not in PLANAR else "rod_lengths")
    with pytest.raises(InvalidGeometry) as error:
        kind.Geometry(**{field: "long"})
    assert error.value.field == field
    assert kind.__name__ in str(error.value)


def test_degenerate_platforms_are_refused():
    with pytest.raises(InvalidGeometry, match="platform_points"):
        Planar3RPR.Geometry(platform_points=((0.1, 0.1),) * 3)
    with pytest.raises(InvalidGeometry, match="platform_points"):
        Hexa.Geometry(platform_points=tuple((0.1 * i, 0.2 * i, 0.0) for i in range(6)))
    with pytest.raises(InvalidGeometry, match="azimuths"):
        Delta.Geometry(azimuths=(0.0, 1.0, 0.0))
    with pytest.raises(InvalidGeometry, match="amplification"):
        Par4.Geometry(amplification=0.0)


ROUNDING = 1e-12


def twin(values, first, second):
    """Item `second` replaced by item `first` and a rounding."""
    items = [np.array(v, dtype=float) for v in values]
    items[second] = items[first] * (1 + ROUNDING)
    return tuple(tuple(i.tolist()) if i.ndim else float(i) for i in items)


def refused(kind, field, reason, **change):
    with pytest.raises(InvalidGeometry, match=reason) as error:
        kind.Geometry(**change)
    assert error.value.field == field


def test_base_points_that_coincide_are_refused_where_the_robot_would_turn_freely():
    one = ((0.3, 0.1), (0.3, 0.1 + ROUNDING), (0.3, 0.1))
    refused(Planar3RPR, "base_points", "could turn freely", base_points=one)
    refused(Planar3RPR, "platform_points", "could turn freely", platform_points=one)
    robot = Planar3PRR(Planar3PRR.Geometry(base_points=((0.0, 0.0),) * 3, rail_angles=(0.3, 2.4, 4.5)))
    assert robot.margin("det_J_x", np.array([0.05, 0.02, 0.4])) > 1e-3  # rails from one point hold the platform


@pytest.mark.parametrize("kind", [Planar3RPR, Planar3PRR, Planar3RRR], ids=lambda kind: kind.__name__)
def test_two_equal_legs_are_refused(kind):
    g = kind.Geometry()
    change = {"platform_points": twin(g.platform_points, 0, 2), "base_points": twin(g.base_points, 0, 2)}
    if kind is Planar3PRR:
        kind.Geometry(**change)  # from one point, but along two rails
        change["rail_angles"] = twin(g.rail_angles, 0, 2)
    refused(kind, "platform_points", "legs 1 and 3", **change)
    for name in ("platform_points", "base_points"):
        kind.Geometry(**{name: change[name]})  # one end alone does not make them equal
    if kind is Planar3RRR:
        kind.Geometry(**change, arm_lengths=(0.3, 0.3, 0.28))


def test_two_equal_limbs_of_a_hexa_are_refused():
    g = Hexa.Geometry()
    change = {
        "platform_points": twin(g.platform_points, 1, 4),
        "base_points": twin(g.base_points, 1, 4),
        "arm_azimuths": (*g.arm_azimuths[:4], g.arm_azimuths[1] - 2 * np.pi, g.arm_azimuths[5]),
    }
    refused(Hexa, "platform_points", "limbs 2 and 5", **change)
    for left_out in change:
        Hexa.Geometry(**{name: change[name] for name in change if name != left_out})


@pytest.mark.parametrize("kind", [Heli4, Par4], ids=lambda kind: kind.__name__)
def test_equal_azimuths_of_one_half_are_refused_and_of_two_halves_are_not(kind):
    a, b, turn = 0.4, 2.1, 2 * np.pi
    for azimuths in [(a,) * 4, (a, a + turn + ROUNDING, b, b + 1), (b, b + 1, a, a - turn)]:
        refused(kind, "azimuths", "coincide", azimuths=azimuths)
    robot = kind(kind.Geometry(azimuths=(a, b, a, b)))
    poses = np.array(kind().home) + [[0.03, 0.02, 0.01, t] for t in (0.5, -0.8)]
    assert (robot.margin("det_J_x", poses) > 1e-6).all()


def test_equal_azimuths_of_a_delta_are_refused():
    for azimuths in [(0.5, 0.5 + ROUNDING, 3.0), (0.5, 3.0, 0.5 + 2 * np.pi)]:
        refused(Delta, "azimuths", "three different directions", azimuths=azimuths)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("kind", PLANAR, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("value", [np.inf, -np.inf, 1e308, 1e200, 1e80])
def test_infinite_and_overflowing_joints_are_nan_without_a_warning(kind, value):
    robot = kind()
    joints = robot.inverse(np.array([kind().home] * 5))
    joints[range(3), range(3)] = value
    joints[3] = value
    found = robot.forward(joints)
    assert np.isnan(found[:4]).all()
    assert np.abs(found[4] - kind().home).max() < 1e-12
    assert robot.assembly_modes(joints[0]).shape == (0, 3)
    assert np.isnan(robot.forward(joints[4], near=np.array([value, 0.0, 0.0]))).all()
    robot.inverse(np.array([value, 0.0, 0.0]))
