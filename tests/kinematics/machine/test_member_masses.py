"""Masses that follow from the members, against integrals over their sections and against the reference's numbers."""

from dataclasses import fields, replace

import casadi as ca
import numpy as np
import pytest

from kinematics import Delta, Heli4, Redundant3T1R, inverse_dynamics
from kinematics.machine import MATERIALS, Tube
from kinematics.robots.registry import MECHANISMS

LUMPS = ("hub", "joint", "fittings", "fittings_inertia", "mass", "tool", "drive", "motor", "carriage", "bars_inertia")
GIVEN = ("rod_mass", "link_mass", "arm_mass", "distal_mass", "proximal_mass", "plate_mass")  # None by default
NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)
NODES, WEIGHTS = (NODES + 1) / 2, WEIGHTS / 2


def bare(kind):
    """The robot without anything but its members; legs that change their length weigh nothing."""
    own = kind.Inertia()
    empty = {}
    for f in fields(own):
        value = getattr(own, f.name)
        if value is not None and f.name.endswith(LUMPS):
            empty[f.name] = tuple(0.0 for _ in value) if isinstance(value, tuple) else 0.0
    if kind.__name__ == "GoughStewart":
        empty["rod_mass"] = 0.0
    if kind.__name__ == "Planar3RPR":
        empty["link_mass"] = 0.0
    return kind(inertia=replace(own, **empty))


def energy_of_members(robot, pose, velocity):
    """By quadrature along each tube, and over the triangles of each plate about its middle."""
    model = robot.model()
    weightless = {"GoughStewart": "leg", "Planar3RPR": "link", "Peppermill": "screw", "Par4": ""}
    total = 0.0
    for member in robot.members(model.pose, model.joints, model.g):
        if member.material == weightless.get(type(robot).__name__) or member.name == "bars":
            continue
        density = getattr(robot.structure, member.material).density
        for shape in member.shapes:
            corners = ca.horzcat(shape.start, shape.end) if isinstance(shape, Tube) else shape.outline
            extent = ca.vertcat(shape.radius, shape.wall) if isinstance(shape, Tube) else shape.thickness
            at = ca.Function("at", [model.pose, model.geometry], [model.at_pose(corners), extent])
            place = [np.array(at(pose + s * 1e-5 * velocity, robot.geometry.vector())[0]) for s in (-1, 0, 1)]
            sizes = np.array(at(pose, robot.geometry.vector())[1]).ravel()
            rates = (place[2] - place[0]) / 2e-5
            if isinstance(shape, Tube):
                outer, inner = sizes[0], sizes[0] - sizes[1]
                mass = density * np.pi * (outer**2 - inner**2) * np.linalg.norm(place[1][:, 1] - place[1][:, 0])
                speeds = rates[:, [0]] * (1 - NODES) + rates[:, [1]] * NODES
                total += mass / 2 * WEIGHTS @ (speeds**2).sum(axis=0)
                continue
            middle, slow = place[1].mean(axis=1), rates.mean(axis=1)
            for i in range(place[1].shape[1]):
                j = (i + 1) % place[1].shape[1]
                sides = place[1][:, i] - middle, place[1][:, j] - middle
                mass = density * sizes[0] * np.linalg.norm(np.cross(*sides)) / 2
                for u, first in zip(NODES, WEIGHTS, strict=True):  # collapsed coordinates of a triangle
                    for v, second in zip(NODES, WEIGHTS, strict=True):
                        speed = (1 - u) * slow + u * ((1 - v) * rates[:, i] + v * rates[:, j])
                        total += mass * u * first * second * speed @ speed
    return total


def energy_of_drives(robot, pose, velocity):
    """Half of what the drives' torque gains when the acceleration is the velocity: v^T M v / 2."""
    still = np.zeros_like(velocity)
    pushed, held = (inverse_dynamics(robot, 0.0, pose, still, a) for a in (velocity, still))
    return (pushed - held) @ robot.actuator_jacobian(pose) @ twist(robot, pose, velocity) / 2


def twist(robot, pose, velocity):
    return np.linalg.solve(robot.pose_rates(pose), velocity)


@pytest.mark.parametrize("kind", list(MECHANISMS.values()), ids=list(MECHANISMS))
def test_the_energy_of_the_masses_is_that_of_the_members_by_quadrature(kind):
    robot, rng = bare(kind), np.random.default_rng(3)
    for _ in range(3):
        units = np.array([0.05 if name in "xyz" else 0.2 for name in robot.pose_names])
        pose = robot.home + rng.uniform(-1, 1, len(units)) * units
        velocity = rng.normal(size=len(units))
        members = energy_of_members(robot, pose, velocity)
        assert members > 0.0
        assert energy_of_drives(robot, pose, velocity) == pytest.approx(members, rel=2e-7)


def numbers(robot, expressions):
    model = robot.model()
    return np.array(ca.Function("n", [model.geometry], [ca.vertcat(*expressions)])(robot.geometry.vector())).ravel()


def test_the_defaults_reproduce_the_reference_masses_within_two_percent():
    """Arm 0.9 kg, centre at 0.40 L, 1.25 m c^2 about the joint; rods of a limb 0.26 kg; plates 0.55 kg."""
    robot, model = Heli4(), Heli4().model()
    bodies = robot.bodies(model.pose, model.joints, model.g, 0.0)
    mass = {p.link: p.mass for p in bodies.particles}
    found = numbers(robot, [mass["arm 1"], mass["lower plate"], mass["upper plate"], bodies.rods[0].mass])
    np.testing.assert_allclose(found, [0.9, 0.55, 0.55, 0.26], rtol=0.02)
    arm = next(p for p in bodies.particles if p.link == "arm 1")
    at = ca.Function("at", [model.joints, model.geometry], [arm.point])
    drive = np.array([robot.geometry.base_radius, 0.0, 0.0])
    reach = np.linalg.norm(np.array(at(np.zeros(4), robot.geometry.vector())).ravel() - drive)
    length = robot.geometry.arm_length
    assert reach == pytest.approx(0.40 * length, rel=0.02)
    (own,) = numbers(robot, [bodies.rotors[1].inertia])
    about_joint = own + found[0] * reach**2
    assert about_joint == pytest.approx(1.25 * 0.9 * (0.40 * length) ** 2, rel=0.02)


def test_a_longer_arm_is_heavier_and_a_thicker_wall_too():
    def arm(**changes):
        robot = Heli4(Heli4().geometry.with_values(**changes))
        model = robot.model()
        bodies = robot.bodies(model.pose, model.joints, model.g, 0.0)
        return numbers(robot, [bodies.particles[0].mass])[0]

    per_metre = MATERIALS["aluminium"].density * np.pi * (0.025**2 - 0.023**2)
    assert arm(arm_length=0.5) - arm(arm_length=0.25) == pytest.approx(0.25 * per_metre, rel=1e-9)
    assert arm(arm_wall=0.003) > arm()


def test_a_weighed_mass_takes_the_place_of_what_follows():
    weighed = Delta(inertia=Delta.Inertia(plate_mass=2.0, rod_mass=1.0, rod_middle=0.0))
    model = weighed.model()
    bodies = weighed.bodies(model.pose, model.joints, model.g, 0.0)
    assert numbers(weighed, [bodies.particles[-1].mass, bodies.rods[0].mass]).tolist() == [2.0, 1.0]
    assert bodies.rods[0].split


def test_either_number_of_the_redundant_robots_platform_may_be_given():
    own = Redundant3T1R.Inertia()
    pose, still, turn = np.array([0.0, 0.05, 0.1, 0.2]), np.zeros(4), np.array([0.0, 0, 0, 10.0])

    def effort(acceleration, **given):
        return inverse_dynamics(Redundant3T1R(inertia=replace(own, **given)), 0.0, pose, still, acceleration)

    heavier = effort(still, platform_mass=6.0) - effort(still, platform_mass=3.0)
    assert np.abs(heavier).max() > 1.0
    assert np.abs(effort(turn, platform_inertia=0.5) - effort(turn, platform_inertia=0.1)).max() > 0.1
