"""Moves of the joints. The pose is followed from the start of the move, so that it stays in its assembly mode."""

from __future__ import annotations

import numpy as np

from kinematics import Array, Mechanism, actuator_motion, continued, from_actuators, inverse_dynamics
from trajectory.errors import MoveRefused
from trajectory.moves.ruckig_plan import Profile
from trajectory.moves.way import Way

_SAME_JOINTS = 1e-7  # rad, or of the robot's size: how far joints may be from those of their own pose
_SWING = 1.5  # rad


def of_joints(robot: Mechanism, profile: Profile, near: Array, payload: float) -> Way:
    """The poses of joints that move by a profile, followed from a pose near its start.

    Raises:
        MoveRefused: a pose on the way does not exist, or belongs to another working mode.
    """
    own = from_actuators(robot, profile.position)
    pose = _followed(robot, own, near)
    missing = ~np.isfinite(pose).all(axis=-1)
    if missing.any():
        k = int(np.argmax(missing))
        raise MoveRefused(
            "no pose that the robot reaches without passing a singularity",
            float(profile.times[k]),
            pose[max(k - 1, 0)].tolist(),
        )
    unit = np.array([1.0 if name == "rad" else robot.geometry.size for name in robot.joint_units])
    away = ~((np.abs(robot.inverse(pose) - own) / unit).max(axis=-1) <= _SAME_JOINTS)
    if away.any():
        k = int(np.argmax(away))
        raise MoveRefused("another working mode", float(profile.times[k]), pose[k].tolist())
    # The pose's velocity and acceleration solve q' = J v and q'' = J a + J' v.
    jacobian, none = robot.actuator_jacobian(pose), np.zeros_like(pose)
    rates = robot.pose_rates(pose)
    velocity = np.einsum("kij,kj->ki", rates, np.linalg.solve(jacobian, profile.speed[..., None])[..., 0])
    bias = actuator_motion(robot, pose, velocity, none, none).second
    left = np.linalg.solve(jacobian, (profile.acceleration - bias)[..., None])[..., 0]
    acceleration = np.einsum("kij,kj->ki", rates, left)
    torque = inverse_dynamics(robot, payload, pose, velocity, acceleration)
    joints = profile.position, profile.speed, profile.acceleration
    return Way.of(profile.times, (pose, velocity, acceleration), joints, torque)


def _followed(robot: Mechanism, joints: Array, near: Array) -> Array:
    """(k, n) poses of joints (k, m), from one near the first on: each found from one less than half a turn away."""
    turns = [unit == "rad" for unit in robot.joint_units]
    first = continued(robot, joints[0], near)
    parts = (np.abs(joints - joints[0])[:, turns].max(axis=1, initial=0.0) // _SWING).astype(int)
    pose, last = np.empty((len(joints), len(robot.pose_names))), first
    for part in range(parts.max() + 1):
        rows = np.flatnonzero(parts == part)
        if rows.size:
            pose[rows] = continued(robot, joints[rows], last)
            last = pose[rows[-1]]
    return pose


def require_at(robot: Mechanism, way: Way, target: Array) -> None:
    """Check that a way ends at its target: in another assembly mode the same joints belong to another pose.

    Raises:
        MoveRefused: it ends elsewhere.
    """
    end = way.motion.tool.pose[-1]
    if not float(robot.apart(end, target)) <= _SAME_JOINTS:
        raise MoveRefused("an end in another assembly mode than the target", float(way.times[-1]), end.tolist())
