"""Forward model of the Gough-Stewart platform: Newton's method over arrays, and every assembly mode.

The iteration is the chapter's 8.6.4.2, with [8.20] solved instead of pseudo-inverted; being Newton's method it
converges quadratically from a pose near enough.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics import angles, displacement, rotation
from kinematics.robots.gough_stewart.assembly_modes import LostPaths, solver, turned_real
from kinematics.robots.gough_stewart.self_motion import SelfMotion, on_continuum, real_point

if TYPE_CHECKING:
    from kinematics.robots.gough_stewart.gough_stewart import GoughStewart
    from kinematics.robots.gough_stewart.six_legs import SixLegs


_ROUNDING = 1e-14  # leg error, relative to the sizes involved, that is not worth another step
_REAL = 1e-2  # imaginary part of a unit point below which a real pose may lie near
_SURELY_REAL = 4e-7  # and below which one lies there: a conjugate pair so close would not have been certified
_LONGEST_TURN = 0.5  # rotation of one step [rad], and its translation over the mean leg length


class ForwardSolution(NamedTuple):
    """The answer of Newton's method.

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
    return robot.moved(pose, change), np.abs(error).max(axis=1)


def matched_pose(base: Array, platform: Array, height: Array) -> Array:
    """(6,) pose with the platform's centroid `height` (3,) from the base's, turned to match it best.

    Args:
        base, platform: (6, 3) in the reference and in the tool frame.
    """
    a, b = base.mean(axis=0), platform.mean(axis=0)
    u, _, vt = np.linalg.svd((base - a).T @ (platform - b))
    turned = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt
    return np.concatenate([a + height - turned @ b, angles(turned[None])[0]])


def assembly_modes(robot: GoughStewart, joints: Array) -> Array:
    """(6,) -> (k, 6): nearly real solutions of the continuation, polished over the real numbers and proven.

    Raises:
        SelfMotion, LostPaths: as `GoughStewart.assembly_modes`.
    """
    if not np.isfinite(joints).all():
        return np.empty((0, 6))
    base, tool = robot.geometry.in_reference_frame(), robot.geometry.in_tool_frame()
    centres = base.mean(axis=0), tool.mean(axis=0)
    a, b = base - centres[0], tool - centres[1]
    unit = float(np.sqrt(np.mean(np.sum(a * a + b * b, axis=1))))

    def poses_of(points: Array) -> Array:
        turned, place = displacement(points)
        return np.concatenate([centres[0] + unit * place - turned @ centres[1], angles(turned)], axis=1)

    modes, squares = solver((a / unit).tobytes(), (b / unit).tobytes()), (joints / unit) ** 2
    ends, imaginary = turned_real(modes.ends(squares))
    _refuse_self_motion(modes.system(squares), ends, poses_of)
    near = imaginary < _REAL
    if not near.any():
        return np.empty((0, 6))
    starts = poses_of(ends[near].real)
    found = solve_forward(robot, np.broadcast_to(joints, starts.shape), starts, 60)
    dropped = ~found.converged & (imaginary[near] < _SURELY_REAL)
    if dropped.any():
        raise LostPaths("these leg lengths", f"{dropped.sum()} real poses that Newton's method leaves", "none")
    poses = found.pose[found.converged]
    if not len(poses):
        return np.empty((0, 6))
    gaps = apart(poses, poses, unit) - _uncertainty(robot, poses, unit)[:, None]
    poses = poses[[not (gaps[i, :i] < 0.0).any() for i in range(len(poses))]]
    order = np.argsort(apart(poses, robot.home[None], robot.characteristic_length)[:, 0], kind="stable")
    result: Array = poses[order]
    return result


def _refuse_self_motion(system: Array, ends: Array, poses_of: Callable[[Array], Array]) -> None:
    stuck = ends[on_continuum(system, ends) > 0]
    if not len(stuck):
        return
    real = real_point(system, stuck)
    if real is None:
        raise LostPaths("these leg lengths", "a continuum of complex poses, with no real one known", "isolated poses")
    raise SelfMotion(poses_of(real[0][None])[0], real[1])


def _uncertainty(robot: GoughStewart, poses: Array, unit: float) -> Array:
    """(k,) how far rounding may have moved a pose: on a singularity, a double pose is found as two near ones."""
    _, jacobian = robot.lengths_and_jacobian(poses)
    smallest = np.linalg.svd(jacobian * ([1.0] * 3 + [1.0 / unit] * 3), compute_uv=False)[:, -1]
    result: Array = 1e-9 + 1e-13 / np.maximum(smallest, 1e-7)
    return result


def apart(first: Array, second: Array, unit: float) -> Array:
    """(k, l) distance of poses: translation over `unit` and the chord of the rotation."""
    shift = np.linalg.norm(first[:, None, :3] - second[None, :, :3], axis=-1) / unit
    chord = rotation(first[:, 3:])[:, None] - rotation(second[:, 3:])[None]
    result: Array = shift + np.linalg.norm(chord, axis=(-2, -1))
    return result


def _solved(jacobian: Array, error: Array) -> Array:
    """(k, 6, 6) J^-1 and (k, 6) dq -> (k, 6); by the pseudo-inverse where one of them is exactly singular."""
    try:
        return np.linalg.solve(jacobian, error[..., None])[..., 0]
    except np.linalg.LinAlgError:
        result: Array = (np.linalg.pinv(np.nan_to_num(jacobian)) @ error[..., None])[..., 0]
        return result
