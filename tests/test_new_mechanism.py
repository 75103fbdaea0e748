"""The example of docs/new_mechanism.md is a whole mechanism, and the page names every hook of the base class."""

import re
from pathlib import Path

import numpy as np
import pytest

from kinematics import Mechanism, inverse_dynamics
from kinematics.model.definition import Definition
from kinematics.robots.shared.paired_rods import RodLevel

PAGE = (Path(__file__).parents[1] / "docs" / "new_mechanism.md").read_text()


@pytest.fixture(scope="module")
def robot():
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    namespace = {"__name__": "docs.new_mechanism"}
    exec(compile(code, "docs/new_mechanism.md", "exec"), namespace)
    return namespace["Biglide"]()


@pytest.fixture(scope="module")
def poses():
    return np.random.default_rng(1).uniform([-1.0, -0.45], [1.0, -0.1], (1000, 2))


def test_the_page_names_every_hook():
    hooks = {name for name in (*Mechanism.__abstractmethods__, *Definition.__annotations__) if name != "margins"}
    optional = {
        "drives",
        "statics",
        "passive_joints",
        "link_tree",
        "base_members",
        "turns_left",
        "actuator_names",
        "actuator_units",
        "joint_cosines_and_sines",
        "j_q_closed_form",
        "pose_rate_map",
        "closure_by_twist",
    }
    rows = "\n".join(line for line in PAGE.splitlines() if line.startswith("| `"))
    named = set(re.findall(r"`(\w+)`", rows))
    assert hooks | optional <= named
    of_rods = (RodLevel.__abstractmethods__ - Mechanism.__abstractmethods__) | set(RodLevel.__annotations__)
    assert of_rods <= set(re.findall(r"`(\w+)`", PAGE))


def test_the_example_comes_back_from_its_joints(robot, poses):
    joints = robot.inverse(poses)
    assert np.abs(robot.closure_residual(poses, joints)).max() < 1e-15
    assert np.abs(robot.forward(joints) - poses).max() < 1e-14
    assert np.array_equal(robot.assembly_modes(joints[0])[0], robot.forward(joints[0]))
    assert np.isnan(robot.inverse([0.0, 0.6])).all()
    assert np.isnan(robot.forward([-1.0, 1.0])).all()


def test_the_examples_jacobians_have_the_sign_that_the_page_states(robot, poses):
    joints = robot.inverse(poses)
    rods = np.stack([joints - poses[:, :1], np.broadcast_to(-poses[:, 1:], joints.shape)], axis=-1)
    j_q, j_x = robot.jacobians(poses)
    assert np.abs(j_q - rods[:, :, 0, None] * np.eye(2)).max() < 1e-15
    assert np.abs(j_x - rods).max() < 1e-15
    step = 1e-6 * np.array([0.6, 0.8])
    rates = (robot.inverse(poses + step) - robot.inverse(poses - step)) / 2e-6
    assert np.abs(rates - robot.inverse_jacobian(poses) @ [0.6, 0.8]).max() < 1e-7


def test_the_base_gives_the_example_all_the_rest(robot, poses):
    for name in robot.margins:
        values = robot.margin(name, poses)
        exact = name == "position_accuracy"  # its drives have no error
        assert (values == 0).all() if exact else (values > 0).all()
    assert robot.margin("det_J_x", poses).max() <= 1.0
    assert np.isfinite(robot.condition_number(poses)).all()
    assert robot.polylines(poses[0])["rod 1"].shape == (2, 3)
    force = inverse_dynamics(robot, 1.0, poses, np.zeros(2), np.array([3.0, 0.0]))
    rod = 1600.0 * np.pi * (0.006**2 - 0.0045**2) * 0.5 + 2 * 0.05
    mass = 2 * (0.8 + rod) + 0.1 + 1.0
    assert np.abs(force.sum(axis=-1) - 3.0 * mass).max() < 1e-9  # slides, rods, tool and payload along x
