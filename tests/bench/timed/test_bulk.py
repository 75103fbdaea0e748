"""The FVI in bulk against CasADi's own map of the same expression and against batched numpy, in the same process."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
import pytest

from kinematics import Array, Mechanism, Redundant3T1R
from kinematics.model.indices import fvi, homogeneous
from tests.bench import peers
from tests.bench.certificates import CASES

COUNT = 200_000
# One region a mechanism: those whose FVI or determinant is certified.
REGIONS = {type(robot).__name__: (robot, region) for robot, region, *_ in CASES}
POSES = {
    name: region.random(robot.pose_names, COUNT, np.random.default_rng(1)) for name, (robot, region) in REGIONS.items()
}


def numpy_fvi(robot: Mechanism, poses: Array) -> Callable[[], Array]:
    assert isinstance(robot, Redundant3T1R)
    b = robot.fvi_bounds
    wanted = (b.joint_speed, b.joint_effort, b.speed, b.force, robot.characteristic_length)
    return lambda: peers.redundant_fvi(robot.geometry, poses, *wanted)


def casadi_fvi(robot: Mechanism, poses: Array, *mode: object) -> Callable[[], Array]:
    """`Function.map` with its buffers given once, which spares it the conversion of every call."""
    model, pose = robot.model(), ca.SX.sym("pose", len(robot.pose_names))
    j_mw = homogeneous(model.actuator_jacobian, robot.rotations, robot.characteristic_length)
    symbolic = ca.Function("fvi", [model.pose, model.geometry], [fvi(j_mw, robot.fvi_bounds)])
    mapped = ca.Function("fvi", [pose], [ca.cse(symbolic(pose, robot.geometry.vector()))]).map(len(poses), *mode)
    buffer, run = mapped.buffer()
    given, found = np.ascontiguousarray(poses), np.zeros(len(poses))  # a row of poses is a column of CasADi's
    buffer.set_arg(0, memoryview(given.reshape(-1)))
    buffer.set_res(0, memoryview(found))

    def call() -> Array:
        run()
        return found

    call.kept = buffer, given  # type: ignore[attr-defined]
    return call


WAYS: dict[str, Callable[[Mechanism, Array], Callable[[], Array]]] = {
    "linkwright": lambda robot, poses: lambda: robot.fvi(poses),
    "casadi serial": lambda robot, poses: casadi_fvi(robot, poses, "serial"),
    "casadi thread": lambda robot, poses: casadi_fvi(robot, poses, "thread", os.cpu_count()),
    "numpy": numpy_fvi,
}


PAIRS = [(name, way) for name in REGIONS for way in WAYS if way != "numpy" or name == "Redundant3T1R"]


@pytest.mark.parametrize(("name", "way"), PAIRS)
def test_fvi(benchmark: Any, name: str, way: str) -> None:
    robot, poses = REGIONS[name][0], POSES[name]
    call = WAYS[way](robot, poses)
    benchmark.extra_info["poses"] = COUNT
    benchmark.group = f"fvi {name}"
    rounds = {"linkwright": 20, "numpy": 2}.get(way, 5)
    found = benchmark.pedantic(call, rounds=rounds, warmup_rounds=0 if way == "numpy" else 1)
    ours = robot.fvi(poses)
    assert np.abs((found - ours) / np.maximum(1.0, np.abs(ours))).max() < 1e-12
