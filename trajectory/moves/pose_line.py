"""Moves on a straight line of the pose. They are planned along it, and slowed down until they keep the limits."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from kinematics import Array, Mechanism, actuator_motion, inverse_dynamics
from trajectory.errors import LimitsExceeded, MoveRefused
from trajectory.limits import Limits
from trajectory.moves.ruckig_plan import AxisLimits, fastest_move
from trajectory.moves.way import PARTS, ROUNDING, Way, axis_limits, peaks, require_in_ranges

_GRID = 201  # poses of a line, from which its first limits come
_ROUNDS = 30  # of slowing a line of the pose down
_SLOWER = 1.01  # at least, in each round


def of_pose(
    robot: Mechanism, ends: Array, limits: Limits, payload: float, period: float, wanted: dict[str, Any]
) -> Way:
    """The fastest move on the straight line between two poses (2, n): planned along it, and slowed until it fits.

    Raises:
        MoveRefused: the line leaves a range or the reach, or passes a singularity.
        LimitsExceeded: even a slow move breaks a limit.
    """
    along, count = ends[1] - ends[0], len(robot.joint_names)
    grid = ends[0] + np.linspace(0.0, 1.0, _GRID)[:, None] * along
    rest = np.zeros_like(grid)
    rate = np.abs(actuator_motion(robot, grid, np.broadcast_to(along, grid.shape), rest, rest).first)
    lost = ~np.isfinite(rate).all(axis=-1)
    if lost.any():
        raise MoveRefused("a limb out of reach", math.nan, grid[int(np.argmax(lost))].tolist())
    _require_regular(robot, grid)
    full = [np.array(limit) for limit in axis_limits(limits, count)]
    with np.errstate(divide="ignore"):
        of_line = [float(np.min(limit / rate.max(axis=0), initial=1e12)) for limit in full]
    slower = 1.0
    for _ in range(_ROUNDS):
        scaled = AxisLimits(*([limit / slower**power] for power, limit in enumerate(of_line, start=1)))
        profile = fastest_move(np.zeros(1), np.ones(1), scaled, period, PARTS, wanted)
        s, first, second = profile.position, profile.speed, profile.acceleration
        pose, velocity, acceleration = ends[0] + s * along, first * along, second * along
        joints = actuator_motion(robot, pose, velocity, acceleration, np.zeros_like(pose))
        torque = inverse_dynamics(robot, payload, pose, velocity, acceleration)
        way = Way.of(profile.times, (pose, velocity, acceleration), joints[:3], torque)
        require_in_ranges(robot, way, limits)
        found = peaks(robot, way, limits)
        if max(peak.ratio for peak in found.values()) <= 1.0 + ROUNDING:
            return way
        slower *= max(_SLOWER, *(peak.ratio ** (1 / limit.pace_power) for limit, peak in found.items()))
    raise LimitsExceeded.of_peaks({limit.name: peak for limit, peak in found.items() if peak.ratio > 1.0})


def _require_regular(robot: Mechanism, line: Array) -> None:
    """Check that a line of poses (k, n) keeps to one side of the parallel singularities.

    With more joints than freedoms no line separates two sides, and none is looked for.

    Raises:
        MoveRefused: naming the pose.
    """
    j_x = robot.jacobians(line)[1]
    if j_x.shape[-2] != j_x.shape[-1]:
        return
    sides = np.sign(np.linalg.det(j_x))
    across = (sides != sides[0]) | (sides == 0.0)
    if across.any():
        raise MoveRefused("a singularity", math.nan, line[int(np.argmax(across))].tolist())
