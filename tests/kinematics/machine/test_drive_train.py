"""Gears, motors and friction behind the actuators; rods with mass at their middle."""

import math

import numpy as np
import pytest

from kinematics import MECHANISMS, DriveTrain, GoughStewart, Heli4, InvalidValue, inverse_dynamics
from kinematics.dynamics.actuators import to_actuators
from kinematics.machine.bodies import UNIFORM, Bodies, Rod
from kinematics.robots.heli4.bodies import Heli4Inertia

EACH = pytest.mark.parametrize("kind", MECHANISMS.values(), ids=lambda kind: kind.__name__)
REST = np.zeros(4)


def with_drives(kind, **drives):
    return kind(inertia=kind.Inertia(drive_train=DriveTrain(**drives)))


@EACH
def test_friction_takes_the_power_that_it_turns_into_heat(kind):
    """Over the bare robot: f . v = sum coulomb |v| + viscous v^2 at the actuators."""
    rng, n = np.random.default_rng(1), len(kind.pose_names)
    pose = np.array(kind().home) + rng.uniform(-0.02, 0.02, (10, n))
    rates, none = rng.normal(size=(10, n)), np.zeros((10, n))
    bare, rough = kind(), with_drives(kind, coulomb=3.0, viscous=0.7)
    added = inverse_dynamics(rough, 0.0, pose, rates, none) - inverse_dynamics(bare, 0.0, pose, rates, none)
    step = 1e-5
    ends = [bare.inverse(pose + side * step * rates) for side in (1, -1)]
    actuators = to_actuators(bare, (ends[0] - ends[1]) / (2 * step))
    heat = (3.0 * np.abs(actuators) + 0.7 * actuators**2).sum(axis=-1)
    np.testing.assert_allclose((added * actuators).sum(axis=-1), heat, rtol=1e-6)


@EACH
def test_a_motor_behind_a_gear_is_felt_by_the_square_of_its_ratio(kind):
    """From rest, the motors' inertia torque over that of the gear's output."""
    rng, n = np.random.default_rng(2), len(kind.pose_names)
    pose, none = np.array(kind().home) + rng.uniform(-0.02, 0.02, (10, n)), np.zeros((10, n))
    acceleration = rng.normal(size=(10, n))
    direct = inverse_dynamics(with_drives(kind, motor_inertia=1e-3), 0.0, pose, none, acceleration)
    geared = inverse_dynamics(with_drives(kind, motor_inertia=1e-3, gear_ratio=9.0), 0.0, pose, none, acceleration)
    bare = inverse_dynamics(kind(), 0.0, pose, none, acceleration)
    assert np.abs(direct - bare).max() > 0
    np.testing.assert_allclose(geared - bare, 81 * (direct - bare), rtol=1e-6, atol=1e-10)


def test_a_drive_at_rest_bears_no_friction():
    args = (1.0, Heli4().home, REST, np.array([0.0, 0.0, 10.0, 0.0]))
    rough = with_drives(Heli4, coulomb=5.0, viscous=1.0)
    at_rest = inverse_dynamics(Heli4(), *args)
    np.testing.assert_allclose(inverse_dynamics(rough, *args), at_rest, rtol=1e-14)  # two programs, rounded apart


def test_each_actuator_may_have_a_drive_of_its_own():
    pose, velocity = np.array([0.1, 0.05, -0.7, 0.3]), np.array([1.0, 2.0, 0.5, 3.0])
    own = (1.0, 0.0, 3.0, 0.0)
    rough = with_drives(Heli4, coulomb=own)
    added = inverse_dynamics(rough, 0.0, pose, velocity, REST) - inverse_dynamics(Heli4(), 0.0, pose, velocity, REST)
    np.testing.assert_allclose(np.abs(added), own, atol=1e-12)


def test_three_particles_are_a_uniform_rod():
    """Its mass, first and second moments, along any line."""
    start, end = np.array([0.3, -0.2, 1.0]), np.array([-0.5, 0.4, 0.1])
    bodies = Bodies(rods=[Rod(1.7, UNIFORM, ("a", "b"), start, end)])
    parts = bodies.all_particles()
    along = np.polynomial.legendre.leggauss(8)
    points = start + np.outer((along[0] + 1) / 2, end - start)
    masses, places = 1.7 * along[1] / 2, np.array([p.point for p in parts])
    shares = np.array([p.mass for p in parts])
    assert shares.sum() == pytest.approx(1.7, rel=1e-14)
    np.testing.assert_allclose(shares @ places, masses @ points, rtol=1e-13)
    np.testing.assert_allclose((places.T * shares) @ places, (points.T * masses) @ points, rtol=1e-13)


@EACH
def test_rods_of_any_kind_weigh_the_same_at_rest(kind):
    """The weight of a rod acts at its middle however it is spread; a rod's inertia shows in motion only."""
    n = len(kind.pose_names)
    uniform = kind(inertia=kind.Inertia(rod_middle=UNIFORM))
    pose, none = np.array(kind().home) + 0.01, np.zeros(n)
    split = kind(inertia=kind.Inertia(rod_middle=0.0))
    at_rest = [inverse_dynamics(robot, 1.0, pose, none, none) for robot in (split, uniform)]
    np.testing.assert_allclose(*at_rest, rtol=1e-9, atol=1e-9)
    moving = [inverse_dynamics(robot, 1.0, pose, none, none + 5.0) for robot in (split, uniform)]
    assert (np.abs(np.subtract(*moving)).max() > 1e-3) == (kind.__name__ not in ("GoughStewart", "Planar3RPR"))


@pytest.mark.parametrize("field", ["gear_ratio", "motor_inertia", "coulomb", "viscous"])
@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf, "2", (1.0, -2.0)])
def test_impossible_drives_are_named(field, value):
    with pytest.raises(InvalidValue, match=f"DriveTrain {field}"):
        DriveTrain(**{field: value})


def test_other_impossible_inertias_are_named():
    with pytest.raises(InvalidValue, match="DriveTrain gear_ratio: found 0"):
        DriveTrain(gear_ratio=0.0)
    with pytest.raises(InvalidValue, match=r"DriveTrain coulomb: .* one number, or 4: one for each actuator"):
        with_drives(Heli4, coulomb=(1.0, 2.0, 3.0))
    with pytest.raises(InvalidValue, match=r"Heli4Inertia rod_middle: found 1.1"):
        Heli4Inertia(rod_middle=1.1)
    with pytest.raises(InvalidValue, match="Heli4Inertia arm_mass: found -1"):
        Heli4Inertia(arm_mass=-1)
    for value in (math.nan, "0.9", True, (0.9, 0.9)):
        with pytest.raises(InvalidValue, match="Heli4Inertia arm_mass: found"):
            Heli4Inertia(arm_mass=value)
    with pytest.raises(InvalidValue, match=r"Heli4Inertia plate_masses: .* 2 numbers, finite and >= 0"):
        Heli4Inertia(plate_masses=0.5)
    with pytest.raises(InvalidValue, match=r"screw_lead: found 0.0; expected > 0"):
        GoughStewart.Inertia(screw_lead=0)
    with pytest.raises(InvalidValue, match="Heli4Inertia drive_train: found None"):
        Heli4Inertia(drive_train=None)
    with pytest.raises(InvalidValue, match=r"Heli4 inertia: .*expected a Heli4Inertia"):
        Heli4(inertia=GoughStewart.Inertia())
