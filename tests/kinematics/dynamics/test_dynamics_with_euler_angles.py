"""Leg forces of a hexapod against the energy of its masses, written independently: by numbers, without Jacobians."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from kinematics import GoughStewart, actuator_motion, inverse_dynamics
from kinematics.mathematics.orientation import rotation
from tests.kinematics.numeric import differences, lagrange, slope
from tests.kinematics.weighed import GOUGH_STEWART

G = 9.80665
HEAVY = GoughStewart(inertia=replace(GOUGH_STEWART, screw_lead=0.02, drive=5e-4, rod_mass=1.7, platform_mass=7.0))
ROBOTS = pytest.mark.parametrize("robot", [GoughStewart(inertia=GOUGH_STEWART), HEAVY], ids=["default", "heavy rods"])
SWING = np.array([0.05, 0.06, 0.04, 0.4, 0.35, 0.5])
PACE, PHASE = np.array([3.0, 2.5, 4.1, 3.3, 2.2, 1.7]), np.array([0.3, 1.1, 2.0, 4.0, 5.1, 0.7])
TIMES = np.linspace(0.0, 3.0, 151)


def motion(t):
    angle = np.multiply.outer(t, PACE) + PHASE
    pose = np.array(GoughStewart().home) + SWING * np.sin(angle)
    return pose, SWING * PACE * np.cos(angle), -SWING * PACE**2 * np.sin(angle)


def platform_points(robot, pose):
    ends = robot.geometry.in_tool_frame()
    return pose[..., None, :3] + np.einsum("...ij,kj->...ki", rotation(pose[..., 3:]), ends)


def kinetic(robot, payload, pose, velocity):
    """By complex steps: the derivative of the points and of the legs' lengths, to rounding."""
    i, step = robot.inertia, 1e-30
    moved = platform_points(robot, pose + 1j * step * velocity)
    legs = np.sqrt(((moved - robot.geometry.in_reference_frame()) ** 2).sum(-1))
    ends, rates = moved.imag / step, legs.imag / step
    screws = i.drive * (2 * np.pi / i.screw_lead) ** 2 * (rates**2).sum(-1)
    carried = (i.rod_mass + i.platform_mass / 6) * (ends**2).sum((-1, -2))
    return (screws + carried + payload * (velocity[..., :3] ** 2).sum(-1)) / 2


def potential(robot, payload, pose):
    i = robot.inertia
    heights = platform_points(robot, pose)[..., 2].sum(-1)
    return G * ((i.rod_mass + i.platform_mass / 6) * heights + payload * pose[..., 2])


@ROBOTS
@pytest.mark.parametrize("payload", [0.0, 3.0])
def test_power_of_the_legs_is_the_rate_of_the_energy(robot, payload):
    def energy(t):
        pose, velocity, _ = motion(t)
        return kinetic(robot, payload, pose, velocity) + potential(robot, payload, pose)

    pose, velocity, acceleration = motion(TIMES)
    force = inverse_dynamics(robot, payload, pose, velocity, acceleration)
    power = (force * actuator_motion(robot, pose, velocity, acceleration, np.zeros(6)).first).sum(-1)
    assert np.abs(power - slope(energy, TIMES, 1e-3)).max() < 1e-8 * np.abs(power).max()


@ROBOTS
def test_each_leg_s_force_follows_from_the_energy_by_lagrange(robot):
    """d/dt dT/dv - dT/dx + dV/dx = (dq/dx)^T f, for each of the six coordinates, Euler angles and all."""
    pose, velocity, acceleration = (part[:40] for part in motion(TIMES))
    energies = partial(kinetic, robot, 1.5), partial(potential, robot, 1.5)
    wanted = lagrange(*energies, pose, velocity, acceleration)
    force = inverse_dynamics(robot, 1.5, pose, velocity, acceleration)
    slopes = differences(robot.inverse, pose, 1e-4)
    found = (np.swapaxes(slopes, -1, -2) @ force[..., None])[..., 0]
    assert np.abs(found - wanted).max() < 1e-6 * np.abs(wanted).max()
