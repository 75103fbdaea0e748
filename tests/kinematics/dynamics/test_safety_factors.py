"""Safety factors against closed forms, and the margin strength against samples of directions and poses."""

import math
from dataclasses import replace

import casadi as ca
import numpy as np
import pytest

from design import Box, certify
from kinematics import (
    MECHANISMS,
    Delta,
    GoughStewart,
    Heli4,
    InvalidValue,
    Peppermill,
    is_length,
    loads_from_rest,
    member_forces,
)
from kinematics.dynamics import MemberLoad, Size, WorstDirection, safety_factors
from kinematics.machine import MATERIALS, Load, Tube
from tests.sizes import every_mechanism

G = 9.80665
STEEL = MATERIALS["steel"]
L, R, WALL = 2.0, 0.01, 0.002
AREA = math.pi * (R**2 - (R - WALL) ** 2)
SECOND = math.pi / 4 * (R**4 - (R - WALL) ** 4)
EVERY = pytest.mark.parametrize("name", every_mechanism(MECHANISMS))


def member(along, force, moment=None, ends=()):
    """One tube of steel from the origin."""
    along = ca.DM(along)
    tube = Tube(ca.SX(3, 1), L * along, ca.SX(R), ca.SX(WALL))
    moment = ca.SX(3, 1) if moment is None else ca.SX(moment)
    return MemberLoad("m", tube, STEEL, along, ca.SX(force), moment, tuple(ca.SX(end) for end in ends))


def factors(load, size=None):
    return {what: float(ca.evalf(factor)) for what, factor in safety_factors(load, size or Size()).items()}


def test_a_hanging_rod_bears_its_weight_at_the_top_only():
    """Half of its mass counts as if at its lower end, where its joint then bears nothing."""
    weight = STEEL.density * AREA * L * G
    load = member([0, 0, -1], [0, 0, -weight / 2], ends=([0, 0, G], [0, 0, G]))
    top, bottom = (float(ca.evalf(tension)) for tension in load.tensions())
    assert (top, bottom) == (pytest.approx(weight), pytest.approx(0.0, abs=1e-12 * weight))
    assert factors(load)["yield"] == pytest.approx(STEEL.strength * AREA / weight)


def test_a_pushed_rod_buckles_at_eulers_load_and_a_pulled_one_does_not():
    euler = math.pi**2 * STEEL.modulus * SECOND / L**2
    push = member([1, 0, 0], [-euler / 3, 0, 0], ends=([0, 0, 0], [0, 0, 0]))
    pull = member([1, 0, 0], [euler / 3, 0, 0], ends=([0, 0, 0], [0, 0, 0]))
    assert factors(push)["buckling"] == pytest.approx(3.0)
    assert factors(pull)["buckling"] > 1e8
    assert factors(push)["yield"] == factors(pull)["yield"] == pytest.approx(3 * STEEL.strength * AREA / euler)


def test_a_level_rod_bends_as_a_beam_on_two_supports():
    """w l^2 / 8 under its weight; w l^2 / (9 sqrt 3) where its inertia grows from 0 at one end, as it swings."""
    w = STEEL.density * AREA
    even = factors(member([1, 0, 0], [0, 0, 0], ends=([0, 0, G], [0, 0, G])))["yield"]
    exact = STEEL.strength * SECOND / R / (w * G * L**2 / 8)
    assert 0.97 * exact < even < exact  # 2.6 % on the safe side
    growing = factors(member([1, 0, 0], [0, 0, 0], ends=([0, 0, 0], [0, 0, G])))["yield"]
    places = np.linspace(0.0, 1.0, 100_001)
    largest = (w * G * L**2 / 6 * (places - places**3)).max()
    assert growing == pytest.approx(STEEL.strength * SECOND / R / largest, rel=1e-8)


def test_an_arm_yields_by_tension_bending_and_torsion_as_von_mises_says():
    load = member([0, 1, 0], [3.0, 500.0, 4.0], [20.0, 30.0, -15.0])
    stress = 500.0 / AREA + math.hypot(20.0, 15.0) * R / SECOND
    shear = 30.0 * R / (2 * SECOND)
    assert factors(load) == {"yield": pytest.approx(STEEL.strength / math.sqrt(stress**2 + 3 * shear**2))}


def test_a_still_level_arm_bears_its_own_weight_at_its_root():
    """m g L / 2 of a uniform one, with nothing on it; the elbow of limb 1 is level with its drive."""
    uniform = {"arm_mass": 0.4, "arm_centre": 0.5, "arm_factor": 4 / 3, "rod_mass": 0.0, "plate_mass": 0.0}
    robot = Delta(inertia=Delta.Inertia(**uniform))
    level = robot.forward(np.full(3, math.pi / 2))
    found = member_forces(robot, 0.0, level, np.zeros(3), np.zeros(3))
    g, aluminium = robot.geometry, robot.structure.arm
    second = math.pi / 4 * (g.arm_radius**4 - (g.arm_radius - g.arm_wall) ** 4)
    moment = 0.4 * G * g.arm_length / 2
    arms = [found.names.index(f"arm {i}") for i in (1, 2, 3)]
    np.testing.assert_allclose(found.bending[arms], moment, rtol=1e-9)
    np.testing.assert_allclose(found.safety[arms], aluminium.strength * second / g.arm_radius / moment, rtol=1e-9)


def in_random_directions(robot, rng, count):
    """(count, n) the tool point's acceleration of the robot's load."""
    lengths = [i for i, axis in enumerate(robot.pose_names) if is_length(axis)]
    directions = rng.normal(size=(count, len(lengths)))
    acceleration = np.zeros((count, robot.home.size))
    acceleration[:, lengths] = robot.load.acceleration * directions / np.linalg.norm(directions, axis=1)[:, None]
    return acceleration


@EVERY
def test_strength_is_the_worst_direction_of_the_acceleration_or_a_little_less(name):
    """Less only as bending, tension and weight are added as if they were worst together."""
    robot, rng = MECHANISMS[name](), np.random.default_rng(3)
    pose = robot.home + 0.02 * robot.pose_units() * rng.uniform(-1, 1, robot.home.size)
    acceleration = in_random_directions(robot, rng, 4000)
    sampled = member_forces(robot, robot.load.payload, pose, np.zeros_like(pose), acceleration).safety.min()
    found = float(robot.margin("strength", pose))
    assert found <= sampled * (1 + 1e-9)
    assert sampled <= 1.5 * found


@EVERY
def test_loads_from_rest_are_those_in_the_worst_direction_or_a_little_more(name):
    """Tension and compression exactly; the others as if acceleration and weight were worst together."""
    robot, rng = MECHANISMS[name](), np.random.default_rng(8)
    pose = robot.home + 0.02 * robot.pose_units() * rng.uniform(-1, 1, robot.home.size)
    acceleration = in_random_directions(robot, rng, 20_000)
    sampled = member_forces(robot, robot.load.payload, pose, np.zeros_like(pose), acceleration)
    found = loads_from_rest(robot, pose)
    assert found.names == sampled.names
    largest = np.maximum(found.tension, found.compression)
    np.testing.assert_allclose(np.abs(sampled.tension).max(axis=0), largest, rtol=2e-3)
    for most, seen in ((found.bending, sampled.bending), (found.joint_force, sampled.joint_force)):
        assert (seen.max(axis=0) <= most * (1 + 1e-9) + 1e-12).all()
        assert (most <= 1.6 * seen.max(axis=0) + 1e-9).all()


def test_loads_from_rest_are_lost_where_a_limb_cannot_reach():
    found = loads_from_rest(Delta(), np.array([[0.0, 0.0, -0.75], [9.0, 0.0, 0.0]]))
    assert np.isnan(found.joint_force).any(axis=1).tolist() == [False, True]


def test_the_buckling_of_rods_is_exact_in_the_worst_direction():
    size, rng = WorstDirection(30.0), np.random.default_rng(5)
    rows = rng.normal(size=(1, 4)) * [10, 10, 10, 50]
    worst = float(ca.evalf(size.most(ca.SX(rows))))
    directions = rng.normal(size=(200_000, 3))
    sampled = 30.0 * (directions / np.linalg.norm(directions, axis=1)[:, None]) @ rows[0, :3] + rows[0, 3]
    assert sampled.max() <= worst
    assert sampled.max() == pytest.approx(worst, rel=1e-3)


@EVERY
def test_every_component_names_its_member(name):
    robot = MECHANISMS[name]()
    margin = robot.margins["strength"]
    places = margin.places(robot)
    names = {m.name for m in robot.members(robot.model().pose, robot.model().joints, robot.model().g)}
    assert len(places) == robot.margin_components("strength", robot.fvi_bounds, 1.0).numel()
    assert {place.rpartition(", ")[0] for place in places} <= names


def test_stronger_and_stiffer_members_are_as_many_times_as_safe():
    """In a robot without more rods than freedoms, which alone share a load by stiffness."""
    robot = Heli4()
    doubled = {
        kind: replace(material, modulus=2 * material.modulus, strength=2 * material.strength)
        for kind, material in (("arm", robot.structure.arm), ("rod", robot.structure.rod))
    }
    stronger = robot.with_structure(replace(robot.structure, **doubled))
    assert stronger.margin("strength", robot.home) == pytest.approx(2 * robot.margin("strength", robot.home), rel=1e-9)


def test_a_heavier_load_is_less_safe():
    values = [
        float(GoughStewart(load=Load(payload, acceleration)).margin("strength", GoughStewart().home))
        for payload, acceleration in ((0.0, 0.0), (1.0, 0.0), (1.0, 50.0), (1.0, 100.0), (3.0, 100.0))
    ]
    assert (np.diff(values) < 0.0).all()


def test_out_of_reach_is_nan_and_a_payload_is_a_mass():
    robot = Heli4()
    poses = np.array([robot.home, [2.0, 0.0, -0.7, 0.0]])
    found = member_forces(robot, 1.0, poses, np.zeros(4), np.zeros(4))
    for part in found[1:]:
        assert np.isnan(part).all(-1).tolist() == [False, True]
    assert np.isnan(robot.margin("strength", poses)).tolist() == [False, True]
    with pytest.raises(InvalidValue, match="payload"):
        member_forces(robot, -1.0, robot.home, np.zeros(4), np.zeros(4))


@pytest.mark.long
@EVERY
def test_it_is_proved_around_home_close_to_its_samples_and_no_further(name):
    robot, rng = MECHANISMS[name](), np.random.default_rng(7)
    half = 0.0002 * robot.pose_units()
    region = Box(**{n: (h - d, h + d) for n, h, d in zip(robot.pose_names, robot.home, half, strict=True)})
    poses = robot.home + half * rng.uniform(-1, 1, (2000, half.size))
    least = robot.margin("strength", poses).min()
    assert certify(robot, region, "strength", at_least=0.9 * least, most_boxes=2_000).status == "proved"
    assert certify(robot, region, "strength", at_least=1.001 * least).status == "refuted"


def test_it_is_proved_over_a_region_and_refuted_above_a_sample():
    robot, rng = Peppermill(), np.random.default_rng(8)
    region = Box(x=(0.0, 0.05), y=(0.0, 0.05), z=(0.0, 0.02), theta=(0.0, 0.5))
    least = robot.margin("strength", rng.uniform(0, 1, (5000, 4)) * [0.05, 0.05, 0.02, 0.5]).min()
    found = certify(robot, region, "strength", at_least=0.98 * least)
    assert found.status == "proved"
    assert found.boxes > 10
    assert certify(robot, region, "strength", at_least=1.001 * least).status == "refuted"
