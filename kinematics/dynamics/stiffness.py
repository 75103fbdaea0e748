"""Cartesian stiffness by virtual work, from the statics of the limbs.

Under transmitted forces t, drives and members store the energy t^T C t / 2. A small motion v of the platform's freedoms
moves the points of these forces by W^T v, so t = C^-1 W^T v, and the platform meets the load K v, K = W C^-1 W^T. This
holds whether the limbs are as many as the freedoms or more.
"""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked
from kinematics.dynamics.drive_torque import moving_bodies, require_payload
from kinematics.errors import InvalidValue
from kinematics.evaluation import evaluate
from kinematics.machine import Cut
from kinematics.mathematics import adjugate, cholesky, lower_solved
from kinematics.model import Build, Mechanism, Model

_REGULAR = 1e12  # a condition number that an inverse bears


class Transmission(NamedTuple):
    """The forces that all limbs transmit to the platform, in the model's symbols `pose`, `joints` and `geometry`.

    Attributes:
        wrenches: (f, k) on the platform's freedoms, as in `LimbStatics`.
        compliance: (k, k) of members, joints and drives.
        cuts: the loads of the members for each of the k forces.
    """

    wrenches: ca.SX
    compliance: ca.SX
    cuts: list[Cut]


def transmission(robot: Mechanism) -> Transmission:
    """Of a robot, with its drives' stiffness."""
    model = robot.model()
    limbs = robot.statics(model.pose, model.joints, model.g)
    count, first, cuts = sum(limb.wrenches.shape[1] for limb in limbs), 0, []
    for limb in limbs:
        own = limb.wrenches.shape[1]
        before, after = ca.SX(3, first), ca.SX(3, count - first - own)
        for cut in limb.cuts:
            force, moment = (ca.horzcat(before, v, after) for v in (cut.force, cut.moment))
            cuts.append(cut._replace(force=force, moment=moment))
        first += own
    efforts = ca.horzcat(*(limb.efforts for limb in limbs))
    members = ca.diagcat(*(limb.compliance for limb in limbs))
    compliance = ca.sparsify(members + _drives_compliance(robot, model, efforts))
    return Transmission(ca.horzcat(*(limb.wrenches for limb in limbs)), compliance, cuts)


def _drives_compliance(robot: Mechanism, model: Model, efforts: ca.SX) -> ca.SX:
    """(k, k) of drives that bear the joints' efforts (m, k)."""
    stiffness = robot.inertia.drive_train.of_actuators("stiffness", efforts.shape[0])
    if not model.drives.is_eye():
        transposed, det = adjugate(model.drives.T)  # actuators and joints do the same work
        efforts = transposed @ efforts / det
    return efforts.T @ ca.diag(ca.sparsify(ca.DM(1 / stiffness))) @ efforts


def transmission_at_pose(robot: Mechanism) -> tuple[ca.SX, ca.SX] | None:
    """Wrenches (f, k) and compliance (k, k) at a pose; None if nothing gives way.

    Raises:
        InvalidValue: some forces meet only rigid parts, others do not.
    """
    wrenches, compliance, _ = transmission(robot)
    if compliance.nnz() == 0:
        return None
    rigid = [k + 1 for k in range(compliance.shape[0]) if compliance[k, k].is_zero()]
    if rigid:
        what = f"{type(robot).__name__} stiffness: transmitted force {rigid[0]} of {compliance.shape[0]}"
        raise InvalidValue(what, "only rigid parts", "a drive, joint or member that gives way for each force, or none")
    both = robot.model().at_pose(ca.horzcat(wrenches.T, compliance))
    return both[:, : wrenches.shape[0]].T, both[:, wrenches.shape[0] :]


def stiffness_symbolic(wrenches: ca.SX, compliance: ca.SX) -> ca.SX:
    """(f, f) W C^-1 W^T = H^T H with H = L^-1 W^T and C = L L^T, block by block of C."""
    count = wrenches.shape[0]
    result = ca.SX(count, count)
    for block in _blocks(compliance):
        half = lower_solved(cholesky(compliance[block, block]), wrenches[:, block].T)
        for i in range(count):
            for j in range(i + 1):
                result[i, j] += ca.dot(half[:, i], half[:, j])
    return ca.tril2symm(result)


def platform_stiffness(robot: Mechanism, pose: Array) -> Array:
    """(..., n) -> (..., f, f) of all freedoms of the platform: the twist, then those that the pose does not have.

    NaN where a limb cannot reach.

    Raises:
        InvalidValue: nothing gives way for some or for all of the transmitted forces.
    """
    return evaluate(robot.program(_platform_stiffness), checked(pose, "pose", robot.pose_names), blank=True)[0]


def tool_stiffness(robot: Mechanism, pose: Array) -> Array:
    """(..., n) -> (..., n, n) against forces and moments on the tool; what the pose does not have carries no load.

    NaN where a limb cannot reach, or where the tool has no stiffness at all in some direction.

    Raises:
        InvalidValue: as for `platform_stiffness`.
    """
    whole, n = platform_stiffness(robot, pose), len(robot.pose_names)
    good = np.isfinite(whole).all(axis=(-2, -1)) & (np.linalg.cond(np.where(np.isfinite(whole), whole, 0.0)) < _REGULAR)
    result = np.full((*whole.shape[:-2], n, n), np.nan)
    result[good] = np.linalg.inv(np.linalg.inv(whole[good])[..., :n, :n])
    return result


def mass_matrix(robot: Mechanism, payload: float, pose: Array) -> Array:
    """(..., n) -> (..., n, n) of the twist, with the motors: the kinetic energy is t^T M t / 2. NaN out of reach.

    Args:
        robot: a robot.
        payload: mass at the tool point [kg].
        pose: (..., n).

    Raises:
        InvalidValue: the payload is no mass.
    """
    require_payload(payload)
    poses = checked(pose, "pose", robot.pose_names)
    return evaluate(robot.program(_mass_matrix), poses, np.full((*poses.shape[:-1], 1), payload), blank=True)[0]


def _platform_stiffness(robot: Mechanism, model: Model) -> Build:
    found = transmission_at_pose(robot)
    if found is None:
        raise InvalidValue(f"{type(robot).__name__} stiffness", "only rigid parts", "drives or members that give way")
    return [model.pose], [stiffness_symbolic(*found), ca.sum1(robot.limb_roots(model.pose, model.g))]


def _mass_matrix(robot: Mechanism, model: Model) -> Build:
    payload = ca.SX.sym("payload")
    mass = ca.densify(mass_matrix_symbolic(robot, payload))
    return [model.pose, payload], [mass, ca.sum1(robot.limb_roots(model.pose, model.g))]


def mass_matrix_symbolic(robot: Mechanism, payload: float | ca.SX) -> ca.SX:
    """(n, n) of the twist at a pose: twice the kinetic energy of all bodies, motors too, is t^T M t."""
    model = robot.model()
    bodies, by_twist = moving_bodies(robot, model, payload), robot.pose_rate_map(model.pose)
    joint_rates = ca.diag(1 / model.j_q) @ model.j_x
    result = ca.SX(by_twist.shape[1], by_twist.shape[1])
    moved = [(particle.mass, particle.point) for particle in bodies.all_particles()]
    moved += [(rotor.inertia, rotor.angle) for rotor in bodies.rotors]
    for mass, place in moved:
        rate = ca.jacobian(place, model.joints) @ joint_rates + ca.jacobian(place, model.pose) @ by_twist
        result += mass * (rate.T @ rate)
    return model.at_pose(result)


def _blocks(matrix: ca.SX) -> list[list[int]]:
    """The rows of a symmetric matrix in groups that have no entry with another group's."""
    joined = np.array(ca.DM.ones(ca.sparsify(matrix).sparsity())) != 0.0
    left, groups = set(range(len(joined))), []
    while left:
        group, fresh = set[int](), {min(left)}
        while fresh:
            group |= fresh
            fresh = {int(k) for i in fresh for k in np.flatnonzero(joined[i])} - group
        groups.append(sorted(group))
        left -= group
    return groups
