"""FVI, isotropic speed and force and the condition number, against linear programs and singular values."""

from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from kinematics import FviBounds, Heli4, InvalidValue, kind_of
from tests.kinematics.by_hand import OBLIQUE, cylinder

BOTH = pytest.mark.parametrize("robot", [Heli4(), Heli4(OBLIQUE)], ids=["prototype", "oblique"])
BOUNDS = FviBounds(joint_speed=13.0, joint_effort=80.0, speed=2.0, force=90.0)


def largest_ball(rows):
    """Radius of the largest ball, wherever its centre, in |rows @ t| <= 1."""
    n = rows.shape[1]
    sides = np.vstack([rows, -rows])
    norms = np.linalg.norm(sides, axis=1, keepdims=True)
    best = linprog([0.0] * n + [-1.0], np.hstack([sides, norms]), np.ones(len(sides)), bounds=[(None, None)] * (n + 1))
    return best.x[-1]


def homogeneous(robot, poses, length=None):
    j_m = robot.inverse_jacobian(poses).copy()
    j_m[..., 3] /= length or robot.characteristic_length
    return j_m


@BOTH
def test_isotropic_speed_and_force_are_radii_of_largest_balls(robot):
    poses = cylinder(60, seed=1, radius=0.3)
    speeds, forces = robot.isotropic(poses)
    for j_mw, speed, force in zip(homogeneous(robot, poses), speeds, forces, strict=True):
        assert abs(speed - largest_ball(j_mw)) < 1e-9 * speed
        # A force f asks the actuators for tau with J_m^T tau = f, least in norm.
        assert abs(force - largest_ball(np.linalg.pinv(j_mw.T))) < 1e-7 * force


@BOTH
def test_fvi_is_the_smaller_of_both_over_their_bounds_everywhere(robot):
    poses = cylinder(20_000, seed=2, radius=0.3)
    j_mw = homogeneous(robot, poses)
    speed = BOUNDS.joint_speed / np.linalg.norm(j_mw, axis=-1).max(-1)
    force = BOUNDS.joint_effort / np.linalg.norm(np.linalg.pinv(np.swapaxes(j_mw, -1, -2)), axis=-1).max(-1)
    expected = np.minimum(speed / BOUNDS.speed, force / BOUNDS.force)
    assert np.abs(robot.fvi(poses, BOUNDS) / expected - 1).max() < 1e-9


def test_no_direction_is_slower_than_the_isotropic_speed():
    robot, rng = Heli4(), np.random.default_rng(3)
    poses = cylinder(50, seed=3)
    directions = rng.normal(size=(30_000, 4))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    for j_mw, speed in zip(homogeneous(robot, poses), robot.isotropic(poses)[0], strict=True):
        reached = 1 / np.abs(directions @ j_mw.T).max(axis=1)
        assert speed <= reached.min() <= 1.2 * speed


@BOTH
def test_condition_number_is_the_ratio_of_singular_values(robot):
    poses = cylinder(2_000, seed=4, radius=0.3).reshape(20, 100, 4)
    values = np.linalg.svd(homogeneous(robot, poses), compute_uv=False)
    assert np.abs(robot.condition_number(poses) * values[..., -1] / values[..., 0] - 1).max() < 1e-9


@BOTH
def test_a_given_characteristic_length_replaces_the_screws(robot):
    poses = cylinder(100, seed=5, radius=0.3)
    assert robot.characteristic_length == abs(robot.geometry.pitch) / (2 * np.pi)
    values = np.linalg.svd(homogeneous(robot, poses, 0.2), compute_uv=False)
    assert np.abs(robot.condition_number(poses, 0.2) * values[..., -1] / values[..., 0] - 1).max() < 1e-9
    norms = np.linalg.norm(homogeneous(robot, poses, 0.2), axis=-1)
    assert np.abs(robot.isotropic(poses, 0.2)[0] * norms.max(-1) - 1).max() < 1e-12


LENGTHS = [f.name for f in fields(OBLIQUE) if kind_of(f).dimension != "angle"]


@given(st.floats(0.05, 20.0), st.integers(0, 2**31))
@settings(max_examples=10, deadline=None)
def test_fvi_does_not_know_the_unit_of_length(scale, seed):
    """A robot twice as large asked for twice the speed and half the force is as good as before."""
    poses = cylinder(20, seed, radius=0.3)
    small = Heli4(OBLIQUE)
    large = Heli4(replace(OBLIQUE, **{name: scale * getattr(OBLIQUE, name) for name in LENGTHS}))
    bounds = replace(BOUNDS, speed=scale * BOUNDS.speed, force=BOUNDS.force / scale)
    found = large.fvi(poses * [scale, scale, scale, 1.0], bounds)
    assert np.abs(found / small.fvi(poses, BOUNDS) - 1).max() < 1e-9


@pytest.mark.parametrize("index", ["fvi", "condition_number", "internal_determinant"])
def test_half_a_turn_of_the_prototype_changes_nothing(index):
    poses = cylinder(10_000, seed=6)
    function = getattr(Heli4(), index)
    assert np.abs(function(poses * [-1, -1, 1, 1]) / function(poses) - 1).max() < 1e-8


def test_half_a_turn_exchanges_the_limbs_of_a_pair():
    poses = cylinder(10_000, seed=7)
    joints = Heli4().inverse(poses)
    assert np.abs(Heli4().inverse(poses * [-1, -1, 1, 1]) - joints[:, [1, 0, 3, 2]]).max() < 1e-14


def test_no_force_on_a_parallel_singularity():
    robot = Heli4(Heli4.Geometry(azimuths=(0.0, np.pi / 2, np.pi, 3 * np.pi / 2)))
    assert robot.isotropic(robot.home)[1] < 1e-12
    assert robot.condition_number(robot.home) > 1e12


def test_out_of_reach_is_nan():
    poses = np.array([Heli4().home, [2.0, 0.0, -0.7, 0.0]])
    for values in (Heli4().fvi(poses), Heli4().condition_number(poses), *Heli4().isotropic(poses)):
        assert np.isnan(values).tolist() == [False, True]


@pytest.mark.parametrize("length", [0.0, -0.1, np.nan, np.inf])
def test_a_characteristic_length_is_a_length(length):
    with pytest.raises(InvalidValue, match="characteristic_length"):
        Heli4().fvi(Heli4().home, characteristic_length=length)


def test_an_unknown_margin_is_named_with_those_there_are():
    with pytest.raises(InvalidValue, match=f"speed.*{', '.join(Heli4.margins)}"):
        Heli4().margin("speed", Heli4().home)
