"""What a path asks for at any speed is told before it is timed: joint, place, value and range."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from kinematics import Heli4, inverse_dynamics
from tests.sizes import later
from trajectory import AdeptCycle, Limits, PathBeyondLimit, RoundedPath, jerk_limited, motion_of, time_optimal

Law = Callable[..., object]
LAWS = [time_optimal, jerk_limited]


def limits(law: Law, **others: object) -> Limits:
    return Limits(speed=20.0, jerk=1e5 if law is jerk_limited else None, **others)  # type: ignore[arg-type]


@pytest.mark.parametrize("law", LAWS)
def test_a_weight_beyond_the_torque_at_an_end_is_refused_with_its_torque(
    robot: Heli4, path: AdeptCycle, law: Law
) -> None:
    words = r"holding the weight at rest needs a torque at q1 of -6.\d+ N m; expected from -2 to 2"
    with pytest.raises(PathBeyondLimit, match=words) as caught:
        law(robot, path, limits(law, torque=2.0), 1.0)
    assert (caught.value.limit, caught.value.at) == ("torque", path.length)
    slow = time_optimal(robot, path, Limits(speed=20.0), 1.0).stretched(1e8)
    end = motion_of(robot, slow.at(np.array([slow.duration])), 1.0).torque[0]
    assert abs(caught.value.found) == pytest.approx(np.abs(end).max(), rel=1e-6)


@pytest.mark.parametrize("law", [time_optimal, later(jerk_limited)])
def test_a_torque_just_above_the_weight_at_both_ends_is_timed(robot: Heli4, path: AdeptCycle, law: Law) -> None:
    with pytest.raises(PathBeyondLimit) as caught:
        law(robot, path, limits(law, torque=2.0), 1.0)
    assert law(robot, path, limits(law, torque=1.001 * abs(caught.value.found)), 1.0)


def test_a_stall_torque_below_the_weight_is_refused(robot: Heli4, path: AdeptCycle) -> None:
    with pytest.raises(PathBeyondLimit, match="at rest") as caught:
        jerk_limited(robot, path, limits(jerk_limited, stall_torque=2.0, no_load_speed=30.0), 1.0)
    assert caught.value.limit == "stall_torque"


STEEP = RoundedPath(
    Heli4.pose_names, ((0.0, 0.0, -0.85, 0.0), (0.35, 0.0, -0.75, 0.0), (0.35, 0.0, -0.65, 0.0)), (0.05,)
)


@pytest.mark.parametrize("law", LAWS)
def test_where_the_weight_blocks_the_way_pose_waypoint_joint_and_torque_are_named(robot: Heli4, law: Law) -> None:
    with pytest.raises(
        PathBeyondLimit, match="nearest to waypoint 2: holding the weight at rest needs a torque at q1"
    ) as caught:
        law(robot, STEEP, limits(law, torque=6.351), 1.0)
    assert (caught.value.waypoint, caught.value.joint, caught.value.limit) == (2, "q1", "torque")
    pose, rest = np.array(caught.value.pose), np.zeros(4)
    assert STEEP.evaluate(np.array(caught.value.at), 0)[0] == pytest.approx(pose)
    assert inverse_dynamics(robot, 1.0, pose, rest, rest)[0] == pytest.approx(caught.value.found)
    assert abs(caught.value.found) > 6.351


@pytest.mark.parametrize("law", LAWS)
def test_a_joint_beyond_its_range_is_named_where_it_is_furthest(robot: Heli4, path: AdeptCycle, law: Law) -> None:
    joints = robot.inverse(path.evaluate(np.linspace(0.0, path.length, 20_001), 0)[0])
    ranges = np.stack([joints.min(axis=0) - 0.01, joints.max(axis=0) + 0.01], axis=-1)
    assert law(robot, path, limits(law, position=ranges), 1.0)
    ranges[2, 1] -= 0.011
    with pytest.raises(PathBeyondLimit, match=r"s = .*, pose \(.*: the position of q3 is .* rad; expected") as caught:
        law(robot, path, limits(law, position=ranges), 1.0)
    assert caught.value.found == pytest.approx(joints[:, 2].max(), abs=1e-6)
    assert robot.inverse(np.array(caught.value.pose))[2] == pytest.approx(caught.value.found, abs=1e-12)
