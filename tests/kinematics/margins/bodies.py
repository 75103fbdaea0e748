"""Independent distances: from the hull of all differences of corners, and from the library FCL."""

from __future__ import annotations

import casadi as ca
import fcl
import numpy as np
from scipy.optimize import nnls
from scipy.spatial import ConvexHull

from kinematics import Array, Measure, Mechanism
from kinematics.margins.clearance.solids import Pair, rooms


def signed_by_hull(one: Array, two: Array) -> float:
    """Distance of two hulls of corners (3, k); minus the depth: from the origin to the hull of all differences."""
    differences = (two[:, :, None] - one[:, None, :]).reshape(3, -1)
    if np.linalg.matrix_rank(differences - differences[:, :1], tol=1e-9) == 3:
        outside = ConvexHull(differences.T).equations[:, 3].max()
        if outside < 0.0:
            return float(outside)
    # The point of the hull that is nearest to the origin, by non-negative least squares with a heavy row for sum = 1.
    heavy = 1e5
    weights, _ = nnls(np.vstack([differences, np.full(differences.shape[1], heavy)]), np.array([0, 0, 0, heavy]))
    return float(np.linalg.norm(differences @ weights / weights.sum()))


def signed_by_fcl(one: Array, two: Array, radii: tuple[float, float]) -> float:
    """Distance between the surfaces of two capsules around segments (3, 2)."""
    request = fcl.DistanceRequest(gjk_solver_type=fcl.GJKSolverType.GST_INDEP)
    return float(fcl.distance(_capsule(one, radii[0]), _capsule(two, radii[1]), request, fcl.DistanceResult()))


def _capsule(ends: Array, radius: float) -> fcl.CollisionObject:
    along = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along)
    z = along / length
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    return fcl.CollisionObject(
        fcl.Capsule(radius, length), fcl.Transform(np.stack([x, np.cross(z, x), z], axis=1), ends.mean(axis=1))
    )


def components(robot: Mechanism, poses: Array) -> Array:
    """(k, pairs) every component of the clearance, by CasADi's own evaluation."""
    model = robot.model()
    parts = robot.margins["clearance"].components(robot, Measure(robot.fvi_bounds, robot.characteristic_length))
    function = ca.Function("parts", [model.pose, model.geometry], [parts])
    return np.array([np.array(function(pose, robot.geometry.vector()))[:, 0] for pose in poses])


def corners(robot: Mechanism, pairs: list[Pair], pose: Array) -> list[tuple[Array, Array, float, float]]:
    """Corners and radius of both bodies of each pair at a pose."""
    model, vector = robot.model(), robot.geometry.vector()
    outputs = [ca.SX(part) for pair in pairs for solid in pair for part in (solid.core.corners, solid.radius)]
    found = ca.Function("corners", [model.pose, model.geometry], outputs).call([pose, vector])
    numbers = [np.array(v) for v in found]
    return [
        (numbers[i], numbers[i + 2], numbers[i + 1].item(), numbers[i + 3].item()) for i in range(0, len(numbers), 4)
    ]


def between(robot: Mechanism, first: str, second: str, pose: Array) -> float:
    """The clearance of two members, by name."""
    pairs, walled, _ = rooms(robot)
    places = [pair.place for pair in pairs] + [room.place for room in walled]
    values = components(robot, np.array([pose]))[0]
    wanted = {f"{first} and {second}", f"{second} and {first}"}
    return float(min(value for place, value in zip(places, values, strict=True) if place in wanted))
