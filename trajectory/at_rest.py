"""What a path asks for however it is travelled: the joints' positions, and the torque of the weight where it rests."""

from __future__ import annotations

import numpy as np

from kinematics import Mechanism
from kinematics.drives import to_actuators
from kinematics.dynamics import inverse_dynamics
from trajectory.errors import PathBeyondLimit
from trajectory.limits import Limits
from trajectory.path import Array, Path

_ROUNDING = 1e-9  # relative


def require_possible(robot: Mechanism, path: Path, limits: Limits, payload: float, s: Array) -> None:
    """Check the joints' position along a path, and the torque of the weight at both of its ends, where it rests.

    In between a motion may pass where the drives could not hold it.

    Args:
        robot: that reaches every pose of the path.
        path: of its poses.
        limits: of which position, torque and stall torque are looked at.
        payload: mass at the tool [kg].
        s: (k,) arc lengths where the position is looked at [m].

    Raises:
        PathBeyondLimit: a joint is beyond its range, or needs more torque at rest than it has.
    """
    count = len(robot.joint_names)
    if (ranges := limits.ranges(count)) is not None:
        (poses,) = path.evaluate(s, 0)
        _require(robot, "position", s, poses, to_actuators(robot, robot.inverse(poses)), ranges)
    ends = np.array([0.0, path.length])
    (poses,) = path.evaluate(ends, 0)
    for name in ("torque", "stall_torque"):
        if (most := limits.of_joints(name, count)) is not None:
            rest = np.zeros_like(poses)
            _require(robot, name, ends, poses, inverse_dynamics(robot, payload, poses, rest, rest), (-most, most))


def _require(robot: Mechanism, limit: str, s: Array, poses: Array, values: Array, ranges: tuple[Array, Array]) -> None:
    """Raise for the value that is furthest beyond its range, over the range's width."""
    low, high = ranges
    beyond = np.maximum(low - values, values - high) / (high - low)
    k, joint = np.unravel_index(int(beyond.argmax()), beyond.shape)
    if beyond[k, joint] > _ROUNDING:
        at_rest = limit != "position"
        unit = robot.actuator_units[joint]
        raise PathBeyondLimit(
            limit,
            robot.actuator_names[joint],
            float(s[k]),
            poses[k].tolist(),
            float(values[k, joint]),
            (float(low[joint]), float(high[joint])),
            {"rad": "N m", "m": "N"}[unit] + " at rest" if at_rest else unit,
        )
