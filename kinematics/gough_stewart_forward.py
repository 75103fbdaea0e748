"""Forward model of the Gough-Stewart platform: Newton's method over arrays, and every assembly mode.

The iteration is the chapter's 8.6.4.2, with [8.20] solved instead of pseudo-inverted; being Newton's method it
converges quadratically from a pose near enough.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kinematics.gough_stewart_modes import solver
from kinematics.orientation import angles, rotation, turn
from kinematics.study import displacement

if TYPE_CHECKING:
    from kinematics.gough_stewart import GoughStewart

Array = np.ndarray

_ROUNDING = 1e-14  # leg error, relative to the sizes involved, that is not worth another step
_LONGEST_TURN = 0.5  # rotation of one step [rad], and its translation over the mean leg length


class ForwardSolution(NamedTuple):
    """What Newton's method found.

    Attributes:
        pose: (..., 6), NaN where it did not converge.
        converged: (...,) whether it did.
        iterations: (...,) steps taken.
        residual: (...,) largest error of a leg at the last iterate [m].
    """

    pose: Array
    converged: Array
    iterations: Array
    residual: Array


class SixLegs(Protocol):
    """A platform on six legs whose lengths are known, wherever their base joints are."""

    def leg_errors(self, pose: Array, joints: Array) -> tuple[Array, Array]:
        """(k, 6) what each leg lacks [m], and the inverse Jacobian (k, 6, 6) [8.20] of the legs."""

    def leg_sizes(self, joints: Array) -> tuple[Array, Array]:
        """(k,) mean leg length, and the largest number that rounding of an error comes from [m]."""


def solve_forward(robot: SixLegs, joints: Array, start: Array, iterations: int) -> ForwardSolution:
    """(..., 6) joints and (..., 6) starts."""
    lead = joints.shape[:-1]
    joints, pose = joints.reshape(-1, 6), np.array(start).reshape(-1, 6)
    taken, residual = np.zeros(len(pose), dtype=int), np.full(len(pose), np.nan)
    tolerance = _ROUNDING * robot.leg_sizes(joints)[1]
    active = np.flatnonzero(np.isfinite(joints).all(axis=1) & np.isfinite(pose).all(axis=1))
    for _ in range(iterations):
        if not active.size:
            break
        pose[active], error = step(robot, pose[active], joints[active])
        residual[active] = error
        taken[active] += 1
        active = active[np.isfinite(error) & ~(error <= tolerance[active])]
    residual = np.abs(robot.leg_errors(pose, joints)[0]).max(axis=1)
    converged = residual <= 10.0 * tolerance
    pose = np.where(converged[:, None], pose, np.nan)
    return ForwardSolution(*(a.reshape(lead + a.shape[1:]) for a in (pose, converged, taken, residual)))


def step(robot: SixLegs, pose: Array, joints: Array) -> tuple[Array, Array]:
    """One step of the iteration, [8.22]-[8.25]: (k, 6) poses and the largest leg error before it, (k,) [m]."""
    error, jacobian = robot.leg_errors(pose, joints)
    change = _solved(jacobian, error)
    size = np.linalg.norm(change[:, 3:], axis=1) + np.linalg.norm(change[:, :3], axis=1) / robot.leg_sizes(joints)[0]
    change *= np.minimum(1.0, _LONGEST_TURN / np.maximum(size, 1e-300))[:, None]
    turned = turn(change[:, 3:]) @ rotation(pose[:, 3:])
    return np.concatenate([pose[:, :3] + change[:, :3], angles(turned)], axis=1), np.abs(error).max(axis=1)


def assembly_modes(robot: GoughStewart, joints: Array) -> Array:
    """(6,) -> (k, 6): nearly real solutions of the continuation, polished over the real numbers and proven."""
    if not np.isfinite(joints).all():
        return np.empty((0, 6))
    base, tool = robot.geometry.in_reference_frame(), robot.geometry.in_tool_frame()
    centres = base.mean(axis=0), tool.mean(axis=0)
    a, b = base - centres[0], tool - centres[1]
    unit = float(np.sqrt(np.mean(np.sum(a * a + b * b, axis=1))))
    modes = solver((a / unit).tobytes(), (b / unit).tobytes())
    candidates = modes.nearly_real((joints / unit) ** 2)
    if not len(candidates):
        return np.empty((0, 6))
    turned, place = displacement(candidates)
    place = centres[0] + unit * place - turned @ centres[1]
    found = solve_forward(
        robot, np.broadcast_to(joints, (len(place), 6)), np.concatenate([place, angles(turned)], axis=1), 60
    )
    poses = found.pose[found.converged]
    if not len(poses):
        return poses
    gaps = apart(poses, poses, unit) - _uncertainty(robot, poses, unit)[:, None]
    poses = poses[[not (gaps[i, :i] < 0.0).any() for i in range(len(poses))]]
    order = np.argsort(apart(poses, robot.initial_pose[None], robot.characteristic_length)[:, 0], kind="stable")
    return poses[order]


def _uncertainty(robot: GoughStewart, poses: Array, unit: float) -> Array:
    """(k,) how far rounding may have moved a pose: on a singularity, a double pose is found as two near ones."""
    _, jacobian = robot.lengths_and_jacobian(poses)
    smallest = np.linalg.svd(jacobian * ([1.0] * 3 + [1.0 / unit] * 3), compute_uv=False)[:, -1]
    return 1e-9 + 1e-13 / np.maximum(smallest, 1e-7)


def apart(first: Array, second: Array, unit: float) -> Array:
    """(k, l) distance of poses: translation over `unit` and the chord of the rotation."""
    shift = np.linalg.norm(first[:, None, :3] - second[None, :, :3], axis=-1) / unit
    chord = rotation(first[:, 3:])[:, None] - rotation(second[:, 3:])[None]
    return shift + np.linalg.norm(chord, axis=(-2, -1))


def _solved(jacobian: Array, error: Array) -> Array:
    """(k, 6, 6) J^-1 and (k, 6) dq -> (k, 6); by the pseudo-inverse where one of them is exactly singular."""
    try:
        return np.linalg.solve(jacobian, error[..., None])[..., 0]
    except np.linalg.LinAlgError:
        return (np.linalg.pinv(np.nan_to_num(jacobian)) @ error[..., None])[..., 0]
