"""The MJCF export: MuJoCo, on the same bodies, needs the same torques, and follows them with its loops closed."""

import casadi as ca
import mujoco
import numpy as np
import pytest

from kinematics import (
    Delta,
    DriveTrain,
    GoughStewart,
    Heli4,
    Hexa,
    InvalidValue,
    Par4,
    Peppermill,
    Planar3PRR,
    Planar3RPR,
    Planar3RRR,
    Redundant3T1R,
    UnreachablePose,
    inverse_dynamics,
)
from kinematics.dynamics.actuators import to_actuators
from kinematics.model.definition import Definition
from kinematics.multibody.mjcf import mjcf
from tests.kinematics.multibody.mujoco_model import MAIN, OpenTree, cycle, loaded, with_rods
from tests.sizes import later

PAYLOAD = 1.3
EACH = pytest.mark.parametrize("kind", MAIN, ids=lambda kind: kind.__name__)
RODS = pytest.mark.parametrize("uniform", [False, True], ids=["split rods", "uniform rods"])
RODS_LATER = pytest.mark.parametrize("uniform", [later(False), True], ids=["split rods", "uniform rods"])


def robot_of(kind, uniform, **drives):
    robot = kind(inertia=kind.Inertia(drive_train=DriveTrain(**drives)))
    return with_rods(robot, uniform)


def motions(robot, count, seed):
    """Random poses about a point off home, within reach, with random velocities and accelerations."""
    rng, n = np.random.default_rng(seed), len(robot.pose_names)
    pose = np.array(robot.home) + 0.02 + rng.uniform(-0.1, 0.1, (count, n))
    robot.require_reachable(pose)
    return pose, rng.normal(size=(count, n)) * 3, rng.normal(size=(count, n)) * 50


@EACH
@RODS_LATER
def test_loops_close_in_mujoco_at_every_pose(kind, uniform):
    robot = robot_of(kind, uniform)
    poses = motions(robot, 20, seed=1)[0]
    tree = OpenTree(robot, poses[0], PAYLOAD)
    assert max(np.abs(tree.loop_errors(pose)).max() for pose in poses) < 1e-14
    freedoms = tree.model.nv - np.linalg.matrix_rank(tree.data.efc_J.reshape(-1, tree.model.nv))
    assert freedoms == len(robot.pose_names)


@EACH
@RODS
def test_open_trees_inertia_and_bias_projected_by_our_jacobians_give_our_torques(kind, uniform):
    """Virtual work of MuJoCo's forces on all joints of the tree against that of our torques."""
    robot = robot_of(kind, uniform, gear_ratio=5.0, motor_inertia=1e-3)
    motion = motions(robot, 12, seed=2)
    tree = OpenTree(robot, motion[0][0], PAYLOAD)
    torques = inverse_dynamics(robot, PAYLOAD, *motion)
    for pose, velocity, acceleration, torque in zip(*motion, torques, strict=True):
        wrench = tree.wrench(pose, velocity, acceleration)
        found = robot.actuator_jacobian(pose).T @ torque
        assert np.abs(found - wrench).max() < 1e-6 * np.abs(wrench).max()


@pytest.mark.parametrize(
    "kind", [Delta, Hexa, Par4, Planar3PRR, Planar3RPR, Planar3RRR], ids=lambda kind: kind.__name__
)
@RODS_LATER
def test_the_other_mechanisms_close_in_mujoco_and_need_our_torques_too(kind, uniform):
    robot = robot_of(kind, uniform)
    rng, n = np.random.default_rng(5), len(robot.pose_names)
    pose = robot.home + rng.uniform(-0.02, 0.02, (6, n)) * robot.geometry.size
    motion = pose, rng.normal(size=pose.shape), rng.normal(size=pose.shape) * 20
    tree = OpenTree(robot, pose[0], PAYLOAD)
    torques = inverse_dynamics(robot, PAYLOAD, *motion)
    for k in range(len(pose)):
        assert np.abs(tree.loop_errors(pose[k])).max() < 1e-14
        wrench = tree.wrench(*(part[k] for part in motion))
        assert np.abs(robot.actuator_jacobian(pose[k]).T @ torques[k] - wrench).max() < 1e-6 * np.abs(wrench).max()


@pytest.mark.parametrize("kind", [Heli4, Redundant3T1R], ids=lambda kind: kind.__name__)
def test_each_torque_is_mujocos_on_its_own_joint_and_a_share_of_the_platforms(kind):
    """tau = f_q + J^+T f_x: for the redundant robot the least norm of what the platform needs."""
    robot = robot_of(kind, False)
    poses, velocities, accelerations = motions(robot, 30, seed=3)
    tree = OpenTree(robot, poses[0], PAYLOAD)
    torques = inverse_dynamics(robot, PAYLOAD, poses, velocities, accelerations)
    for k, pose in enumerate(poses):
        forces = tree.forces(pose, velocities[k], accelerations[k])
        on_joints, on_pose = (np.array([forces[x] for x in names]) for names in (robot.joint_names, robot.pose_names))
        if kind is Heli4:  # the upper plate rides on the screw
            on_pose[3] += robot.geometry.pitch / (2 * np.pi) * forces["nut"]
        expected = on_joints + np.linalg.pinv(robot.inverse_jacobian(pose).T) @ on_pose
        assert np.abs(torques[k] - expected).max() < 1e-6 * np.abs(expected).max()


@EACH
@RODS_LATER
def test_simulation_driven_by_our_torques_alone_follows_the_cycle(kind, uniform):
    """No controller: 0.4 s there and back, 10 micrometres at most; with the wrong payload it is lost."""
    robot, step = robot_of(kind, uniform, gear_ratio=2.0, motor_inertia=1e-4), 1e-4
    pose, velocity, acceleration = cycle(kind, 0.2, np.arange(4001) * step)
    model, data = loaded(robot, pose[0], PAYLOAD)
    assert model.opt.timestep == step
    where = [model.joint(name).qposadr[0] for name in robot.pose_names]

    def worst(payload, steps):
        torque = inverse_dynamics(robot, payload, pose, velocity, acceleration) / 2.0  # at the motors
        mujoco.mj_resetData(model, data)
        error = 0.0
        for k in range(steps):
            data.ctrl[:] = (torque[k] + torque[k + 1]) / 2
            mujoco.mj_step(model, data)
            error = max(error, float(np.linalg.norm(data.qpos[where][:3] - pose[k + 1, :3])))
        return error

    assert worst(PAYLOAD, len(pose) - 1) < 1e-5
    assert worst(PAYLOAD + 0.1, 1500) > 1e-4


@EACH
@RODS_LATER
def test_a_robot_let_go_keeps_its_energy(kind, uniform):
    robot = robot_of(kind, uniform)
    model, data = loaded(robot, np.array(robot.home) + 0.02, PAYLOAD)
    mujoco.mj_forward(model, data)
    before, kinetic = data.energy.sum(), []
    for _ in range(1000):
        mujoco.mj_step(model, data)
        kinetic.append(data.energy[1])
    assert abs(data.energy.sum() - before) < 1e-6 * max(kinetic)
    assert max(kinetic) > 0.5


@EACH
def test_masses_are_ours_and_nothing_else(kind):
    robot = kind()
    model = loaded(robot, robot.home, PAYLOAD)[0]
    symbols = robot.model()
    bodies = robot.bodies(symbols.pose, symbols.joints, symbols.g, PAYLOAD)
    total = ca.sum1(ca.vertcat(*(p.mass for p in bodies.all_particles())))
    numbers = ca.Function("mass", [symbols.geometry], [total])(robot.geometry.vector())
    assert model.body_mass.sum() == pytest.approx(float(numbers), abs=1e-11)
    assert sorted(model.actuator(k).name for k in range(model.nu)) == sorted(robot.actuator_names)


@pytest.mark.parametrize("kind", [Heli4, Peppermill], ids=lambda kind: kind.__name__)
def test_friction_of_the_drives_is_mujocos(kind):
    """Coulomb and viscous, of joints and of motors that move two joints each, at speeds where MuJoCo's slips."""
    robot, bare = robot_of(kind, False, coulomb=(1.0, 2.0, 3.0, 4.0), viscous=0.5), robot_of(kind, False)
    poses, velocities, _ = motions(robot, 1, seed=4)
    args = (PAYLOAD, poses, velocities, np.zeros_like(poses))
    added = (inverse_dynamics(robot, *args) - inverse_dynamics(bare, *args))[0]
    tree = OpenTree(robot, poses[0], PAYLOAD)
    tree.model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_EQUALITY)
    tree.place(poses[0], velocities[0], 0 * poses[0])
    mujoco.mj_forward(tree.model, tree.data)
    speed = tree.data.actuator_velocity
    np.testing.assert_allclose(added, [1.0, 2.0, 3.0, 4.0] * np.sign(speed) + 0.5 * speed, rtol=1e-9)
    onto_joints = to_actuators(robot, np.eye(4)) @ added
    forces = dict(zip(tree.names, tree.data.qfrc_constraint + tree.data.qfrc_passive, strict=True))
    np.testing.assert_allclose([-forces[name] for name in robot.joint_names], onto_joints, rtol=1e-6, atol=1e-6)


class Par4OfBodies(Par4):
    """Its links as they follow from the bodies, which they do not."""

    link_tree = Definition.link_tree


class Planar3RPROfBodies(Planar3RPR):
    """The same."""

    link_tree = Definition.link_tree


def test_what_cannot_be_exported_is_named():
    with pytest.raises(InvalidValue, match=r"half 1, which moves in another way; expected .* the hook `link_tree`"):
        mjcf(Par4OfBodies(), Par4().home)
    with pytest.raises(InvalidValue, match="no link that q1 moves"):
        mjcf(Planar3RPROfBodies(), Planar3RPR().home)
    with pytest.raises(UnreachablePose, match="limb"):
        mjcf(Heli4(), (0.0, 0.0, -3.0, 0.0))
    with pytest.raises(InvalidValue, match="payload: found -1"):
        mjcf(Heli4(), Heli4().home, -1.0)
    with pytest.raises(InvalidValue, match="one pose"):
        mjcf(GoughStewart(), [GoughStewart().home] * 2)
