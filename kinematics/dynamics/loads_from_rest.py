"""What members bear where the robot starts from rest with its own load, in the worst direction of its acceleration."""

from __future__ import annotations

from functools import reduce
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked
from kinematics.dynamics.buckling_and_yield import WorstDirection, bending_of
from kinematics.dynamics.member_loads import case_at_rest
from kinematics.evaluation import evaluate
from kinematics.model import Build, Mechanism, Model


class LoadsFromRest(NamedTuple):
    """What k members bear under `robot.load`, each in its own worst direction of the acceleration.

    Attributes:
        names: (k,) of the members.
        tension, compression: (..., k) the largest force along each, below 0 if it never pulls or pushes [N].
        bending: (..., k) the moment across it, at most [N m].
        torsion: (..., k) the moment about it [N m].
        joint_force: (..., k) the force in a joint of it, at most [N].
    """

    names: tuple[str, ...]
    tension: Array
    compression: Array
    bending: Array
    torsion: Array
    joint_force: Array

    def as_data(self) -> list[dict[str, Any]]:
        """A table of plain data for each member, of one pose."""
        names = ("member", *self._fields[1:])
        rows = zip(self.names, *(part.tolist() for part in self[1:]), strict=True)
        return [dict(zip(names, row, strict=True)) for row in rows]


def loads_from_rest(robot: Mechanism, pose: Array) -> LoadsFromRest:
    """The loads that the margin `strength` is about, (..., n) -> (..., k); NaN where a limb cannot reach.

    Of a vector A a + c, with |a| the load's acceleration and c what weights make of it, the length is at most
    |a| s + |c|, s the largest singular value of A. Along a member it is exact.
    """
    poses = checked(pose, "pose", robot.pose_names)
    cuts = [load.member for load in case_at_rest(robot).bearers]
    if not cuts:
        return LoadsFromRest((), *(np.zeros((*poses.shape[:-1], 0)) for _ in range(5)))
    along, forces = evaluate(robot.program(_of_cuts), poses)
    lost = np.isnan(along).any(axis=(-2, -1))
    forces = np.where(lost[..., None, None], 0.0, forces).reshape(*lost.shape, len(cuts), 2, 3, -1)
    largest = np.linalg.svd(forces[..., :-1], compute_uv=False)[..., 0]
    joint = robot.load.acceleration * largest + np.linalg.norm(forces[..., -1], axis=-1)
    values = np.concatenate([along, joint.max(axis=-1)[..., None]], axis=-1)
    values[lost] = np.nan
    names = tuple(dict.fromkeys(cuts))
    found = np.stack([values[..., [cut == name for cut in cuts], :].max(axis=-2) for name in names], axis=-2)
    return LoadsFromRest(names, *np.moveaxis(found, -1, 0))


def _of_cuts(robot: Mechanism, model: Model) -> Build:
    """One row for each cut, of all but the joints' forces; and those of both of its joints, (3, c) each."""
    size, case = WorstDirection(robot.load.acceleration), case_at_rest(robot)
    rows, forces = [], []
    for load in case.loads(case.shared()):
        push, pull = (reduce(ca.fmax, [size.most(sign * row) for row in load.tensions()]) for sign in (-1, 1))
        torsion = size.modulus(load.along.T @ load.moment)
        rows.append(ca.horzcat(pull, push, bending_of(load, size), torsion))
        joints = load.joint_forces()
        forces += [joints[0], joints[-1]]
    return [model.pose], [ca.densify(ca.vertcat(*rows)), ca.densify(ca.vertcat(*forces))]
