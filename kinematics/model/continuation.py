"""The forward model near a known pose. It follows a straight line of the joints, by Newton's method in small steps.

The joints go from those of the known pose to the wanted ones. The pose follows without passing a singularity, so it
stays in its assembly mode. A step is accepted only if Newton's method contracts at once; else the step is halved. All
poses are followed together, each with its own step. If the line of the joints meets a singularity, `forward_near`
searches for a pose that a straight line of the pose leads to.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kinematics.arrays import Array, together
from kinematics.evaluation import evaluate
from kinematics.mathematics import determinant
from kinematics.model.pose_line import joined

if TYPE_CHECKING:
    from kinematics.model.mechanism import Mechanism
    from kinematics.model.programs import Build
    from kinematics.model.symbolic_model import Model

ForwardModel = Callable[[Array, Array], Array]  # of joints (k, m) and known poses (k, n)
# Sizes of a step of the pose: its angle [rad], or its length over the robot's size, whichever is larger.
_LONGEST = 0.25
_CORRECTED = 0.15  # the most that the first step of Newton's method may be, over the step that it corrects
_CONTRACTS = 0.5  # the most that a step of Newton's method may be, over the one before
_NEWTON = 8
_ROUGH = 1e-3  # a step of Newton's method that ends a best fit on the way
_ROUNDING = 1e-12
_CLOSED = 1e-11  # by what displacement a closure may be missed, in the same sizes
_SHORTEST = 1e-6  # share of the way; where a shorter step is needed, a singularity is ahead
_MOST = 400  # steps of any pose
_LAST = 0.02  # share of the way within which a way that gets stuck may end on a singularity
_HALVINGS = 60
_SINGULAR = 1e-6  # of the determinant where the way starts: below it rounding of a double root says nothing of the side
_FITS = 40  # steps of the best fit that looks for another pose


class State(NamedTuple):
    """Of k poses: how far the closure is open (k, m), J_x (k, m, n), J_q's diagonal (k, m), and J_x's determinant (k,).

    With more joints than freedoms it is the determinant of J_x^T J_x.
    """

    gap: Array
    j_x: Array
    j_q: Array
    determinant: Array


def continued(robot: Mechanism, joints: Array, near: Array) -> Array:
    """The poses with these joints that are reached from known poses without a singularity on the way.

    Args:
        joints: (..., m); an angle may differ by any number of turns.
        near: (n,) or (..., n) known poses, in any assembly mode, with limbs in the working mode.

    Returns:
        (..., n) poses; NaN if the known pose is out of reach, or if the way from it meets a singularity.
    """
    start, target = together(near, joints)
    lead = start.shape[:-1]
    pose, target = start.reshape(-1, start.shape[-1]).copy(), target.reshape(-1, target.shape[-1])
    first = robot.inverse(pose)
    way = np.where(np.isfinite(target), target, np.nan) - first
    turns = [k for k, unit in enumerate(robot.joint_units) if unit == "rad"]
    way[:, turns] -= 2 * np.pi * np.round(way[:, turns] / (2 * np.pi))
    done = _followed(robot, pose, first, way)
    stuck = np.flatnonzero((done < 1.0) & (done >= 1.0 - _LAST))
    side = state_at(robot, start.reshape(pose.shape)[stuck], first[stuck]).determinant
    pose[stuck] = _at_double_root(robot, pose[stuck], first[stuck] + way[stuck], side)
    pose[done < 1.0 - _LAST] = np.nan
    return pose.reshape(*lead, pose.shape[-1])


def forward_near(robot: Mechanism, joints: Array, near: Array) -> Array:
    """As `continued`; where the line of the joints meets a singularity, the pose to which a line of the pose leads.

    That pose has these joints too, and on the straight line to it from the known pose is no singularity: so it is on
    the same side. A best fit from the known pose looks for it, and then the mechanism's own forward model.

    Returns:
        (..., n); NaN where none is found.
    """
    return _elsewhere(robot, joints, near, lambda q, _: robot.working_forward(q), reached(robot, joints, near))


def reached(robot: Mechanism, joints: Array, near: Array) -> Array:
    """As `forward_near`, without the mechanism's own forward model, which may be this."""

    def fitted(joints: Array, pose: Array) -> Array:
        for _ in range(_FITS):
            pose = robot.moved(pose, _fitting(robot, state_at(robot, pose, joints)))
        return pose

    return _elsewhere(robot, joints, near, fitted, continued(robot, joints, near))


def _elsewhere(robot: Mechanism, joints: Array, near: Array, model: ForwardModel, found: Array) -> Array:
    """What was found (..., n); where that is NaN, the poses of a forward model to which a regular line leads."""
    start, target = together(near, joints)
    flat, n = found.reshape(-1, found.shape[-1]).copy(), found.shape[-1]
    start, target = start.reshape(-1, n), target.reshape(-1, target.shape[-1])
    lost = np.isnan(flat).any(axis=1) & np.isfinite(target).all(axis=1)
    rows = np.flatnonzero(lost & np.isfinite(robot.inverse(start)).all(axis=1))
    if rows.size:
        start, target = start[rows], target[rows]
        pose = model(target, start)
        flat[rows] = np.where(_leads_to(robot, start, pose, target)[:, None], pose, np.nan)
    return flat.reshape(found.shape)


def _leads_to(robot: Mechanism, start: Array, pose: Array, joints: Array) -> Array:
    """(k,) whether poses (k, n) have joints (k, m), and regular lines lead to them from other poses (k, n)."""
    closes = np.abs(robot.closure_gap(pose, joints)).max(axis=-1) <= _CLOSED
    before, after = state_at(robot, start, robot.inverse(start)), state_at(robot, pose, joints)
    same = (before.determinant * after.determinant > 0.0) & (before.j_q * after.j_q > 0.0).all(axis=1)
    leads: Array = closes & same & joined(robot, start, pose)
    return leads


def _fitting(robot: Mechanism, state: State) -> Array:
    """(k, n) Gauss-Newton steps, none longer than the longest."""
    inverse = np.linalg.pinv(np.nan_to_num(state.j_x * robot.pose_units()), rcond=1e-9)
    twist = np.einsum("kij,kj->ki", inverse, np.nan_to_num(state.gap)) * robot.pose_units()
    shorter: Array = twist * np.minimum(1.0, _LONGEST / np.maximum(_size(robot, twist), 1e-300))[:, None]
    return shorter


def _followed(robot: Mechanism, pose: Array, first: Array, way: Array) -> Array:
    """Move poses (k, n) along in place; how far each came (k,), 1 at its end."""
    done, step = np.zeros(len(pose)), np.ones(len(pose))
    active = np.flatnonzero(np.isfinite(way).all(axis=1) & np.isfinite(pose).all(axis=1))
    for _ in range(_MOST):
        if not active.size:
            break
        q, along = first[active], way[active]
        here = state_at(robot, pose[active], q + done[active, None] * along)
        twist = _solved(here, here.j_q * along)
        rate = _size(robot, twist)
        with np.errstate(divide="ignore"):
            share = np.minimum(np.minimum(step[active], 1.0 - done[active]), _LONGEST / rate)
        reached = np.where(share >= 1.0 - done[active], 1.0, done[active] + share)
        trial = robot.moved(pose[active], share[:, None] * twist)
        trial, good = _closed(robot, trial, q + reached[:, None] * along, share * rate, here.determinant, reached)
        moved = active[good]
        pose[moved], done[moved] = trial[good], reached[good]
        step[active] = np.where(good, 2.0 * share, 0.5 * share)
        active = active[(done[active] < 1.0) & (step[active] > _SHORTEST) & np.isfinite(rate)]
    return done


def _at_double_root(robot: Mechanism, pose: Array, joints: Array, side: Array) -> Array:
    """(k, n) where a way that got stuck before its end does end, on a singularity or before it; NaN where beyond.

    There Newton's method halves its error in each step. It may pass the singularity, to another assembly mode: the
    determinant must not have the other sign than where the way started, `side` (k,).
    """
    before = pose.copy()
    for _ in range(_HALVINGS):
        pose = robot.moved(pose, _fitting(robot, state_at(robot, pose, joints)))
    moved = _size(robot, pose - before)
    ends = (np.abs(robot.closure_gap(pose, joints)).max(axis=-1) <= 10 * _ROUNDING) & (moved <= _LONGEST)
    beyond = state_at(robot, pose, joints).determinant * side < -_SINGULAR * side**2
    return np.where((ends & ~beyond)[:, None], pose, np.nan)


def _closed(
    robot: Mechanism, pose: Array, joints: Array, moved: Array, side: Array, reached: Array
) -> tuple[Array, Array]:
    """Poses (k, n) after Newton's method, and where it converged to a pose of the same side of the singularities.

    Joints on the way have a pose only if they are as many as freedoms; else the best fit serves, roughly.
    """
    on_the_way = (reached < 1.0) & (joints.shape[1] > pose.shape[1])
    enough = np.where(on_the_way, _ROUGH, _ROUNDING)
    before = np.maximum(moved * _CORRECTED / _CONTRACTS, 1e3 * _ROUNDING)
    good, rounded = np.ones(len(pose), dtype=bool), np.zeros(len(pose), dtype=bool)
    for _ in range(_NEWTON):
        state = state_at(robot, pose, joints)
        twist = _solved(state, state.gap)
        size = _size(robot, twist)
        rounded |= size <= enough
        good &= rounded | (size <= _CONTRACTS * before)
        before = size
        pose = robot.moved(pose, np.where(good[:, None], twist, 0.0))
        if (rounded | ~good).all():
            break
    closes = on_the_way | (np.abs(robot.closure_gap(pose, joints)).max(axis=-1) <= _CLOSED)
    return pose, good & rounded & closes & (state_at(robot, pose, joints).determinant * side > 0.0)


def polished(robot: Mechanism, poses: Array, joints: Array, steps: int) -> Array:
    """Poses (k, n) near to those with joints (k, m), after Newton's method; NaN where the closure does not close."""
    for _ in range(steps):
        state = state_at(robot, poses, joints)
        poses = robot.moved(poses, np.nan_to_num(_solved(state, state.gap)))
    closes = np.abs(robot.closure_gap(poses, joints)).max(axis=-1) <= _CLOSED
    return np.where(closes[:, None], poses, np.nan)


def state_at(robot: Mechanism, pose: Array, joints: Array) -> State:
    """At poses (k, n) with joints (k, m)."""
    gap, j_x, j_q, det = evaluate(robot.program(_build), pose, joints)
    return State(gap, j_x, j_q, det[:, 0])


def _build(robot: Mechanism, model: Model) -> Build:  # noqa: ARG001
    m, n = model.j_x.shape
    det = determinant(model.j_x) if m == n else determinant(model.j_x.T @ model.j_x)
    return [model.pose, model.joints], [model.closure, model.j_x, model.j_q, det]


def _solved(state: State, right: Array) -> Array:
    """(k, n) twists t with J_x t = right (k, m), in the sense of least squares; NaN on a singularity."""
    matrix, n = state.j_x, state.j_x.shape[-1]
    if matrix.shape[-2] != n:
        right = np.einsum("kij,ki->kj", matrix, right)
        matrix = np.einsum("kij,kil->kjl", matrix, matrix)
    sound = (np.abs(state.determinant) > 0.0) & np.isfinite(matrix).all(axis=(-2, -1)) & np.isfinite(right).all(axis=-1)
    safe = np.where(sound[:, None, None], matrix, np.eye(n))
    return np.where(sound[:, None], np.linalg.solve(safe, np.nan_to_num(right)[..., None])[..., 0], np.nan)


def _size(robot: Mechanism, twist: Array) -> Array:
    """(k,) the largest angle [rad] or length over the robot's size."""
    largest: Array = np.abs(twist / robot.pose_units()).max(axis=-1)
    return largest
