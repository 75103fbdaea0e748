"""Why no motion along a path keeps its limits: somewhere a drive is too weak for the weight, or weight and friction."""

from __future__ import annotations

from typing import NoReturn

import numpy as np

from kinematics import Array, Mechanism, actuator_motion, inverse_dynamics
from trajectory.errors import TimingFailed
from trajectory.laws.at_rest import require_held
from trajectory.limits import Limits, MeanSquareLimit
from trajectory.paths import Path

_LOOKED_AT = 2001  # arc lengths


def refuse(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int) -> NoReturn:
    """Raise the error for a search that ended without a motion.

    Raises:
        PathBeyondLimit: somewhere the weight alone needs more torque than a drive has, and no motion was found that
            passes there.
        TimingFailed: any other case; the message says how much weight and friction, or the weight's RMS torque, need.
    """
    s = np.linspace(0.0, path.length, _LOOKED_AT)
    require_held(robot, path, limits, payload, s)
    poses, first = path.evaluate(s, 1)
    none = np.zeros_like(poses)
    weight = inverse_dynamics(robot, payload, poses, none, none)
    turning = actuator_motion(robot, poses, first, none, none).first
    friction = robot.inertia.drive_train.friction(turning)[0]
    found = f"the search did not settle on {intervals} intervals"
    for limit in limits:
        mean = isinstance(limit, MeanSquareLimit)
        what, torque = ("weight alone", weight) if mean else ("weight and friction", weight + friction)
        most = limit.holding_torque(limits, weight.shape[1])
        if most is not None and (np.abs(torque) >= most).any():
            found = f"no motion within {limit.fields[0].name}: {_lacking(robot, s, poses, torque, most, what)}"
            break
    raise TimingFailed("jerk", {**limits.as_dict(), "payload": payload, "path": path.as_dict()}, found)


def _lacking(robot: Mechanism, s: Array, poses: Array, torque: Array, most: Array, what: str) -> str:
    """The place where a drive lacks the most torque, in words."""
    k, joint = np.unravel_index(int((np.abs(torque) / most).argmax()), torque.shape)
    pose, unit = ", ".join(f"{v:.6g}" for v in poses[k]), {"rad": "N m", "m": "N"}[robot.actuator_units[joint]]
    asked = f"{torque[k, joint]:.6g} {unit} of {robot.actuator_names[joint]}, which has {most[joint]:.6g} {unit}"
    return f"at s = {s[k]:.6g} m, pose ({pose}), the {what} needs {asked}"
