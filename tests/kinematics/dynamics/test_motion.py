"""Derivatives of the joints along a motion, against differences of the inverse model."""

import numpy as np
import pytest

from kinematics import Heli4, InvalidShape, joint_motion
from tests.kinematics.by_hand import OBLIQUE
from tests.kinematics.numeric import slope

CENTRE, SWING = np.array([0.03, -0.05, -0.7, 0.4]), np.array([0.18, 0.15, 0.06, 1.5])
PACE, PHASE = np.array([1.1, 0.8, 1.3, 0.9]), np.array([0.3, 1.9, -0.7, 0.1])


def pose_and_derivatives(t):
    """A motion through the workspace and its first four derivatives by t."""
    angle = np.asarray(t)[..., None] * PACE + PHASE
    steps = [np.sin(angle), np.cos(angle), -np.sin(angle), -np.cos(angle), np.sin(angle)]
    return [(CENTRE if k == 0 else 0) + SWING * PACE**k * step for k, step in enumerate(steps)]


TIMES = np.linspace(0, 10, 301)


@pytest.mark.parametrize("robot", [Heli4(), Heli4(OBLIQUE)], ids=["prototype", "oblique"])
def test_each_derivative_is_the_slope_of_the_one_before(robot):
    def motion(t):
        return joint_motion(robot, *pose_and_derivatives(t)[:4])

    found = motion(TIMES)
    # Two programs: they may round differently.
    np.testing.assert_allclose(found.position, robot.inverse(pose_and_derivatives(TIMES)[0]), rtol=1e-14)
    for lower, higher in zip(range(3), found[1:], strict=True):
        expected = slope(lambda t, k=lower: motion(t)[k], TIMES, 1e-3)
        assert np.abs(expected - higher).max() < 1e-8 * max(1.0, np.abs(higher).max())


def test_speed_is_the_inverse_jacobian_times_the_twist():
    robot = Heli4(OBLIQUE)
    pose, first, second, third, _ = pose_and_derivatives(TIMES)
    expected = (robot.inverse_jacobian(pose) @ first[..., None])[..., 0]
    assert np.abs(joint_motion(robot, pose, first, second, third).first - expected).max() < 1e-13


def test_by_any_parameter():
    """Halving the parameter doubles, quadruples and octuples the derivatives."""
    robot = Heli4()
    pose, first, second, third, _ = pose_and_derivatives(TIMES)
    slow, fast = (joint_motion(robot, pose, k * first, k**2 * second, k**3 * third) for k in (1, 2))
    for power, (a, b) in enumerate(zip(slow, fast, strict=True)):
        np.testing.assert_allclose(b, 2**power * a, rtol=1e-9, atol=1e-10)


def test_standing_still():
    zero = np.zeros(4)
    still = joint_motion(Heli4(), np.array(Heli4().home), zero, zero, zero)
    assert [np.abs(part).max() for part in still[1:]] == [0.0, 0.0, 0.0]


def test_a_pose_that_one_limb_cannot_reach_is_nan_in_every_limb():
    poses = np.array([Heli4().home, [0.9, 0.0, -0.7, 0.0]])
    zero = np.zeros(4)
    for part in joint_motion(Heli4(), poses, zero, zero, zero):
        assert np.isnan(part).tolist() == [[False] * 4, [True] * 4]


def test_the_derivative_of_the_wrong_length_is_named():
    zero = np.zeros(4)
    with pytest.raises(InvalidShape, match=r"second derivative: found an array of shape \(3,\)"):
        joint_motion(Heli4(), np.array(Heli4().home), zero, np.zeros(3), zero)
