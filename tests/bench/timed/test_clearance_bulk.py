"""The clearance in bulk against batched numpy and against the collision library FCL, in the same process.

Both peers get the ends of all bodies at every pose; Linkwright computes them too. All bodies here are capsules.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as ca
import fcl
import numpy as np
import pytest

from kinematics import Array, Heli4, Mechanism, Peppermill, Redundant3T1R, bulk, evaluate
from kinematics.margins.clearance.solids import rooms
from kinematics.mathematics import segment_distances

ROBOTS: dict[str, Mechanism] = {kind.__name__: kind() for kind in (Heli4, Redundant3T1R, Peppermill)}
COUNTS = {"linkwright": 100_000, "numpy": 4_000, "fcl": 100}


def poses_of(robot: Mechanism, count: int) -> Array:
    spread = np.random.default_rng(1).uniform(-0.05, 0.05, (count, len(robot.pose_names)))
    result: Array = robot.home + spread * robot.pose_units()
    return result


class Bodies:
    """Ends (k, bodies, 2, 3) and radii of all capsules, and which pairs must not touch."""

    def __init__(self, robot: Mechanism, poses: Array) -> None:
        pairs = rooms(robot).pairs
        solids = {id(solid): solid for pair in pairs for solid in pair}
        place = {number: i for i, number in enumerate(solids)}
        self.pairs = [(place[id(pair.one)], place[id(pair.two)]) for pair in pairs]
        model = robot.model()
        parts = ca.vertcat(*(ca.vertcat(ca.vec(s.core.corners), s.radius) for s in solids.values()))
        numbers = ca.substitute(parts, model.geometry, ca.SX(robot.geometry.vector()))
        found = evaluate(bulk(ca.Function("bodies", [model.pose], [ca.densify(numbers)])), poses)[0]
        found = found.reshape(len(poses), len(solids), 7)
        self.ends, self.radii = found[..., :6].reshape(len(poses), len(solids), 2, 3), found[0, :, 6]


def by_numpy(bodies: Bodies) -> Callable[[], Array]:
    def call() -> Array:
        rooms = [
            segment_distances(bodies.ends[:, i], bodies.ends[:, j]) - bodies.radii[i] - bodies.radii[j]
            for i, j in bodies.pairs
        ]
        result: Array = np.min(rooms, axis=0)
        return result

    return call


def by_fcl(bodies: Bodies) -> Callable[[], Array]:
    """Each body is one object, which is moved; the transforms are made before the clock runs."""
    along = bodies.ends[:, :, 1] - bodies.ends[:, :, 0]
    lengths = np.linalg.norm(along, axis=-1)
    z = along / lengths[..., None]
    x = np.cross(z, np.eye(3)[np.abs(z).argmin(axis=-1)])
    x /= np.linalg.norm(x, axis=-1, keepdims=True)
    frames, middles = np.stack([x, np.cross(z, x), z], axis=-1), bodies.ends.mean(axis=2)
    objects = [fcl.CollisionObject(fcl.Capsule(r, length)) for r, length in zip(bodies.radii, lengths[0], strict=True)]
    moves = [[fcl.Transform(f, m) for f, m in zip(*at, strict=True)] for at in zip(frames, middles, strict=True)]
    request = fcl.DistanceRequest(gjk_solver_type=fcl.GJKSolverType.GST_INDEP)

    def call() -> Array:
        found = np.empty(len(moves))
        for k, transforms in enumerate(moves):
            for one, transform in zip(objects, transforms, strict=True):
                one.setTransform(transform)
            found[k] = min(fcl.distance(objects[i], objects[j], request, fcl.DistanceResult()) for i, j in bodies.pairs)
        return found

    return call


def way(robot: Mechanism, name: str, poses: Array) -> Callable[[], Array]:
    if name == "linkwright":
        return lambda: robot.margin("clearance", poses)
    return {"numpy": by_numpy, "fcl": by_fcl}[name](Bodies(robot, poses))


@pytest.mark.parametrize("name", COUNTS)
@pytest.mark.parametrize("mechanism", ROBOTS)
def test_clearance(benchmark: Any, mechanism: str, name: str) -> None:
    robot, count = ROBOTS[mechanism], COUNTS[name]
    poses = poses_of(robot, count)
    benchmark.extra_info["poses"] = count
    benchmark.group = f"clearance {mechanism}"
    found = benchmark.pedantic(way(robot, name, poses), rounds=5, warmup_rounds=1)
    fcl_error = 2e-6 * robot.geometry.size
    assert np.abs(found - robot.margin("clearance", poses)).max() < (fcl_error if name == "fcl" else 1e-12)
