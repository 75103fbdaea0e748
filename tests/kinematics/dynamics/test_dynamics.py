"""Torques against the energy of the moving masses, written independently of the model's bodies."""

from functools import partial

import numpy as np
import pytest

from kinematics import Heli4, InvalidShape, inverse_dynamics
from kinematics.robots.heli4.bodies import Heli4Inertia
from tests.kinematics.by_hand import OBLIQUE, ByHand, cylinder
from tests.kinematics.dynamics.test_motion import TIMES, pose_and_derivatives
from tests.kinematics.numeric import differences, lagrange, slope
from tests.kinematics.weighed import HELI4

G = 9.80665
HEAVY = Heli4Inertia(
    drive=0.02, arm_mass=1.3, arm_centre=0.55, arm_factor=1.4, rod_mass=0.4, rod_middle=0.0, plate_masses=(0.7, 0.3)
)
ROBOTS = pytest.mark.parametrize(
    "robot", [Heli4(inertia=HELI4), Heli4(OBLIQUE, HEAVY)], ids=["prototype", "oblique and heavy"]
)


def potential(robot, payload, pose):
    """Weights times heights; half of each pair of rods hangs on the arm, half on the plate."""
    g, i, hand = robot.geometry, robot.inertia, ByHand(robot.geometry)
    q, pose = robot.inverse(pose), np.asarray(pose)
    arms = (i.arm_mass * i.arm_centre + i.rod_mass / 2) * g.arm_length * np.cos(q).sum(-1)
    lower = (i.plate_masses[0] + payload + i.rod_mass) * pose[..., 2]
    upper = (i.plate_masses[1] + i.rod_mass) * (pose[..., 2] + hand.pitch * pose[..., 3])
    return G * (arms + lower + upper)


def kinetic(robot, payload, pose, velocity):
    g, i, hand = robot.geometry, robot.inertia, ByHand(robot.geometry)
    rates = (robot.inverse_jacobian(pose) @ velocity[..., None])[..., 0]
    swing = i.drive + i.arm_factor * i.arm_mass * (i.arm_centre * g.arm_length) ** 2
    swing += i.rod_mass / 2 * g.arm_length**2
    flat = (velocity[..., :2] ** 2).sum(-1)
    lower = (i.plate_masses[0] + payload + i.rod_mass) * (flat + velocity[..., 2] ** 2)
    upper = (i.plate_masses[1] + i.rod_mass) * (flat + (velocity[..., 2] + hand.pitch * velocity[..., 3]) ** 2)
    return (swing * (rates**2).sum(-1) + lower + upper + i.tool * velocity[..., 3] ** 2) / 2


@ROBOTS
@pytest.mark.parametrize("payload", [0.0, 2.0])
def test_power_of_the_drives_is_the_rate_of_the_energy(robot, payload):
    def energy(t):
        pose, velocity = pose_and_derivatives(t)[:2]
        return kinetic(robot, payload, pose, velocity) + potential(robot, payload, pose)

    pose, velocity, acceleration = pose_and_derivatives(TIMES)[:3]
    torque = inverse_dynamics(robot, payload, pose, velocity, acceleration)
    rates = (robot.inverse_jacobian(pose) @ velocity[..., None])[..., 0]
    power = (torque * rates).sum(-1)
    assert np.abs(power - slope(energy, TIMES, 1e-3)).max() < 1e-8 * np.abs(power).max()


@ROBOTS
def test_each_torque_follows_from_the_energy_by_lagrange(robot):
    """d/dt dT/dv - dT/dx + dV/dx = J_m^T tau, component by component."""
    pose, velocity, acceleration = (part[:50] for part in pose_and_derivatives(TIMES)[:3])
    energies = partial(kinetic, robot, 1.5), partial(potential, robot, 1.5)
    force = lagrange(*energies, pose, velocity, acceleration)
    torque = inverse_dynamics(robot, 1.5, pose, velocity, acceleration)
    found = (np.swapaxes(robot.inverse_jacobian(pose), -1, -2) @ torque[..., None])[..., 0]
    assert np.abs(found - force).max() < 1e-6 * np.abs(force).max()


@ROBOTS
def test_at_rest_virtual_work_balances_the_weights(robot):
    poses = cylinder(500, seed=1, radius=0.3)
    torque = inverse_dynamics(robot, 1.0, poses, np.zeros(4), np.zeros(4))
    slope = differences(lambda x: potential(robot, 1.0, x), poses, 1e-3)
    found = (np.swapaxes(robot.inverse_jacobian(poses), -1, -2) @ torque[..., None])[..., 0]
    assert np.abs(found - slope).max() < 1e-8


def test_a_heavier_payload_takes_more_torque_in_proportion():
    """At home, braking a fall or lifting: each drive works harder with each kilogram, by as much each time."""
    still = np.zeros(4)
    for acceleration in ([0, 0, 0, 0], [0, 0, 30.0, 0], [0, 0, -5.0, 0]):
        torques = np.array(
            [inverse_dynamics(Heli4(), m, Heli4().home, still, acceleration) for m in (0.0, 1.0, 2.0, 3.0)]
        )
        steps = np.diff(np.abs(torques).sum(-1))
        assert (steps > 0).all()
        assert np.ptp(np.diff(torques, axis=0), axis=0).max() < 1e-12


def test_free_fall_of_the_payload_takes_no_torque_for_it():
    pose, still = np.array(Heli4().home), np.zeros(4)
    falling = np.array([0, 0, -G, 0])
    empty, full = (inverse_dynamics(Heli4(), m, pose, still, falling) for m in (0.0, 5.0))
    assert np.abs(full - empty).max() < 1e-12


def test_shapes_broadcast_and_out_of_reach_is_nan():
    poses = np.array([[Heli4().home, [2.0, 0.0, -0.7, 0.0]]] * 3)
    torque = inverse_dynamics(Heli4(), 0.0, poses, np.zeros(4), np.zeros((2, 4)))
    assert torque.shape == (3, 2, 4)
    assert np.isnan(torque).all(-1).tolist() == [[False, True]] * 3


def test_the_argument_of_the_wrong_length_is_named():
    with pytest.raises(InvalidShape, match=r"velocity: found an array of shape \(1,\)"):
        inverse_dynamics(Heli4(), 0.0, Heli4().home, [0.0], np.zeros(4))
