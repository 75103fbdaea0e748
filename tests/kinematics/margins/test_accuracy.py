"""Accuracy: against the exact forward model, closed forms, linear programs and other sizes."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

from design import Cylinder, worst_poses
from kinematics import (
    MECHANISMS,
    Delta,
    DriveTrain,
    GoughStewart,
    Heli4,
    InvalidValue,
    Mechanism,
    Peppermill,
    Planar3PRR,
    Redundant3T1R,
    from_actuators,
    largest_errors,
    to_actuators,
)
from kinematics.machine import Structure
from kinematics.mathematics.orientation import rotation
from tests.design.scaled import scaled

SMALL = 1e-3  # of a usual encoder's step, so that only the first order counts


def with_errors(kind: type[Mechanism], factor: float = 1.0, **drives: Any) -> Mechanism:
    robot = kind()
    train = robot.inertia.drive_train
    given = drives or {"encoder_resolution": factor * np.max(train.encoder_resolution)}
    return robot.with_inertia(replace(robot.inertia, drive_train=replace(train, **given)))


def pose_errors(robot: Mechanism, pose: np.ndarray, actuator_errors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(k,) distances and (k,) angles between a pose and those that the exact forward model gives for (k, m) errors."""
    joints = from_actuators(robot, to_actuators(robot, robot.inverse(pose)) + actuator_errors)
    if isinstance(robot, Redundant3T1R):
        found = robot.forward_least_squares(joints, np.broadcast_to(pose, (len(joints), len(pose)))).pose
    else:
        found = robot.forward(joints, near=pose)
    assert np.isfinite(found).all()
    lengths = [k for k in range(len(pose)) if k not in robot.rotations]
    shift = np.linalg.norm((found - pose)[:, lengths], axis=1)
    if len(robot.rotations) < 2:
        return shift, np.abs(found - pose)[:, list(robot.rotations)].max(axis=1, initial=0.0)
    chord = np.linalg.norm(rotation(found[:, 3:]) - rotation(pose[3:]), axis=(1, 2)) / np.sqrt(2)
    return shift, 2 * np.arcsin(chord / 2)


def corners(count: int) -> np.ndarray:
    return np.array(list(product((1.0, -1.0), repeat=count)))


@pytest.mark.parametrize("kind", MECHANISMS.values(), ids=MECHANISMS)
def test_it_is_the_largest_error_that_the_exact_forward_model_finds(kind: type[Mechanism]) -> None:
    rng, robot = np.random.default_rng(5), with_errors(kind, 0.1)
    pose, count = robot.home + 0.02 * rng.standard_normal(len(robot.home)), len(robot.joint_names)
    most = robot.inertia.drive_train.position_errors(count)
    angle = "angle_accuracy" in robot.margins
    bounds = robot.margin("position_accuracy", pose), robot.margin("angle_accuracy", pose) if angle else 0.0
    inside = pose_errors(robot, pose, most * rng.uniform(-1.0, 1.0, (200, count)))
    at_corners = pose_errors(robot, pose, most * corners(count))
    for bound, within, largest in zip(bounds, inside, at_corners, strict=True):
        assert within.max() <= bound * (1 + 1e-3)
        assert largest.max() == pytest.approx(bound, rel=1e-3)


def test_a_ten_thousandth_of_a_radian_at_every_encoder_turns_heli4s_tool_by_about_a_degree() -> None:
    robot = with_errors(Heli4, encoder_resolution=1e-4)
    at_zero = Cylinder(0.5, z=(-0.8, -0.6), theta=(0.0, 0.0))
    assert np.degrees(worst_poses(robot, at_zero, "angle_accuracy", about=2000).value) == pytest.approx(1.017, abs=1e-3)
    anywhere = Cylinder(0.5, z=(-0.8, -0.6), theta=(-np.pi, np.pi))
    found = np.degrees(worst_poses(robot, anywhere, "angle_accuracy", about=2000).value)
    assert found == pytest.approx(1.055, abs=1e-3)


def test_three_legs_along_the_platforms_tangents_have_a_closed_form() -> None:
    radius, step = 0.2, 1e-5
    azimuths = 2 * np.pi / 3 * np.arange(3)
    ends = radius * np.column_stack([np.cos(azimuths), np.sin(azimuths)])
    along = np.column_stack([-np.sin(azimuths), np.cos(azimuths)])
    geometry = Planar3PRR.Geometry(
        base_points=tuple(map(tuple, (ends - 0.8 * along).tolist())),
        platform_points=tuple(map(tuple, ends.tolist())),
        rod_lengths=(0.5, 0.5, 0.5),
        rail_angles=tuple((azimuths + np.pi / 2).tolist()),
    )
    drives = DriveTrain(encoder_resolution=step)
    robot = Planar3PRR(geometry, Planar3PRR.Inertia(drive_train=drives), home=(0.0, 0.0, 0.0))
    assert robot.margin("position_accuracy", np.zeros(3)) == pytest.approx(4 / 3 * step, rel=1e-12)
    assert robot.margin("angle_accuracy", np.zeros(3)) == pytest.approx(step / radius, rel=1e-12)


def cubic() -> GoughStewart:
    """Three pairs of parallel legs, along x, y and z, a distance of 0.4 m apart."""
    long, half = 1.0, 0.2
    ends = np.array([[0, half, 0], [0, -half, 0], [0, 0, half], [0, 0, -half], [half, 0, 0], [-half, 0, 0]])
    base = ends - long * np.repeat(np.eye(3), 2, axis=0)
    points = (tuple(map(tuple, rows.tolist())) for rows in (base, ends))
    geometry = GoughStewart.Geometry(**dict(zip(("base_points", "platform_points"), points, strict=True)))
    drives = DriveTrain(encoder_resolution=1e-6, backlash=2e-6)
    return GoughStewart(geometry, GoughStewart.Inertia(drive_train=drives), home=(0.0,) * 6)


def test_six_legs_in_three_parallel_pairs_have_a_closed_form() -> None:
    robot, step = cubic(), 2e-6  # a step of the encoder and half of the backlash
    assert robot.margin("position_accuracy", np.zeros(6)) == pytest.approx(np.sqrt(3) * step, rel=1e-12)
    assert robot.margin("angle_accuracy", np.zeros(6)) == pytest.approx(np.sqrt(3) * step / 0.2, rel=1e-12)


def test_play_at_both_ends_of_a_leg_is_an_error_of_its_length() -> None:
    robot = cubic().with_structure(Structure(joint_play=3e-6))
    assert robot.margin("position_accuracy", np.zeros(6)) == pytest.approx(np.sqrt(3) * 5e-6, rel=1e-12)


@pytest.mark.parametrize(("kind", "lengths"), [(Planar3PRR, "rod_lengths"), (Peppermill, "distal_lengths")])
def test_play_and_steps_together_are_what_rods_of_other_lengths_do(kind: type[Mechanism], lengths: str) -> None:
    play, robot = 1e-7, with_errors(kind, SMALL)
    robot = robot.with_structure(Structure(joint_play=play))
    pose, count = robot.home + 0.01 * np.arange(1, len(robot.home) + 1), len(robot.joint_names)
    actuators = to_actuators(robot, robot.inverse(pose))
    steps = robot.inertia.drive_train.position_errors(count) * corners(count)
    nominal = np.array(getattr(robot.geometry, lengths))
    found = []
    for signs in corners(len(nominal)):
        other = replace(robot.geometry, **{lengths: tuple((nominal + play * signs).tolist())})
        found.append(robot.with_geometry(other).forward(from_actuators(robot, actuators + steps), near=pose) - pose)
    errors = np.concatenate(found)
    turn = robot.rotations[0]
    lines = [k for k in range(len(pose)) if k != turn]
    assert np.abs(errors[:, turn]).max() == pytest.approx(robot.margin("angle_accuracy", pose), rel=1e-4)
    largest = np.linalg.norm(errors[:, lines], axis=1).max()
    assert largest == pytest.approx(robot.margin("position_accuracy", pose), rel=1e-4)


def test_each_actuator_has_its_own_error() -> None:
    robot = with_errors(Delta, encoder_resolution=(1e-7, 2e-7, 4e-7))
    pose = np.array([0.05, -0.1, -0.7])
    matrix = np.linalg.inv(robot.inverse_jacobian(pose)) @ np.diag([1e-7, 2e-7, 4e-7])
    expected = np.linalg.norm(matrix @ corners(3).T, axis=0).max()
    assert robot.margin("position_accuracy", pose) == pytest.approx(expected, rel=1e-10)


def test_no_error_at_the_drives_is_no_error_at_the_tool() -> None:
    robot = with_errors(Heli4, encoder_resolution=0.0)
    assert robot.margin("position_accuracy", robot.home) == robot.margin("angle_accuracy", robot.home) == 0.0


@pytest.mark.parametrize("kind", MECHANISMS.values(), ids=MECHANISMS)
def test_twice_as_large_a_robot_errs_twice_as_far_by_the_same_angle(kind: type[Mechanism]) -> None:
    robot = kind()
    pose = robot.home + 0.01 * np.arange(1, len(robot.home) + 1)
    larger, factors = scaled(robot, 2.0), np.where(np.isin(np.arange(len(pose)), robot.rotations), 1.0, 2.0)
    expected = 2.0 * robot.margin("position_accuracy", pose)
    np.testing.assert_allclose(larger.margin("position_accuracy", factors * pose), expected, rtol=1e-9)
    if robot.rotations:
        expected = robot.margin("angle_accuracy", pose)
        np.testing.assert_allclose(larger.margin("angle_accuracy", factors * pose), expected, rtol=1e-9)


def test_the_errors_of_least_norm_are_those_that_linear_programs_find() -> None:
    robot, rng = Redundant3T1R(), np.random.default_rng(6)
    poses = robot.home + rng.uniform(-0.3, 0.3, (2, 4))
    step = robot.inertia.drive_train.position_errors(6)
    position, angle = largest_errors(robot, poses, "minimum_norm")
    for pose, shift, turn in zip(poses, position, angle, strict=True):
        jacobian = robot.inverse_jacobian(pose)
        rows, sides = np.vstack([jacobian, -jacobian]), np.concatenate([step, step])

        def most(along: np.ndarray, rows: np.ndarray = rows, sides: np.ndarray = sides) -> float:
            scale = 1e-6
            return -scale * float(linprog(-along, rows, sides / scale, bounds=(None, None)).fun)

        assert turn == pytest.approx(most(np.eye(4)[3]), rel=1e-7)
        ways = rng.standard_normal((150, 3))
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        spread = max(most(np.append(way, 0.0)) for way in ways)
        assert 0.95 * shift <= spread <= shift * (1 + 1e-9)


def test_the_best_fit_errs_as_linear_programs_say_and_no_less_than_errors_of_least_norm() -> None:
    robot, rng = Redundant3T1R(), np.random.default_rng(7)
    poses = robot.home + rng.uniform(-0.3, 0.3, (20, 4))
    step = robot.inertia.drive_train.position_errors(6)
    position, angle = largest_errors(robot, poses)
    least = largest_errors(robot, poses, "minimum_norm")
    np.testing.assert_allclose(angle, np.abs(np.linalg.pinv(robot.inverse_jacobian(poses))[:, 3]) @ step, rtol=1e-9)
    np.testing.assert_array_equal(position, robot.margin("position_accuracy", poses))
    assert (least[0] <= position * (1 + 1e-9)).all()
    assert (least[1] <= angle * (1 + 1e-9)).all()
    assert (least[0] < 0.99 * position).any()
    assert (least[1] < 0.99 * angle).any()


def test_an_unknown_method_is_named() -> None:
    with pytest.raises(InvalidValue, match="found minimum; expected least_squares or minimum_norm"):
        largest_errors(Delta(), Delta().home, "minimum")  # type: ignore[arg-type]
