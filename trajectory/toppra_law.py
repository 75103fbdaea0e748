"""The time-optimal law on a fixed path by reachability analysis (toppra); the only module that imports toppra.

Pham and Pham, "A new approach to time-optimal path parameterization based on reachability analysis", IEEE T-RO 2018.
Along a path, with u = s'' and x = s'^2, every limit that is kept here is linear in (u, x):

    joint acceleration   q' u + q'' x
    torque               (tau(p, 0, p') - w) u + (tau(p, p', p'') - f - w) x + w + f,  w = tau(p, 0, 0)
    tool acceleration    p' u + p'' x, in the plane of the path's tangent and normal
    joint speed          |q'| sqrt(x),  tool speed  |p'| sqrt(x)

with a dash for the derivative by the path parameter and f the Coulomb friction, whose sign along the path is that of
q'; viscous friction is linear in sqrt(x), so this law refuses it. The coefficients are exact at the gridpoints, where
the limits are kept on both sides (toppra's interpolation scheme); in between they are kept to the order of the grid,
which `verify` measures. What it cannot keep, such as a jerk limit under its bang-bang s'', it refuses by name.
"""

from __future__ import annotations

import math

import numpy as np
from toppra import SimplePath
from toppra.algorithm import TOPPRA
from toppra.constraint import DiscretizationType, LinearConstraint
from toppra.constraint.linear_constraint import canlinear_colloc_to_interpolate
from toppra.interpolator import AbstractGeometricPath

from kinematics import InvalidValue, Mechanism
from kinematics.dynamics import inverse_dynamics
from kinematics.motion import actuator_motion
from trajectory.at_rest import require_possible
from trajectory.errors import TimingFailed
from trajectory.limits import Limits
from trajectory.path import Array, Path, places, require_poses_of
from trajectory.smoothness import require_smooth
from trajectory.timed import TimedPath
from trajectory.timing import TimeLaw

LEAST_INTERVALS = 1000
_REFUSED = {
    "jerk": "its s'' is bang-bang",
    "stall_torque": "the speed-torque line is not linear in u and x",
    "rms_torque": "it is a limit of the whole way, not of an instant",
}
_FACETS = 32  # of the half disc inside the tool acceleration's; the cap is kept and at most 0.12 % is given away
Coefficients = tuple[Array, Array, Array]  # a, b, c, each (N + 1, rows): |a u + b x + c| <= 1
Parameters = tuple[Array | None, ...]


def time_optimal(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int = 2000) -> TimedPath:
    """The fastest law from rest to rest on the path.

    Args:
        robot: any mechanism with the path's kind of pose.
        path: smooth, without a cusp.
        limits: of joints and tool; without jerk, speed-torque line and RMS torque.
        payload: mass at the tool [kg].
        intervals: N, of equal arc length, at least 1000.

    Raises:
        InvalidValue: a limit that it cannot keep, viscous friction where torque is limited, too few intervals, a
            negative payload, or another kind of pose.
        RoughPath: the path has a cusp or a kink.
        UnreachablePose: a limb cannot reach a pose of the path; the limb and its margin are named.
        PathBeyondLimit: a position beyond its range, or a weight beyond the torque at an end.
        TimingFailed: there is no law within the limits.
    """
    require_poses_of(robot, path)
    for name, why in _REFUSED.items():
        if getattr(limits, name) is not None:
            raise InvalidValue(
                f"Limits {name} for the toppra law", getattr(limits, name), f"no such limit, or another law: {why}"
            )
    viscous = robot.inertia.drive_train.viscous
    if limits.torque is not None and np.any(np.asarray(viscous) > 0.0):
        raise InvalidValue("DriveTrain viscous for the toppra law", viscous, "0: its limits are linear in s'^2, not s'")
    if intervals < LEAST_INTERVALS:
        raise InvalidValue("intervals of the toppra law", intervals, f"at least {LEAST_INTERVALS}")
    if not (math.isfinite(payload) and payload >= 0.0):
        raise InvalidValue("payload", payload, "a finite mass >= 0 kg")
    grid = np.linspace(0.0, 1.0, intervals + 1)
    require_smooth(path)
    derivatives = [d * path.length**k for k, d in enumerate(path.evaluate(path.length * grid, 2))]
    robot.require_reachable(derivatives[0])
    require_possible(robot, path, limits, payload, path.length * grid)
    bound, rows = _path_limits(robot, derivatives, limits, payload)
    asked = {**limits.as_dict(), "payload": payload, "intervals": intervals, "path": path.as_dict()}
    speed = _solve(grid, bound, rows, asked)
    return TimedPath(path, TimeLaw.constant_acceleration("toppra", path.length * grid, path.length * speed))


def _path_limits(
    robot: Mechanism, derivatives: list[Array], limits: Limits, payload: float
) -> tuple[Array, list[Coefficients]]:
    """Largest x (N + 1,), and the rows that bound u and x, over their limits."""
    pose, first, second = derivatives
    count = len(robot.joint_names)
    none = np.zeros_like(pose)
    joints = actuator_motion(robot, pose, first, second, none)
    speed = limits.of_joints("speed", count)
    with np.errstate(divide="ignore"):  # joints at rest bound nothing; `_solve` refuses what is not finite
        highest = (np.abs(joints.first) / speed).max(axis=-1) ** -2.0
    tool = places(robot.pose_names)
    tangent = np.linalg.norm(first[:, :tool], axis=-1)
    if limits.tool_speed is not None:
        highest = np.minimum(highest, (limits.tool_speed / tangent) ** 2)
    rows: list[Coefficients] = []
    acceleration, torque = limits.of_joints("acceleration", count), limits.of_joints("torque", count)
    if acceleration is not None:
        rows.append((joints.first / acceleration, joints.second / acceleration, none[:, :1] + np.zeros(count)))
    if torque is not None:
        weight = inverse_dynamics(robot, payload, pose, none, none)
        by_u = inverse_dynamics(robot, payload, pose, none, first) - weight
        ways = [inverse_dynamics(robot, payload, pose, way * first, second) for way in (1.0, -1.0)]
        by_x = sum(ways) / 2 - weight  # friction changes its sign with the way
        rows += [(by_u / torque, by_x / torque, (weight + f) / torque) for f in _coulomb(robot, joints.first)]
    if limits.tool_acceleration is not None:
        rows.append(_tool_rows(first[:, :tool], second[:, :tool], limits.tool_acceleration))
    return highest, rows


def _coulomb(robot: Mechanism, rates: Array) -> list[Array]:
    """(N + 1, m) friction before and after each gridpoint: it jumps where a joint turns back, and to 0 at rest."""
    train = robot.inertia.drive_train
    if not np.any(train.coulomb):
        return [np.zeros_like(rates)]
    padded = np.pad(rates, ((1, 1), (0, 0)))
    return [train.friction(padded[:-2])[0], train.friction(padded[2:])[0]]


def _tool_rows(first: Array, second: Array, cap: float) -> Coefficients:
    """The facets of a polygon inside the disc of the tool's acceleration; the normal part is never negative."""
    length = np.linalg.norm(first, axis=-1, keepdims=True)
    along = (second * first).sum(axis=-1, keepdims=True) / length
    normal = np.linalg.norm(second - along * first / length, axis=-1, keepdims=True)
    angles = (np.arange(_FACETS) + 0.5) * math.pi / _FACETS  # a vertex on the tangent: straight ahead all is used
    inside = cap * math.cos(math.pi / (2 * _FACETS))
    a = length * np.cos(angles) / inside
    b = (along * np.cos(angles) + normal * np.sin(angles)) / inside
    return a, b, np.zeros_like(a)


class SpeedBound(LinearConstraint):
    """0 <= x <= bound (N + 1,)."""

    def __init__(self, bound: Array) -> None:
        super().__init__()
        self.bound = bound
        self.set_discretization_type(DiscretizationType.Interpolation)

    def compute_constraint_params(self, path: AbstractGeometricPath, gridpoints: Array) -> Parameters:  # noqa: ARG002
        """toppra's (a, b, c, F, g, ubound, xbound)."""
        return None, None, None, None, None, None, np.stack([np.zeros_like(self.bound), self.bound], axis=-1)


class SymmetricRows(LinearConstraint):
    """|a u + b x + c| <= 1 at both ends of each interval."""

    def __init__(self, coefficients: Coefficients) -> None:
        super().__init__()
        self.identical = True
        self.coefficients = coefficients
        self.set_discretization_type(DiscretizationType.Interpolation)

    def compute_constraint_params(self, path: AbstractGeometricPath, gridpoints: Array) -> Parameters:  # noqa: ARG002
        """toppra's (a, b, c, F, g, ubound, xbound)."""
        eye = np.eye(self.coefficients[0].shape[1])
        sides = np.concatenate([eye, -eye])
        ones = np.ones(sides.shape[0])
        return canlinear_colloc_to_interpolate(*self.coefficients, sides, ones, None, None, gridpoints, identical=True)


def _solve(grid: Array, bound: Array, rows: list[Coefficients], asked: dict[str, object]) -> Array:
    """(N + 1,) speed of the normalised parameter [1/s]."""
    if not (np.isfinite(bound).all() and all(np.isfinite(c).all() for row in rows for c in row)):
        raise TimingFailed("toppra", asked, "the path's coefficients are not finite: a singular pose on it")
    # toppra asks for a path, but all that its algorithm reads from it is the interval [0, 1].
    unit = SimplePath(np.array([0.0, 1.0]), np.array([[0.0], [1.0]]))
    # In a unit of time in which u and x are about 1: the solver's tolerances are absolute.
    largest = [float(np.abs(a).max()) for a, _, _ in rows]  # 0 of a machine without masses
    unit_squared = min([float(bound.max()), *(1.0 / a for a in largest if a > 0.0)])
    scaled = [(a * unit_squared, b * unit_squared, c) for a, b, c in rows]
    constraints = [SpeedBound(bound / unit_squared), *(SymmetricRows(r) for r in scaled)]
    problem = TOPPRA(constraints, unit, gridpoints=grid, solver_wrapper="seidel")
    _, speed, _ = problem.compute_parameterization(0.0, 0.0)
    if speed is None or not np.isfinite(speed).all():
        raise TimingFailed("toppra", asked, f"no solution ({problem.problem_data.return_code.name})")
    return np.asarray(speed) * math.sqrt(unit_squared)
