"""What is wrong is named; what cannot be reached is NaN, and only that."""

import numpy as np
import pytest

from kinematics import Delta, Hexa, InvalidGeometry, InvalidShape, Par4, Planar3RPR, UnreachablePose
from tests.kinematics.family_by_hand import FAMILY, PLANAR

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
    joints = robot.inverse(np.array([kind.home, kind.home]))
    assert robot.forward(joints).shape == (2, n)
    assert robot.forward(np.zeros((0, m))).shape == (0, n)
    joints[1, 1] = np.nan
    found = robot.forward(joints)
    assert np.abs(found[0] - kind.home).max() < 1e-12
    assert np.isnan(found[1]).all()
    assert robot.assembly_modes(joints[1]).shape == (0, n)
    pose = np.array(kind.home)
    pose[1] = np.nan
    assert np.isnan(robot.inverse(pose)).all()


@EACH
def test_what_is_out_of_reach_is_nan_and_named(kind):
    robot, pose = kind(), np.array(kind.home)
    if kind is Planar3RPR:
        return
    pose[0] = 5.0
    assert np.isnan(robot.inverse(pose)).all()
    with pytest.raises(UnreachablePose) as error:
        robot.require_reachable(np.array([kind.home, pose]))
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
