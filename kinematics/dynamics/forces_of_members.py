"""Forces and moments in the members along a motion, and the safety factors of the members there."""

from __future__ import annotations

from functools import reduce
from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked
from kinematics.dynamics.buckling_and_yield import LARGEST, Size, bending_of, safety_factors
from kinematics.dynamics.drive_torque import require_payload
from kinematics.dynamics.member_loads import case_in_motion
from kinematics.dynamics.stiffness import transmission
from kinematics.evaluation import evaluate
from kinematics.model import Build, Mechanism, Model


class MemberForces(NamedTuple):
    """What k members bear, each at the cut where that is largest.

    Attributes:
        names: (k,) of the members.
        tension: (..., k) the force along each [N], below 0 for compression.
        bending: (..., k) the moment across it [N m].
        torsion: (..., k) the moment about it [N m].
        joint_force: (..., k) the largest force in a joint of it [N].
        safety: (..., k) the smallest factor.
        buckling: (..., k) the factor against buckling alone, or `LARGEST` if it cannot buckle.
    """

    names: tuple[str, ...]
    tension: Array
    bending: Array
    torsion: Array
    joint_force: Array
    safety: Array
    buckling: Array


def member_forces(robot: Mechanism, payload: float, pose: Array, velocity: Array, acceleration: Array) -> MemberForces:
    """Forces and moments in the members along a motion, and how many times the load each could bear.

    Args:
        robot: any mechanism.
        payload: mass at the tool [kg].
        pose, velocity, acceleration: (..., n) the pose and its time derivatives.

    Returns:
        Of the members in the robot's `statics`, in their order; NaN where a limb cannot reach.

    Raises:
        InvalidValue: the payload is no mass.
    """
    motion = {"pose": pose, "velocity": velocity, "acceleration": acceleration}
    given = np.broadcast_arrays(*(checked(v, name, robot.pose_names) for name, v in motion.items()))
    require_payload(payload)
    lead, cuts = given[0].shape[:-1], [cut.member for cut in transmission(robot).cuts]
    if not cuts:
        return MemberForces((), *(np.zeros((*lead, 0)) for _ in range(6)))
    found = evaluate(robot.program(_of_cuts), *given, np.full((*lead, 1), payload))
    lost = np.isnan(found[-1]).any(axis=-1)
    names, parts = tuple(dict.fromkeys(cuts)), []
    for values in (found[0], -found[0], *found[1:4], -found[4], -found[5]):
        values[lost] = np.nan
        columns = [values[..., [cut == name for cut in cuts]].max(axis=-1) for name in names]
        parts.append(np.stack(columns, axis=-1))
    pull, push, bending, torsion, joint_force, least, buckling = parts
    tension = np.where(pull >= push, pull, -push)
    return MemberForces(names, tension, bending, torsion, joint_force, -least, -buckling)


def _of_cuts(robot: Mechanism, model: Model) -> Build:
    """The columns of `MemberForces`, one row for each cut."""
    velocity, acceleration = (ca.SX.sym(name, model.pose.numel()) for name in ("velocity", "acceleration"))
    payload, size = ca.SX.sym("payload"), Size()
    rows = []
    case = case_in_motion(robot, payload, velocity, acceleration)
    for load in case.loads(case.shared()):
        tension, *others = load.tensions()
        for other in others:
            tension = ca.if_else(ca.fabs(tension) >= ca.fabs(other), tension, other)
        joint = reduce(ca.fmax, [ca.norm_2(force) for force in load.joint_forces()])
        factors = safety_factors(load, size)
        safety, buckling = reduce(ca.fmin, list(factors.values())), factors.get("buckling", LARGEST)
        torsion = size.modulus(load.along.T @ load.moment)
        rows.append(ca.horzcat(tension, bending_of(load, size), torsion, joint, safety, buckling))
    table = ca.vertcat(*rows)
    return [model.pose, velocity, acceleration, payload], [table[:, k] for k in range(6)]
