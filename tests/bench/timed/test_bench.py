"""Speed against a peer in the same run; the answers are compared too. `python -m tests.bench` prints the table."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
import pytest

from design import Bounds, Cylinder, Requirement, SumLimit
from design.synthesis.nlp import Problem, solve
from design.synthesis.synthesis import synthesise
from kinematics import Heli4
from tests.bench import peers
from trajectory import AdeptCycle, Limits, jerk_limited, repair, time_optimal

COUNT = 200_000
REGION = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-math.pi, math.pi))
ROBOT = Heli4()
POSES = REGION.random(ROBOT.pose_names, COUNT, np.random.default_rng(1))
JOINTS = ROBOT.inverse(POSES)
BOUNDS = ROBOT.fvi_bounds
FVI = (BOUNDS.joint_speed, BOUNDS.joint_effort, BOUNDS.speed, BOUNDS.force, ROBOT.characteristic_length)
VARIABLES = {
    "base_radius": (0.20, 0.45),
    "platform_radius": (0.03, 0.08),
    "arm_length": (0.25, 0.50),
    "rod_length": (0.60, 1.00),
    "plate_offset": (0.02, 0.08),
    "pitch": (0.02, 0.12),
}
PROBLEM = Problem(
    robot=ROBOT,
    objective="fvi",
    variables=tuple(Bounds(name, 0, low, high) for name, (low, high) in VARIABLES.items()),
    requirements=(Requirement("reach", 0.01), Requirement("J_q", 0.3), Requirement("internal_determinant", 0.4)),
    sums=(SumLimit(("arm_length", "rod_length"), 1.151),),
    fvi_bounds=BOUNDS,
    characteristic_length=ROBOT.characteristic_length,
)
PAIRS = {
    "inverse": (lambda: ROBOT.inverse(POSES), lambda: peers.inverse(ROBOT.geometry, POSES)),
    "forward": (lambda: ROBOT.forward(JOINTS), lambda: peers.forward(ROBOT.geometry, JOINTS)),
    "fvi": (lambda: ROBOT.fvi(POSES), lambda: peers.fvi(ROBOT.geometry, POSES, *FVI)),
    "stiffness": (lambda: ROBOT.margin("stiffness", POSES), lambda: peers.stiffness(ROBOT, POSES)),
}


@pytest.mark.parametrize("who", ["linkwright", "numpy"])
@pytest.mark.parametrize("what", PAIRS)
def test_poses(benchmark: Any, what: str, who: str) -> None:
    ours, peer = PAIRS[what]
    benchmark.extra_info["poses"] = COUNT
    benchmark.group = what
    found = benchmark.pedantic(ours if who == "linkwright" else peer, rounds=5, warmup_rounds=1)
    np.testing.assert_allclose(found, (peer if who == "linkwright" else ours)(), rtol=1e-9, atol=1e-9)


def test_one_nlp(benchmark: Any) -> None:
    poses = REGION.spread(ROBOT.pose_names)
    benchmark.extra_info["poses"] = len(poses)
    start = ROBOT.geometry.vector()[PROBLEM.places()]
    solution = benchmark.pedantic(lambda: solve(PROBLEM, poses, start), rounds=3, warmup_rounds=1)
    assert solution.converged


def test_whole_synthesis(benchmark: Any) -> None:
    found = benchmark.pedantic(lambda: synthesise(PROBLEM, REGION, starts=1), rounds=1)
    benchmark.extra_info["rounds"] = len(found.rounds)
    assert found.after["fvi"].value > found.before["fvi"].value


@pytest.mark.parametrize("intervals", [1000, 2000, 4000, 8000])
def test_toppra(benchmark: Any, intervals: int) -> None:
    limits = Limits(speed=20.0, torque=127.0)
    timing = partial(time_optimal, ROBOT, AdeptCycle(), limits, 1.0, intervals=intervals)
    law = benchmark.pedantic(timing, rounds=3, warmup_rounds=1)
    benchmark.extra_info["half_cycle"] = law.duration


@pytest.mark.parametrize("intervals", [100, 200, 400])
def test_jerk_law(benchmark: Any, intervals: int) -> None:
    limits = Limits(speed=20.0, torque=127.0, jerk=1e5)
    timing = partial(jerk_limited, ROBOT, AdeptCycle(), limits, 1.0, intervals=intervals)
    law = benchmark.pedantic(timing, rounds=3, warmup_rounds=1)
    benchmark.extra_info["half_cycle"] = repair(ROBOT, law, limits, 1.0).motion.duration
