"""What the interface promises of every mechanism alike: wrong, missing and unreachable input is never a number."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics import MECHANISMS, InvalidShape, InvalidValue, Mechanism, UnreachablePose

UNLIMITED = ("GoughStewart", "Planar3RPR")  # legs of any length reach everywhere
ALL = pytest.mark.parametrize("robot", [kind() for kind in MECHANISMS.values()], ids=list(MECHANISMS))


def home(robot: Mechanism) -> np.ndarray:
    return np.array(robot.home, dtype=float)


@ALL
def test_a_nan_in_any_coordinate_makes_everything_nan_and_is_not_reachable(robot: Mechanism) -> None:
    for coordinate in range(len(robot.pose_names)):
        pose = np.stack([home(robot), home(robot)])
        pose[0, coordinate] = np.nan
        for margin in robot.margins:
            found = robot.margin(margin, pose)
            assert np.isnan(found[0]), (margin, coordinate)
            assert np.isfinite(found[1]), (margin, coordinate)
        for found in (
            robot.inverse(pose),
            robot.inverse_jacobian(pose),
            *robot.jacobians(pose),
            *robot.isotropic(pose),
        ):
            assert np.isnan(found[0]).all()
            assert np.isfinite(found[1]).all()
        with pytest.raises(UnreachablePose):
            robot.require_reachable(pose)


@pytest.mark.parametrize("robot", [kind() for name, kind in MECHANISMS.items() if name not in UNLIMITED])
def test_out_of_reach_all_jacobians_are_nan_as_a_whole(robot: Mechanism) -> None:
    far = home(robot)
    far[1] += 50.0
    for found in (
        robot.inverse(far),
        robot.inverse_jacobian(far),
        *robot.jacobians(far),
        robot.fvi(far),
        robot.condition_number(far),
    ):
        assert np.isnan(found).all()


@ALL
@pytest.mark.parametrize("bad", ["text", [[0.0], [0.0, 1.0]], None, 1j], ids=["text", "ragged", "None", "complex"])
def test_what_is_no_array_of_real_numbers_is_refused(robot: Mechanism, bad: object) -> None:
    values = np.full(len(robot.pose_names), bad) if isinstance(bad, complex) else bad
    for method in (robot.inverse, robot.fvi, robot.require_reachable):
        with pytest.raises((InvalidValue, InvalidShape)):
            method(values)
    with pytest.raises((InvalidValue, InvalidShape)):
        robot.forward(values)


@ALL
def test_poses_and_joints_that_do_not_go_together_are_refused(robot: Mechanism) -> None:
    poses = np.stack([home(robot)] * 2)
    with pytest.raises(InvalidValue, match="can be broadcast"):
        robot.closure_residual(poses, robot.inverse(np.stack([home(robot)] * 3)))


@ALL
def test_any_leading_shape_comes_back(robot: Mechanism) -> None:
    n, m = len(robot.pose_names), len(robot.joint_names)
    for lead in ((), (0,), (3,), (2, 3)):
        pose = np.broadcast_to(home(robot), (*lead, n))
        joints = robot.inverse(pose)
        assert joints.shape == (*lead, m)
        assert robot.forward(joints).shape == (*lead, n)
        assert robot.inverse_jacobian(pose).shape == (*lead, m, n)
        assert robot.fvi(pose).shape == lead
