"""The reaction on the frame, against the momentum of MuJoCo's model, and against statics and closed forms."""

import mujoco
import numpy as np
import pytest

from kinematics import MECHANISMS, Heli4, InvalidValue, Peppermill, frame_reaction, joint_motion
from tests.kinematics.by_hand import OBLIQUE, ByHand
from tests.kinematics.dynamics.test_motion import TIMES, pose_and_derivatives
from tests.kinematics.multibody.mujoco_model import OpenTree
from tests.kinematics.numeric import slope
from tests.sizes import every_mechanism

G = 9.80665
PAYLOAD = 0.7
E_Z = np.array([0.0, 0.0, 1.0])
EVERY = pytest.mark.parametrize("name", every_mechanism(MECHANISMS))


def swinging(robot, t):
    """A smooth periodic motion about home in all coordinates: pose, velocity, acceleration (k, n)."""
    pace = 5.0 * np.arange(1, len(robot.pose_names) + 1)
    size = 0.05 * robot.pose_units()
    angle = np.multiply.outer(np.asarray(t), pace) + 0.3 * pace
    return robot.home + size * np.sin(angle), size * pace * np.cos(angle), -size * pace**2 * np.sin(angle)


def without_rotors(kind):
    """MuJoCo's `armature` has no momentum in space, so rotors are tested by hand."""

    def bodies(self, *given):
        found = kind.bodies(self, *given)
        found.rotors.clear()
        return found

    return type(kind.__name__, (kind,), {"bodies": bodies})()


def momenta(robot, tree, t):
    """Of MuJoCo's bodies: linear and angular momentum about the origin, and weight and its moment (6,)."""
    tree.place(*swinging(robot, t))
    mujoco.mj_fwdPosition(tree.model, tree.data)
    mujoco.mj_fwdVelocity(tree.model, tree.data)
    mujoco.mj_subtreeVel(tree.model, tree.data)
    mass, centre = tree.model.body_subtreemass[0], tree.data.subtree_com[0]
    linear = mass * tree.data.subtree_linvel[0]
    weight = -mass * G * E_Z
    angular = tree.data.subtree_angmom[0] + np.cross(centre, linear)
    return np.concatenate([linear, angular]), np.concatenate([weight, np.cross(centre, weight)])


@EVERY
def test_it_is_the_weight_less_the_rate_of_the_momentum_of_simulated_bodies(name):
    robot = without_rotors(MECHANISMS[name])
    tree = OpenTree(robot, robot.home, PAYLOAD)
    for t in (0.1, 0.4):
        found = frame_reaction(robot, PAYLOAD, *swinging(robot, t))
        rate = slope(lambda s: momenta(robot, tree, s)[0], t, 1e-3)
        expected = momenta(robot, tree, t)[1] - rate
        scale = np.abs(expected).max()
        assert np.abs(np.concatenate(found) - expected).max() < 1e-6 * scale


@EVERY
def test_at_rest_it_is_the_weight_at_the_centre_of_mass(name):
    robot = MECHANISMS[name]()
    still = np.zeros(len(robot.pose_names))
    light, heavy = (frame_reaction(robot, payload, robot.home, still, still) for payload in (0.0, 2.0))
    assert np.abs(light.force[:2]).max() == 0.0
    np.testing.assert_allclose(heavy.force - light.force, -2.0 * G * E_Z, rtol=1e-12)
    tool = np.concatenate([robot.home[: robot.pose_names.index("y") + 1], [0.0]])
    np.testing.assert_allclose(
        heavy.moment - light.moment, np.cross(tool, -2.0 * G * E_Z), rtol=1e-9, atol=1e-12 * np.abs(light.force).max()
    )
    assert light.moment[2] == 0.0


@EVERY
def test_over_a_closed_cycle_the_mean_force_is_the_weight_and_no_turning_about_it_is_left(name):
    """Momentum is the same after a period, so its rate has no mean. Equal steps integrate periodic motions exactly."""
    robot = MECHANISMS[name]()
    times = np.linspace(0.0, 2 * np.pi / 5.0, 512, endpoint=False)
    still = np.zeros(len(robot.pose_names))
    force, moment = frame_reaction(robot, PAYLOAD, *swinging(robot, times))
    weight = frame_reaction(robot, PAYLOAD, robot.home, still, still).force
    assert np.abs(force - weight).max() > 0.01 * np.abs(weight).max()
    np.testing.assert_allclose(force.mean(axis=0), weight, atol=1e-9 * np.abs(force).max())
    assert abs(moment[:, 2].mean()) < 1e-9 * np.abs(moment).max()


def test_rotors_add_the_rate_of_their_own_angular_momentum():
    given = Heli4.Inertia(arm_mass=0.9, arm_centre=0.4, arm_factor=1.25)
    robot, bare = Heli4(OBLIQUE, given), type(without_rotors(Heli4))(OBLIQUE, given)
    pose, first, second, third, _ = pose_and_derivatives(TIMES[::10])
    i, axes = robot.inertia, ByHand(OBLIQUE).axes
    arm = i.drive + (i.arm_factor - 1) * i.arm_mass * (i.arm_centre * OBLIQUE.arm_length) ** 2
    turning = arm * joint_motion(robot, pose, first, second, third).second @ axes
    turning += i.tool * second[:, 3:] * E_Z
    whole, part = (frame_reaction(r, 1.0, pose, first, second) for r in (robot, bare))
    np.testing.assert_allclose(whole.force, part.force, rtol=1e-12)
    np.testing.assert_allclose(whole.moment - part.moment, -turning, atol=1e-9 * np.abs(whole.moment).max())


def test_an_arm_whose_inertia_is_a_uniform_bars_turns_the_frame_as_the_bar_does():
    """m l^2 / 3 about its end: the particle at its middle, and the rest as a rotor."""
    without = ["carriage_mass", "nut_mass", "distal_mass", "platform_mass", "tool", "carriage", "motor"]
    bar = {"proximal_mass": 1.2, "proximal_centre": 0.5, "proximal_factor": 4 / 3}
    robot = Peppermill(inertia=Peppermill.Inertia(**bar, **dict.fromkeys(without, 0.0)))
    places = (np.arange(400) + 0.5) / 400

    def momentum(t):
        """Of both bars in 400 pieces, about the origin."""
        pose, velocity, acceleration = swinging(robot, t)
        rates = joint_motion(robot, pose, velocity, acceleration, acceleration).first
        lines, total = robot.polylines(pose), np.zeros(3)
        for limb, axis in enumerate(np.eye(3)[:2]):
            start, end = lines[f"proximal {limb + 1}"]
            away = places[:, None] * (end - start)
            speed = rates[limb] * axis + np.cross(rates[2 + limb] * axis, away)
            total += 1.2 * np.cross(start + away, speed).mean(axis=0)
        return total

    pose, velocity, acceleration = swinging(robot, 0.3)
    found = frame_reaction(robot, 0.0, pose, velocity, acceleration).moment
    weights = frame_reaction(robot, 0.0, pose, np.zeros(4), np.zeros(4)).moment
    expected = weights - slope(momentum, 0.3, 1e-3)
    np.testing.assert_allclose(found, expected, atol=1e-5 * np.abs(found).max())


def test_out_of_reach_is_nan_and_a_payload_is_a_mass():
    robot = Heli4()
    poses = np.array([robot.home, [2.0, 0.0, -0.7, 0.0]])
    force, moment = frame_reaction(robot, 1.0, poses, np.zeros(4), np.zeros(4))
    assert np.isnan(force).all(-1).tolist() == np.isnan(moment).all(-1).tolist() == [False, True]
    with pytest.raises(InvalidValue, match="payload"):
        frame_reaction(robot, -1.0, robot.home, np.zeros(4), np.zeros(4))
