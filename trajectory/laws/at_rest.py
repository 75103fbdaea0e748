"""What a path needs at any speed: the joints' positions, and the torque of the weight where it rests."""

from __future__ import annotations

import numpy as np

from kinematics import Array, Mechanism, inverse_dynamics, to_actuators
from trajectory.errors import PathBeyondLimit
from trajectory.limits import JOINT_RANGES, InstantLimit, Limit, Limits
from trajectory.paths import Path

_ROUNDING = 1e-9  # relative


def require_possible(robot: Mechanism, path: Path, limits: Limits, payload: float, s: Array) -> None:
    """Check the joints' position along a path, and the torque of the weight at both of its ends, where it rests.

    Between the ends, a motion at speed may pass places where the drives could not hold the weight.

    Args:
        robot: a robot that reaches every pose of the path.
        path: a path of its poses.
        limits: the limits; joint ranges and the torque that they leave at rest are checked.
        payload: mass at the tool [kg].
        s: (k,) arc lengths where the position is checked [m].

    Raises:
        PathBeyondLimit: a joint is outside its range, or needs more torque at rest than it has.
    """
    count = len(robot.joint_names)
    if (ranges := limits.ranges(count)) is not None:
        (poses,) = path.evaluate(s, 0)
        positions = to_actuators(robot, robot.inverse(poses))
        _require(robot, path, JOINT_RANGES, s, positions, ranges)
    require_held(robot, path, limits, payload, np.array([0.0, path.length]))


def require_held(robot: Mechanism, path: Path, limits: Limits, payload: float, s: Array) -> None:
    """Check the torque of the weight at rest.

    Args:
        robot, path, limits, payload: as for `require_possible`.
        s: (k,) arc lengths [m].

    Raises:
        PathBeyondLimit: a joint needs more torque at rest than it has.
    """
    (poses,) = path.evaluate(s, 0)
    rest = np.zeros_like(poses)
    for limit in limits:
        most = limit.holding_torque(limits, len(robot.joint_names)) if isinstance(limit, InstantLimit) else None
        if most is not None:
            _require(robot, path, limit, s, inverse_dynamics(robot, payload, poses, rest, rest), (-most, most))


def _require(robot: Mechanism, path: Path, limit: Limit, s: Array, values: Array, ranges: tuple[Array, Array]) -> None:
    """Raise for the value that is furthest outside its range, relative to the range's width."""
    low, high = ranges
    beyond = np.maximum(low - values, values - high) / (high - low)
    k, joint = np.unravel_index(int(beyond.argmax()), beyond.shape)
    if beyond[k, joint] > _ROUNDING:
        unit, at = robot.actuator_units[joint], float(s[k])
        raise PathBeyondLimit(
            limit.fields[0].name,
            limit.of_torque,
            robot.actuator_names[joint],
            at,
            path.evaluate(s[k], 0)[0].tolist(),
            float(values[k, joint]),
            (float(low[joint]), float(high[joint])),
            {"rad": "N m", "m": "N"}[unit] if limit.of_torque else unit,
            path.waypoint(at),
        )
