"""Why no motion along a path keeps its limits: somewhere the weight, or weight and friction, is beyond a drive."""

from __future__ import annotations

import numpy as np

from kinematics import Mechanism
from kinematics.dynamics import inverse_dynamics
from kinematics.motion import actuator_motion
from trajectory.errors import TimingFailed, WeightBeyondDrive
from trajectory.limits import Limits
from trajectory.path import Path

_LOOKED_AT = 2001  # arc lengths
_LIMITS = ("torque", "stall_torque", "rms_torque")


def refused(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int) -> TimingFailed:
    """The error for a search that ended without a motion on so many intervals.

    It names place, joint, limit and torque where a drive lacks most, if one lacks anything to move slowly.
    """
    asked = {**limits.as_dict(), "payload": payload, "path": path.as_dict()}
    s = np.linspace(0.0, path.length, _LOOKED_AT)
    poses, first = path.evaluate(s, 1)
    none = np.zeros_like(poses)
    weight = inverse_dynamics(robot, payload, poses, none, none)
    turning = actuator_motion(robot, poses, first, none, none).first
    friction = robot.inertia.drive_train.friction(turning)[0]
    for what, torque in (("weight alone", weight), ("weight and friction", weight + friction)):
        for name in _LIMITS:
            if (limit := limits.of_joints(name, weight.shape[1])) is None:
                continue
            k, joint = np.unravel_index(int((np.abs(torque) / limit).argmax()), torque.shape)
            if abs(torque[k, joint]) >= limit[joint]:
                at, pose, drive = float(s[k]), poses[k].tolist(), robot.actuator_names[joint]
                found, unit = float(torque[k, joint]), robot.actuator_units[joint]
                return WeightBeyondDrive("jerk", asked, name, what, at, pose, drive, found, float(limit[joint]), unit)
    return TimingFailed("jerk", asked, f"the search did not settle on {intervals} intervals")
