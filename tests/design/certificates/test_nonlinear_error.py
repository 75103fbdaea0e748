"""The bound of the true error: no exact forward model exceeds it, and some come close."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from design import Box, InvalidRegion, nonlinear_error
from kinematics import MECHANISMS, Delta, GoughStewart, InvalidValue, Mechanism, Planar3RRR, Redundant3T1R
from kinematics.machine import Structure
from tests.kinematics.margins.test_accuracy import corners, pose_errors

ONE_ROTATION = {name: kind for name, kind in MECHANISMS.items() if name not in ("GoughStewart", "Hexa")}


def point(pose: np.ndarray, robot: Mechanism) -> Box:
    return Box(**dict(zip(robot.pose_names, pose.tolist(), strict=True)))


@pytest.mark.parametrize("kind", ONE_ROTATION.values(), ids=ONE_ROTATION)
def test_no_error_of_the_drives_moves_the_tool_further_and_some_nearly_as_far(kind: type[Mechanism]) -> None:
    rng, robot = np.random.default_rng(8), kind()
    pose, count = robot.home + 0.02 * rng.standard_normal(len(robot.home)), len(robot.joint_names)
    most = robot.inertia.drive_train.position_errors(count)
    beyond = nonlinear_error(robot, point(pose, robot))
    assert beyond is not None
    sides = np.concatenate([corners(count), rng.uniform(-1.0, 1.0, (300, count))])
    shift, turn = pose_errors(robot, pose, most * sides)
    names = ("position_accuracy", "angle_accuracy") if robot.rotations else ("position_accuracy",)
    for name, found, more in zip(names, (shift, turn), (beyond.position, beyond.angle), strict=False):
        bound = robot.margin(name, pose) + more
        assert 0.95 * bound < found.max() <= bound
        assert found.max() > robot.margin(name, pose) - more


@pytest.mark.parametrize(
    ("robot", "half"), [(Delta(), 0.1), (Planar3RRR(), 0.05), (Redundant3T1R(), 0.03)], ids=lambda v: type(v).__name__
)
def test_it_holds_for_large_errors_at_every_pose_of_a_region(robot: Mechanism, half: float) -> None:
    rng, count, train = np.random.default_rng(9), len(robot.joint_names), robot.inertia.drive_train
    coarse = replace(train, encoder_resolution=30.0 * np.max(train.encoder_resolution))
    robot = robot.with_inertia(replace(robot.inertia, drive_train=coarse))
    home = np.array(robot.home)
    region = Box(**{n: (v - half, v + half) for n, v in zip(robot.pose_names, home.tolist(), strict=True)})
    beyond = nonlinear_error(robot, region, share=0.2)
    assert beyond is not None
    assert beyond.boxes > 1
    used = 0.0
    for pose in home + half * rng.uniform(-1.0, 1.0, (12, len(home))):
        shift, _ = pose_errors(robot, pose, coarse.position_errors(count) * corners(count))
        first = robot.margin("position_accuracy", pose)
        assert shift.max() <= first + beyond.position
        used = max(used, (shift.max() - first) / beyond.position)
    assert used > 0.0  # the first order alone is no bound


def test_errors_too_large_for_a_bound_are_not_bounded() -> None:
    robot = Delta()
    rough = replace(robot.inertia.drive_train, encoder_resolution=0.7)
    robot = robot.with_inertia(replace(robot.inertia, drive_train=rough))
    assert nonlinear_error(robot, point(robot.home, robot)) is None


def test_it_is_not_bounded_where_a_limb_cannot_reach_or_the_robot_is_singular() -> None:
    robot = Delta()
    far = Box(x=(0.0, 2.0), y=0.0, z=float(robot.home[2]))
    assert nonlinear_error(robot, far, most_boxes=3000) is None


def test_what_it_cannot_answer_is_named() -> None:
    hexapod, delta = GoughStewart(), Delta()
    with pytest.raises(InvalidValue, match="GoughStewart pose: found Euler angles"):
        nonlinear_error(hexapod, point(hexapod.home, hexapod))
    with pytest.raises(InvalidValue, match="joint_play: found 1e-06; expected 0"):
        nonlinear_error(delta.with_structure(Structure(joint_play=1e-6)), point(delta.home, delta))
    with pytest.raises(InvalidRegion):
        nonlinear_error(delta, Box(x=0.0, y=0.0))
