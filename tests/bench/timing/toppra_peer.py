"""toppra as its own manual uses it: a spline through sampled poses, its constraints, its gridpoints, its trajectories.

Its path is one of poses, so that a limb's torque, which no forward model is needed for, is its `SecondOrderConstraint`;
the drives' speed and acceleration are linear constraints of the same kind.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from toppra import SplineInterpolator
from toppra.algorithm import TOPPRA
from toppra.constraint import DiscretizationType, LinearConstraint, SecondOrderConstraint
from toppra.interpolator import AbstractGeometricPath

from kinematics import actuator_motion, inverse_dynamics
from kinematics.arrays import Array
from tests.bench.timing.cases import Case
from trajectory import Path, PoseSpline, TimedPath, TimeLaw, TimingFailed

WAYPOINTS = 501
Dynamics = Callable[[Array, Array, Array], Array]


def defaults(case: Case) -> PoseSpline:
    """With its defaults: gridpoints of its choice, and `ParametrizeSpline`."""
    problem = problem_of(case, spline(case))
    found = problem.compute_trajectory(0.0, 0.0)
    if found is None:
        raise TimingFailed("toppra", {}, problem.problem_data.return_code.name)
    times, c = found.cspl.x, found.cspl.c
    ends = case.path.evaluate(np.array([0.0, case.path.length]), 0)[0]
    return PoseSpline("toppra, defaults", times, c[3], c[2], 2 * c[1], 6 * c[0], ends)


def constant_acceleration(case: Case, intervals: int | None = None) -> TimedPath:
    """By `ParametrizeConstAccel`, on the exact path; its own gridpoints, or so many equal intervals."""
    return solved(case, problem_of(case, spline(case), intervals))


def solved(case: Case, problem: TOPPRA) -> TimedPath:
    """The path by toppra's speeds at its gridpoints, s'' constant in between."""
    _, speed, _ = problem.compute_parameterization(0.0, 0.0)
    if speed is None:
        raise TimingFailed("toppra", {}, problem.problem_data.return_code.name)
    length = case.path.length
    law = TimeLaw.constant_acceleration("toppra, ParametrizeConstAccel", problem.gridpoints * length, speed * length)
    return TimedPath(case.path, law)


def spline(case: Case) -> SplineInterpolator:
    """toppra's own path: through poses at equal arc lengths, by the share of the length."""
    shares = np.linspace(0.0, 1.0, WAYPOINTS)
    return SplineInterpolator(shares, case.path.evaluate(shares * case.path.length, 0)[0])


class ExactPath(AbstractGeometricPath):
    """Our path with its own derivatives, by the share of the length."""

    def __init__(self, path: Path) -> None:
        self.path = path

    @property
    def dof(self) -> int:
        """Coordinates of the pose."""
        return len(self.path.pose_names)

    @property
    def path_interval(self) -> Array:
        """All of it."""
        return np.array([0.0, 1.0])

    def __call__(self, path_positions: Array, order: int = 0) -> Array:
        """The pose or a derivative."""
        length = self.path.length
        return self.path.evaluate(np.asarray(path_positions) * length, order)[order] * length**order


def problem_of(case: Case, path: AbstractGeometricPath, intervals: int | None = None) -> TOPPRA:
    """The case for toppra; without a number of intervals, on gridpoints of its choice."""
    grid = None if intervals is None else np.linspace(0.0, 1.0, intervals + 1)
    robot, payload, rows = case.robot, case.payload, []
    acceleration, torque = case.limit("acceleration"), case.limit("torque")
    if acceleration is not None:
        rows.append(
            _rows(lambda p, v, a: actuator_motion(robot, p, v, a, 0 * p).second, acceleration, len(robot.pose_names))
        )
    if torque is not None:
        rows.append(_rows(lambda p, v, a: inverse_dynamics(robot, payload, p, v, a), torque, path.dof))
    return TOPPRA([DriveSpeed(case), *rows], path, gridpoints=grid)


def _rows(value: Dynamics, limit: Array, coordinates: int) -> SecondOrderConstraint:
    """-limit <= value(pose, velocity, acceleration) <= limit."""
    count = limit.size
    sides, both = np.vstack([np.eye(count), -np.eye(count)]), np.tile(limit, 2)
    return SecondOrderConstraint(value, lambda _: sides, lambda _: both, coordinates)


class DriveSpeed(LinearConstraint):
    """The speed limits of the drives, which are no coordinates of the path."""

    def __init__(self, case: Case) -> None:
        super().__init__()
        self.case = case
        self.set_discretization_type(DiscretizationType.Collocation)

    def compute_constraint_params(self, path: AbstractGeometricPath, gridpoints: Array) -> tuple[Array | None, ...]:
        """toppra's (a, b, c, F, g, ubound, xbound)."""
        pose, first = path(gridpoints), path(gridpoints, 1)
        none = np.zeros_like(pose)
        rates = actuator_motion(self.case.robot, pose, first, none, none).first
        with np.errstate(divide="ignore"):
            most = (np.abs(rates) / self.case.limit("speed")).max(axis=-1) ** -2.0
        return None, None, None, None, None, None, np.stack([np.zeros_like(most), most], axis=-1)
