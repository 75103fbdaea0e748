"""All that counts at the Peppermill's four motors: drives, indices, motion and torque; and its drawing."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from kinematics import FviBounds, Heli4, Peppermill, actuator_motion, inverse_dynamics, joint_motion
from kinematics.dynamics.actuators import from_actuators, to_actuators
from tests.kinematics.numeric import differences, slope
from tests.kinematics.robots.peppermill.peppermill_by_hand import TURN, ByHand, assembled, box
from tests.kinematics.weighed import PEPPERMILL

GEOMETRY = Peppermill.Geometry()
UNLIKE = Peppermill.Geometry((0.22, 0.17), (0.48, 0.61), 0.55, (0.09, -0.13), 0.06)


def test_motors_and_joints_undo_each_other_beyond_a_turn():
    robot = Peppermill(UNLIKE)
    joints = np.random.default_rng(8).uniform([-2, -2, -40, -40], [2, 2, 40, 40], (100_000, 4))
    motors = robot.motors(joints)
    np.testing.assert_allclose(motors, joints @ ByHand(UNLIKE).drives.T, atol=1e-12)
    assert np.abs(robot.from_motors(motors) - joints).max() < 1e-13
    assert robot.actuator_names == ("1L", "1R", "2L", "2R")
    assert (robot.actuator_units, robot.joint_units) == (("rad",) * 4, ("m", "m", "rad", "rad"))


def test_like_motors_turn_a_limb_and_unlike_ones_slide_it():
    robot, turn = Peppermill(), np.array([1.0, 1.0, 0.0, 0.0])
    np.testing.assert_allclose(robot.from_motors(turn), [0, 0, 1, 0], atol=1e-16)
    slide = TURN * np.array([1.0, -1.0, 0.0, 0.0])
    np.testing.assert_allclose(robot.from_motors(slide), [0.10, 0, 0, 0], atol=1e-16)


def test_actuator_jacobian_is_the_drives_times_the_joints_one():
    robot, pose = Peppermill(UNLIKE), assembled(UNLIKE, np.random.default_rng(9), 5000)[0]
    wanted = ByHand(UNLIKE).drives @ robot.inverse_jacobian(pose)
    assert np.abs(robot.actuator_jacobian(pose) - wanted).max() < 1e-11


def homogeneous(robot, pose):
    return robot.actuator_jacobian(pose) / np.array([1, 1, 1, robot.characteristic_length])


def test_isotropic_speed_force_and_condition_number_are_the_motors():
    robot, pose = Peppermill(), box(20_000, seed=10)
    j = homogeneous(robot, pose)
    speed, force = robot.isotropic(pose)
    np.testing.assert_allclose(speed, 1 / np.linalg.norm(j, axis=-1).max(-1), rtol=1e-12)
    np.testing.assert_allclose(force, 1 / np.linalg.norm(np.linalg.pinv(j), axis=-2).max(-1), rtol=1e-11)
    np.testing.assert_allclose(robot.condition_number(pose), np.linalg.cond(j), rtol=1e-11)
    bounds = robot.fvi_bounds
    wanted = np.minimum(speed * bounds.joint_speed / bounds.speed, force * bounds.joint_effort / bounds.force)
    np.testing.assert_allclose(robot.fvi(pose), wanted, rtol=1e-13)


def test_isotropic_force_is_the_least_that_unit_motor_torques_hold_in_any_direction():
    """By linear programming: the largest t with t n = J^T tau and |tau| <= 1."""
    robot, rng = Peppermill(), np.random.default_rng(11)
    for pose in box(5, seed=12):
        j, (_, force) = homogeneous(robot, pose), robot.isotropic(pose)
        worst = np.linalg.inv(j)
        worst = (worst / np.linalg.norm(worst, axis=0)).T  # the polytope's facets' normals
        directions = np.concatenate([worst, rng.normal(size=(30, 4))])
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        held = []
        for n in directions:
            equal = np.column_stack([-j.T, n])
            found = linprog([0, 0, 0, 0, -1], A_eq=equal, b_eq=np.zeros(4), bounds=[(-1, 1)] * 4 + [(0, None)])
            held.append(-found.fun)
        assert min(held) == pytest.approx(force, rel=1e-9)


def test_characteristic_length_is_p_over_two_pi():
    assert Peppermill().characteristic_length == pytest.approx(0.10 / TURN, rel=1e-15)
    assert Peppermill(UNLIKE).characteristic_length == pytest.approx(0.11 / TURN, rel=1e-15)


def test_the_default_gives_what_its_bounds_ask_all_over_the_box():
    fvi = Peppermill().fvi(box(1_000_000, seed=13))
    assert 1.40 < fvi.min() < 1.43


inside = st.tuples(*(st.floats(-h, h) for h in (0.2, 0.2, 0.05, TURN)))


@settings(max_examples=50, deadline=None, derandomize=True)
@given(inside, st.floats(0.05, 20.0))
def test_fvi_does_not_depend_on_the_unit_of_length(pose, scale):
    robot, larger = Peppermill(), Peppermill(Peppermill.Geometry.from_vector(GEOMETRY.vector() * scale))
    b, scaled = robot.fvi_bounds, np.array(pose) * [scale, scale, scale, 1]
    bounds = FviBounds(b.joint_speed, b.joint_effort, b.speed * scale, b.force / scale)
    assert larger.fvi(scaled, bounds) == pytest.approx(robot.fvi(np.array(pose)), rel=1e-10)
    (v, f), (w, g) = robot.isotropic(np.array(pose)), larger.isotropic(scaled)
    assert (w, g) == (pytest.approx(v * scale, rel=1e-10), pytest.approx(f / scale, rel=1e-10))


@settings(max_examples=50, deadline=None, derandomize=True)
@given(inside)
def test_fvi_has_the_machines_symmetries(pose):
    """A half turn about the diagonal (opposite pitches keep phi), and mirrors in x and y with the other elbow."""
    robot, pose = Peppermill(), np.array(pose)
    swapped = np.array([pose[1], pose[0], -pose[2], pose[3]])
    for index in (robot.fvi, lambda p: robot.margin("det_J_x", p), lambda p: robot.margin("reach", p)):
        assert index(swapped) == pytest.approx(index(pose), rel=1e-10)


# Motion and torque.


def swing(t):
    """A smooth pose of time (..., 4) and its first three derivatives."""
    size, rate = np.array([0.15, 0.1, 0.04, 5.0]), np.array([3.0, 4.0, 5.0, 2.0])
    at = rate * np.asarray(t)[..., None] + np.array([0.1, 0.7, 1.1, 0.4])
    return [size * rate**k * np.sin(at + k * np.pi / 2) for k in range(4)]


def test_motor_motion_is_the_time_derivative_of_the_motors():
    robot, t = Peppermill(UNLIKE), np.linspace(0, 1, 200)
    found = actuator_motion(robot, *swing(t))
    assert np.abs(found.position - robot.motors(robot.inverse(swing(t)[0]))).max() < 1e-12
    for k in range(3):
        numeric = slope(lambda t, k=k: actuator_motion(robot, *swing(t))[k], t, 1e-3)
        np.testing.assert_allclose(found[k + 1], numeric, atol=1e-8 * np.abs(found[k + 1]).max())
    for motors, joints in zip(found, joint_motion(robot, *swing(t)), strict=True):
        np.testing.assert_allclose(motors, joints @ ByHand(UNLIKE).drives.T, rtol=1e-11, atol=1e-9)


def energy(robot, t, payload):
    """Kinetic and potential energy by hand, velocities by five-point differences of the points."""
    i, g, hand = robot.inertia, robot.geometry, ByHand(robot.geometry)

    def points(at):
        pose = swing(at)[0]
        joints = robot.inverse(pose)
        carriage, elbow = hand.carriages(joints), hand.elbows(joints)
        link = carriage + i.proximal_centre * (elbow - carriage)
        return carriage, link, elbow, hand.nuts(pose), pose[:, None, :3], joints @ hand.drives.T, joints[:, 2:], pose

    def rate(k):
        return slope(lambda t: points(t)[k], t, 1e-4)

    masses = [i.carriage_mass, i.proximal_mass, i.distal_mass / 2, i.nut_mass + i.distal_mass / 2]
    masses.append(i.platform_mass + payload)
    now, total = points(t), np.zeros(len(t))
    for k, mass in enumerate(masses):
        total += mass * (rate(k) ** 2).sum((-1, -2)) / 2 + mass * 9.80665 * now[k][..., 2].sum(-1)
    centre = i.proximal_centre * np.array(g.proximal_lengths)
    own = i.carriage + (i.proximal_factor - 1) * i.proximal_mass * centre**2
    total += i.motor * (rate(5) ** 2).sum(-1) / 2 + (own * rate(6) ** 2).sum(-1) / 2
    return total + i.tool * rate(7)[:, 3] ** 2 / 2


def test_motor_torques_times_motor_speeds_are_the_power():
    robot, t = Peppermill(UNLIKE, PEPPERMILL), np.linspace(0, 1, 50)
    pose, velocity, acceleration, _ = swing(t)
    torque = inverse_dynamics(robot, 1.0, pose, velocity, acceleration)
    power = (torque * actuator_motion(robot, *swing(t)).first).sum(-1)
    np.testing.assert_allclose(power, slope(lambda t: energy(robot, t, 1.0), t, 1e-3), atol=1e-6 * np.abs(power).max())


def test_motors_bear_the_weight_that_virtual_work_asks():
    """At rest J_act^T tau is the gradient of the potential energy, by differences of the points by hand."""
    robot, hand, pose = Peppermill(inertia=PEPPERMILL), ByHand(GEOMETRY), box(500, seed=14)
    i, rest = robot.inertia, np.zeros_like(pose)

    def potential(p):
        joints = robot.inverse(p)
        carriage, elbow, nut = hand.carriages(joints)[..., 2], hand.elbows(joints)[..., 2], hand.nuts(p)[..., 2]
        links_ = i.proximal_mass * (carriage + i.proximal_centre * (elbow - carriage)) + i.distal_mass / 2 * elbow
        own = (links_ + (i.nut_mass + i.distal_mass / 2) * nut).sum(-1)
        return 9.80665 * (own + (i.platform_mass + 1.0) * p[..., 2])[..., None]

    torque = inverse_dynamics(robot, 1.0, pose, rest, rest)
    found = np.einsum("kmn,km->kn", robot.actuator_jacobian(pose), torque)
    assert np.abs(found - differences(potential, pose, 1e-4)[:, 0]).max() < 1e-7


# The base, for robots whose drives are their joints.


def test_a_robot_without_coupled_drives_is_unchanged():
    robot = Heli4()
    pose = np.random.default_rng(15).uniform([-0.3, -0.3, -0.8, -3], [0.3, 0.3, -0.6, 3], (1000, 4))
    joints = robot.inverse(pose)
    assert robot.actuator_names == robot.joint_names
    np.testing.assert_array_equal(robot.actuator_jacobian(pose), robot.inverse_jacobian(pose))
    for convert in (to_actuators, from_actuators):
        np.testing.assert_array_equal(convert(robot, joints), joints)
    rates = [np.random.default_rng(k).normal(size=pose.shape) for k in range(3)]
    for a, b in zip(actuator_motion(robot, pose, *rates), joint_motion(robot, pose, *rates), strict=True):
        np.testing.assert_array_equal(a, b)
    by_pose, by_joints = robot.jacobians(pose), robot.jacobians(pose, joints)
    for a, b in zip(by_pose, by_joints, strict=True):
        np.testing.assert_allclose(a, b, atol=1e-14)


# Drawing.


def test_the_drawing_has_the_links_lengths_and_meets_at_the_nuts():
    robot = Peppermill(UNLIKE)
    pose = np.array([0.05, -0.08, 0.01, 1.7])
    lines = robot.polylines(pose)
    for limb in range(2):
        near, far = lines[f"proximal {limb + 1}"], lines[f"distal {limb + 1}"]
        assert np.linalg.norm(np.diff(near, axis=0)) == pytest.approx(UNLIKE.proximal_lengths[limb], rel=1e-14)
        assert np.linalg.norm(np.diff(far, axis=0)) == pytest.approx(UNLIKE.distal_lengths[limb], rel=1e-14)
        np.testing.assert_array_equal(near[1], far[0])
        np.testing.assert_array_equal(far[1], lines["screws"][limb])
        axis = lines[f"drive axis {limb + 1}"]
        np.testing.assert_allclose(np.cross(near[0] - axis[0], axis[1] - axis[0]), 0, atol=1e-15)
    np.testing.assert_allclose(lines["base"], [[0, 0, -0.55], [0, 0, 0.55]])
    np.testing.assert_allclose(lines["tool"][0], pose[:3])
