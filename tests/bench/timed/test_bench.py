"""Speed against a peer in the same run; the answers are compared too. `python -m tests.bench` prints the table."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pytest

from design.synthesis.nlp import solve
from design.synthesis.synthesis import synthesise
from tests.bench import peers
from tests.heli4_problem import PROBLEM, ROOM
from trajectory import AdeptCycle, Limits, jerk_limited, repair, time_optimal

COUNT = 200_000
ROBOT = PROBLEM.robot
POSES = ROOM.random(ROBOT.pose_names, COUNT, np.random.default_rng(1))
JOINTS = ROBOT.inverse(POSES)
BOUNDS = ROBOT.fvi_bounds
FVI = (BOUNDS.joint_speed, BOUNDS.joint_effort, BOUNDS.speed, BOUNDS.force, ROBOT.characteristic_length)
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
    poses = ROOM.spread(ROBOT.pose_names)
    benchmark.extra_info["poses"] = len(poses)
    start = ROBOT.geometry.vector()[PROBLEM.places()]
    solution = benchmark.pedantic(lambda: solve(PROBLEM, poses, start), rounds=3, warmup_rounds=1)
    assert solution.converged


def test_whole_synthesis(benchmark: Any) -> None:
    found = benchmark.pedantic(lambda: synthesise(PROBLEM, ROOM, starts=1), rounds=1)
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
