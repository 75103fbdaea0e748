"""More measured joints than freedoms: the pose that fits them best, and the faults that their differences show.

m joints and n freedoms leave m - n redundancy equations. To first order a disagreement is the parity vector V^T r, with
V an orthonormal basis of the left null space of J_m; a fault f of encoder i alone gives f v_i, v_i the i-th row of V,
its signature. Encoders with parallel signatures cannot be told apart. An encoder with v_i = 0 cannot be checked. The
check below does not linearise. It leaves out one encoder at a time and tests whether the others agree.
"""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.errors import InvalidValue
from kinematics.evaluation import evaluate
from kinematics.mathematics import adjugate, determinant
from kinematics.model.mechanism import Mechanism
from kinematics.model.programs import Build
from kinematics.model.symbolic_model import Model

_LAST_STEP = 1e-9  # of the robot's size; squared by the quadratic convergence, it is below rounding
_MOST_STEPS = 60
_FREE = 1e-12  # a normalised minor or singular value of which rounding is all that is left


class BestFit(NamedTuple):
    """A least-squares forward model's answer.

    Attributes:
        pose: (..., n), NaN where the iteration did not converge to a minimum, or the joints that weigh leave a
            direction free.
        residuals: (..., m) measured joints less the pose's own; NaN with the pose.
        steps: (...,) iterations taken.
    """

    pose: Array
    residuals: Array
    steps: Array


class EncoderCheck(NamedTuple):
    """The result of the check of the encoders, on the assumption that at most one of them is faulty.

    Several faults may look like one: of one of these encoders or, at a few poses, of a good encoder.

    Attributes:
        pose: (..., n) the best fit to all joints that are not suspected (to all, where none is); NaN where those do
            not determine it.
        residuals: (..., m) measured joints less those of the best fit to all [m or rad].
        consistent: (...,) all residuals are within `accuracy`. A fault stays hidden where it leaves no more than that:
            to first order, a fault f of encoder i leaves f max_j |v_i . v_j|.
        suspects: (..., m) encoders, each of which alone explains the disagreement, or could not be cleared as the fit
            without it did not converge. One: it is the faulty one. Several: they cannot be told apart. None, though
            not consistent: the assumption does not hold.
    """

    pose: Array
    residuals: Array
    consistent: Array
    suspects: Array

    @property
    def faulty(self) -> Array:
        """(...,) the faulty joint counted from 1; 0 where no single joint can be named."""
        return np.where(self.suspects.sum(axis=-1) == 1, self.suspects.argmax(axis=-1) + 1, 0)


def least_squares(robot: Mechanism, joints: Array, start: Array, weights: Array | None = None) -> BestFit:
    """Minimise the sum of w_i (joint_i - inverse_i(pose))^2 by Newton's method, damped where it would not descend.

    The second derivatives are exact, so it converges quadratically for joints that do not agree too.

    Args:
        joints: (..., m) measured.
        start: (..., n) a pose nearby, within reach.
        weights: (..., m) or (m,), 0 leaves a joint out; all 1 by default.
    """
    n, m = len(robot.pose_names), len(robot.joint_names)
    given = np.ones(m) if weights is None else np.asarray(weights, dtype=float)
    if not (np.isfinite(given).all() and (given >= 0.0).all()):
        raise InvalidValue("weights", given, "finite values >= 0")
    lead = np.broadcast_shapes(joints.shape[:-1], start.shape[:-1], given.shape[:-1])
    pose = np.broadcast_to(start, (*lead, n)).reshape(-1, n).copy()
    measured, weight = (np.broadcast_to(v, (*lead, m)).reshape(-1, m) for v in (joints, given))
    converged, steps = _iterate(robot, pose, measured, weight)
    pose[~converged] = np.nan
    residuals = measured - robot.inverse(pose)
    return BestFit(pose.reshape(*lead, n), residuals.reshape(*lead, m), steps.reshape(lead))


def _iterate(robot: Mechanism, pose: Array, measured: Array, weight: Array) -> tuple[Array, Array]:
    """Improve `pose` (k, n) in place; which rows converged (k,), and their numbers of steps (k,)."""
    count, n = pose.shape
    size = np.ones(n)
    size[list(robot.rotations)] = robot.characteristic_length
    converged, steps, damping = np.zeros(count, bool), np.zeros(count, int), np.zeros(count)
    program = robot.program(_newton)
    cost, step, _ = evaluate(program, pose, measured, weight, damping[:, None])
    cost, active = cost[:, 0], np.arange(count)
    for _ in range(_MOST_STEPS):
        active = active[np.isfinite(cost[active])]
        if not active.size:
            break
        trial = pose[active] + step[active]
        steps[active] += 1
        there = evaluate(program, trial, measured[active], weight[active], damping[active, None])[0][:, 0]
        better = there <= cost[active] * (1 + 1e-12)
        small = (np.abs(step[active]) * size).max(axis=-1) <= _LAST_STEP * robot.geometry.size
        done = small & (damping[active] == 0.0) & np.isfinite(there)
        moved = active[better | done]
        pose[moved], cost[moved] = trial[better | done], there[better | done]
        converged[active[done]] = True
        previous = damping[active]
        eased = np.where(previous > 1e-2, previous / 10, 0.0)
        damping[active] = np.where(better, eased, np.maximum(4 * previous, 1e-3))
        active = active[~done]
        if active.size:
            step[active] = evaluate(program, pose[active], measured[active], weight[active], damping[active, None])[1]
    minimum = evaluate(program, pose, measured, weight, damping[:, None])[2]
    return converged & (minimum > _FREE).all(axis=-1), steps


def _newton(_: Mechanism, model: Model) -> Build:
    """Cost, the damped step, and the Hessian's leading minors, each over the product of its diagonal.

    All positive: a minimum; near zero: a direction is free. Where the Hessian is not positive definite, its
    Gauss-Newton part J^T W J takes its place.
    """
    n, m = model.pose.shape[0], model.joints.shape[0]
    measured, weight = ca.SX.sym("measured", m), ca.SX.sym("weight", m)
    damping = ca.SX.sym("damping")
    residuals = measured - model.inverse
    cost = ca.dot(weight, residuals**2) / 2
    hessian, gradient = ca.hessian(cost, model.pose)
    slopes = ca.jacobian(model.inverse, model.pose)
    gauss = slopes.T @ ca.diag(weight) @ slopes
    product, minors = ca.SX(1), []
    for k in range(n):
        product *= ca.fabs(hessian[k, k])
        minors.append(determinant(hessian[: k + 1, : k + 1]) / product)
    definite = ca.mmin(ca.vertcat(*minors)) > 0
    matrix = ca.if_else(definite, hessian, gauss) + damping * ca.diag(ca.diag(gauss))
    cofactors, det = adjugate(matrix)
    return [model.pose, measured, weight, damping], [cost, -(cofactors @ gradient) / det, ca.vertcat(*minors)]


def check_encoders(robot: Mechanism, joints: Array, fit: BestFit, starts: Array, accuracy: float) -> EncoderCheck:
    """Which encoders may be faulty: those without which the others agree.

    Args:
        joints: (..., m) measured.
        fit: the best fit to all of them.
        starts: (..., s, n) further poses to look from, for a fault so large that the fit to all is far off.
        accuracy: the largest residual that sound encoders leave in a best fit [m or rad].
    """
    if not accuracy > 0.0:
        raise InvalidValue("accuracy", accuracy, "a value > 0")
    m = joints.shape[-1]
    consistent = _worst(fit.residuals) <= accuracy
    looks = np.concatenate([fit.pose[..., None, :], starts], axis=-2)[..., None, :]  # (..., 1 + s, 1, n)
    alone = least_squares(robot, joints[..., None, None, :], looks, 1.0 - np.eye(m))
    worst = _worst(np.where(np.eye(m, dtype=bool), 0.0, alone.residuals))  # (..., 1 + s, m)
    worst = np.where(np.isnan(alone.residuals).any(axis=-1), np.inf, worst)
    suspects = ((worst <= accuracy).any(axis=-2) | np.isinf(worst).all(axis=-2)) & ~consistent[..., None]
    lead, looked = worst.shape[:-2], worst.shape[-2] * m
    flat = worst.reshape(*lead, looked).argmin(axis=-1)[..., None, None]
    near = np.take_along_axis(alone.pose.reshape(*lead, looked, len(robot.pose_names)), flat, axis=-2)
    near = np.where(np.isnan(fit.pose), near[..., 0, :], fit.pose)
    best = least_squares(robot, joints, near, 1.0 - suspects).pose
    best[~_determined(robot.inverse_jacobian(best), 1.0 - suspects)] = np.nan
    return EncoderCheck(best, fit.residuals, consistent, suspects)


def _determined(j_m: Array, weights: Array) -> Array:
    """(...,) whether the joints that weigh fix every freedom: rank n of their rows, columns scaled to one."""
    rows = j_m * np.sqrt(weights)[..., None]
    good = np.asarray(np.isfinite(rows).all(axis=(-2, -1)))
    scaled = rows[good] / np.linalg.norm(rows[good], axis=-2, keepdims=True)
    determined = np.zeros_like(good)
    determined[good] = np.linalg.svd(scaled, compute_uv=False)[..., -1] > _FREE
    return determined


def _worst(residuals: Array) -> Array:
    worst: Array = np.abs(residuals).max(axis=-1)
    return worst


def fault_signatures(robot: Mechanism, pose: Array) -> Array:
    """(..., m, m - n) v_i, the parity vector of a unit fault of each encoder; |v_i| <= 1, NaN out of reach.

    The basis of the parity space is any orthonormal one: only lengths and angles between the rows have a meaning.
    """
    j_m = robot.inverse_jacobian(pose)
    m, n = j_m.shape[-2:]
    signatures = np.full((*j_m.shape[:-2], m, m - n), np.nan)
    good = np.isfinite(j_m).all(axis=(-2, -1))
    signatures[good] = np.linalg.svd(j_m[good])[0][..., n:]
    return signatures


def signature_angles(robot: Mechanism, pose: Array) -> Array:
    """(..., m, m) angle in [0, pi/2] between the signatures of every two encoders; 0: they cannot be told apart.

    NaN where a signature is zero (to rounding): that encoder cannot be checked.
    """
    v = fault_signatures(robot, pose)
    size = np.linalg.norm(v, axis=-1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = v / np.where(size > 1e-12, size, np.nan)
    cosine = unit @ np.swapaxes(unit, -1, -2)
    # |u_i - c u_j| is the sine, exact for small angles where the arc cosine is not
    sine = np.linalg.norm(unit[..., :, None, :] - cosine[..., None] * unit[..., None, :, :], axis=-1)
    result: Array = np.arctan2(sine, np.abs(cosine))
    return result
