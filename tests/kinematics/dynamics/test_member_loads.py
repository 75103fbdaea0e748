"""Loads of the members against free bodies, against the reaction on the frame, and against virtual work."""

from dataclasses import fields, replace

import casadi as ca
import numpy as np
import pytest

from kinematics import (
    MECHANISMS,
    Delta,
    DriveTrain,
    GoughStewart,
    Heli4,
    Hexa,
    Par4,
    Peppermill,
    Planar3RRR,
    Redundant3T1R,
    frame_reaction,
    inverse_dynamics,
)
from kinematics.dynamics import case_in_motion
from tests.kinematics.by_hand import OBLIQUE, ByHand
from tests.kinematics.numeric import slope

G = 9.80665
E_Z = np.array([0.0, 0.0, 1.0])
PAYLOAD = 0.8


def swinging(robot, t):
    """A smooth motion about home in all coordinates: pose, velocity, acceleration (n,)."""
    pace = 6.0 * np.arange(1, len(robot.pose_names) + 1)
    size = 0.04 * robot.pose_units()
    angle = pace * (t + 0.3)
    return robot.home + size * np.sin(angle), size * pace * np.cos(angle), -size * pace**2 * np.sin(angle)


def numbers(robot, t, write):
    """Of expressions `write(loads)` in a motion."""
    model = robot.model()
    velocity, acceleration = (ca.SX.sym(name, model.pose.numel()) for name in ("v", "a"))
    case = case_in_motion(robot, PAYLOAD, velocity, acceleration)
    outputs = write(case.loads(case.shared()))
    function = ca.Function("loads", [model.pose, velocity, acceleration, model.geometry], outputs)
    return [np.array(v) for v in function.call([*map(ca.DM, swinging(robot, t)), ca.DM(robot.geometry.vector())])]


def rods_of(robot, t):
    """(k,) the tensions that the limbs transmit, without the rods' own masses."""
    return numbers(robot, t, lambda loads: [ca.vertcat(*(x.along.T @ x.force for x in loads if x.ends))])[0][:, 0]


def without_drives(kind):
    """A robot whose drives have no inertia of their own: it does not pass through the arms."""
    bars = {"bars_inertia": 0.0} if kind is Par4 else {}  # what only turns loads the pose's coordinates alone
    return kind(inertia=replace(kind.Inertia(), drive=0.0, **bars))


@pytest.mark.parametrize("kind", [Heli4, Delta, Hexa, Par4, Planar3RRR], ids=lambda kind: kind.__name__)
def test_what_the_arms_exert_on_their_drives_is_the_reaction_on_the_frame(kind):
    """Newton and Euler for the whole machine: it knows nothing of rods, plates and how they share the load."""
    robot = without_drives(kind)
    force, moment = frame_reaction(robot, PAYLOAD, *swinging(robot, 0.2))

    def at_roots(loads):
        roots = [load for load in loads if not load.ends][::2]
        starts, forces, moments = (
            ca.horzcat(*parts)
            for parts in zip(*((load.tube.start, load.force, load.moment) for load in roots), strict=True)
        )
        return [starts, forces, moments]

    starts, forces, moments = numbers(robot, 0.2, at_roots)
    total = np.cross(starts.T, forces.T).sum(axis=0) + moments.sum(axis=1)
    seen = slice(0, 2) if kind is Planar3RRR else slice(0, 3)  # a planar robot's weights are out of its plane
    about = slice(2, 3) if kind is Planar3RRR else slice(0, 3)
    np.testing.assert_allclose(forces.sum(axis=1)[seen], force[seen], atol=1e-9 * np.abs(force).max())
    np.testing.assert_allclose(total[about], moment[about], atol=1e-9 * np.abs(moment).max())


def test_what_the_legs_of_a_hexapod_exert_on_the_base_is_the_reaction_on_the_frame():
    robot = GoughStewart(inertia=GoughStewart.Inertia(rod_mass=0.0))
    found = frame_reaction(robot, PAYLOAD, *swinging(robot, 0.2))
    starts, forces = numbers(
        robot, 0.2, lambda loads: [ca.horzcat(*(x.tube.start for x in loads)), ca.horzcat(*(x.force for x in loads))]
    )
    np.testing.assert_allclose(forces.sum(axis=1), found.force, rtol=1e-9)
    np.testing.assert_allclose(np.cross(starts.T, forces.T).sum(axis=0), found.moment, rtol=1e-9)


def test_what_the_peppermills_limbs_exert_on_their_carriages_is_the_reaction_on_the_frame():
    geometry = Peppermill.Geometry(nut_spacing=1e-9)  # the nuts' masses are where the paper has them
    robot = Peppermill(geometry, Peppermill.Inertia(carriage_mass=0.0, carriage=0.0, motor=0.0))
    found = frame_reaction(robot, PAYLOAD, *swinging(robot, 0.2))
    roots = (0, 4)
    starts, forces, moments = numbers(
        robot,
        0.2,
        lambda loads: [
            ca.horzcat(*(loads[k].tube.start for k in roots)),
            ca.horzcat(*(loads[k].force for k in roots)),
            ca.horzcat(*(loads[k].moment for k in roots)),
        ],
    )
    np.testing.assert_allclose(forces.sum(axis=1), found.force, atol=1e-7 * np.abs(found.force).max())
    total = np.cross(starts.T, forces.T).sum(axis=0) + moments.sum(axis=1)
    np.testing.assert_allclose(total, found.moment, atol=1e-7 * np.abs(found.moment).max())


HEAVY = Heli4.Inertia(rod_mass=0.26, rod_middle=0.0, plate_masses=(0.7, 0.3))


class FreeBodies:
    """Equations of forces and moments about one point, six for each body, for unknown forces between them."""

    def __init__(self, count, about):
        self.about, self.matrix, self.needed = about, np.zeros((6 * count, 0)), np.zeros(6 * count)

    def unknown(self, *loads):
        """A force of 1 that acts as (body, force, point, moment) says."""
        column = np.zeros(self.needed.size)
        for body, force, at, moment in loads:
            column[6 * body : 6 * body + 6] += [*force, *(np.cross(at - self.about, force) + moment)]
        self.matrix = np.column_stack([self.matrix, column])

    def needs(self, body, force, at, moment=0 * E_Z):
        """What moves a body's mass."""
        self.needed[6 * body : 6 * body + 6] += [*force, *(np.cross(at - self.about, force) + moment)]


def test_heli4s_eight_rods_balance_plates_screw_and_tool_as_free_bodies():
    """18 equations of lower plate, upper plate and tool; a hinge and a nut without friction hold the tool."""
    robot, hand, none = Heli4(OBLIQUE, HEAVY), ByHand(OBLIQUE), 0 * E_Z
    i, (pose, _, acceleration) = robot.inertia, swinging(robot, 0.2)
    lower, upper, tool = range(3)

    def felt(place):
        """The acceleration of a point of the pose, and the weight of 1 kg upward."""
        return slope(lambda t: slope(lambda s: place(swinging(robot, s)[0]), t, 1e-3), 0.2, 1e-3) + G * E_Z

    def above(x):
        return x[:3] + hand.pitch * x[3] * E_Z

    bodies = FreeBodies(3, pose[:3])
    rods, ends = hand.rods(pose, robot.inverse(pose)), hand.platforms(pose)
    for limb in range(4):
        unit, plate = rods[limb] / np.linalg.norm(rods[limb]), lower if limb < 2 else upper
        for side in (-0.5, 0.5):
            at = ends[limb] + side * OBLIQUE.parallelogram_width * hand.axes[limb]
            bodies.unknown((plate, unit, at, none))
        bodies.needs(plate, i.rod_mass / 2 * felt(lambda x, limb=limb: hand.platforms(x)[limb]), ends[limb])
    for plate, at, lead in ((lower, pose[:3], 0.0), (upper, above(pose), hand.pitch)):
        for axis in np.eye(3):  # the nut's force along the screw turns it, and does no work in doing so
            turn = lead * axis * (axis @ E_Z)
            bodies.unknown((plate, axis, at, turn), (tool, -axis, at, -turn))
        for axis in np.eye(3)[:2]:
            bodies.unknown((plate, none, at, axis), (tool, none, at, -axis))
    bodies.needs(lower, (i.plate_masses[0] + PAYLOAD) * felt(lambda x: x[:3]), pose[:3])
    bodies.needs(upper, i.plate_masses[1] * felt(above), above(pose))
    bodies.needs(tool, none, pose[:3], i.tool * acceleration[3] * E_Z)
    expected = np.linalg.solve(bodies.matrix, bodies.needed)[:8]
    np.testing.assert_allclose(rods_of(robot, 0.2), expected, atol=1e-5 * np.abs(expected).max())
    assert np.ptp(expected.reshape(4, 2), axis=1).min() > 0.01 * np.abs(expected).max()  # the rods of a pair differ


REDUNDANT = Redundant3T1R.Inertia(
    rod_mass=0.9, rod_middle=0.0, platform_mass=3.0, platform_inertia=0.015, drive_train=DriveTrain()
)


def test_the_redundant_robots_eight_rods_balance_its_platform_with_the_least_energy():
    """Rods of one section on drives that do not give way: the least norm that the rods' lengths weigh."""
    robot = Redundant3T1R(inertia=REDUNDANT)
    i, (pose, velocity, acceleration) = robot.inertia, swinging(robot, 0.2)
    model = robot.model()
    tubes = [m.shapes[0] for m in robot.members(model.pose, model.joints, model.g) if m.name.startswith("rod")]
    places = [ca.horzcat(*(getattr(tube, end) for tube in tubes)) for end in ("start", "end")]
    at = ca.Function("at", [model.pose, model.joints, model.geometry], places)
    starts, ends = (np.array(v).T for v in at(pose, robot.inverse(pose), robot.geometry.vector()))
    lengths = np.linalg.norm(ends - starts, axis=1)

    def needed(mass, away):
        """Of a point of the platform, which turns about e_z."""
        turned = acceleration[3] * np.cross(E_Z, away) + velocity[3] ** 2 * np.cross(E_Z, np.cross(E_Z, away))
        force = mass * (acceleration[:3] + turned + G * E_Z)
        return np.concatenate([force, np.cross(away, force)])

    load = needed(i.platform_mass + PAYLOAD, np.zeros(3)) + i.platform_inertia * acceleration[3] * np.eye(6)[5]
    middles = np.array([0, 1, 2, 2, 4, 4, 6, 7]), np.array([0, 1, 3, 3, 5, 5, 6, 7])  # of pairs the line midway
    load = load + sum(needed(i.rod_mass / 2, away) for away in ends[list(middles)].mean(axis=0) - pose[:3])
    units = (starts - ends) / lengths[:, None]
    matrix = np.vstack([units.T, np.cross(ends - pose[:3], units).T])
    expected = (np.linalg.pinv(matrix / np.sqrt(lengths)) @ load) / np.sqrt(lengths)
    np.testing.assert_allclose(rods_of(robot, 0.2), expected, atol=1e-9 * np.abs(expected).max())


ON_LIMBS = "drive arm_hub arm_joint arm_mass slide_mass rod_joint rod_mass link_joint link_mass"
WITH_RODS = [name for name in MECHANISMS if name != "Peppermill"]


@pytest.mark.parametrize("name", WITH_RODS)
def test_the_rods_forces_times_their_elongation_rates_are_the_power_of_the_drives(name):
    """With all mass on the platform; the closure's J_m and the torque know nothing of single rods."""
    plain = MECHANISMS[name]()
    none = {f.name: 0.0 for f in fields(plain.inertia) if f.name in ON_LIMBS.split()}
    robot = type(plain)(inertia=replace(plain.inertia, **none))
    model, (pose, velocity, acceleration) = robot.model(), swinging(robot, 0.2)
    efforts = ca.horzcat(*(limb.efforts for limb in robot.statics(model.pose, model.joints, model.g)))
    at = ca.Function("efforts", [model.pose, model.joints, model.geometry], [efforts])
    by_joint = np.array(at(pose, robot.inverse(pose), robot.geometry.vector())).T
    drives = robot.inverse_jacobian(pose)
    found = (by_joint @ drives).T @ rods_of(robot, 0.2)
    expected = drives.T @ inverse_dynamics(robot, PAYLOAD, pose, velocity, acceleration)
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())
