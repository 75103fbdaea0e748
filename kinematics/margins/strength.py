"""Strength: how many times the load of its members a robot could bear before one of them buckles or yields."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.dynamics import (
    LARGEST,
    LoadCase,
    MemberLoad,
    Slack,
    WorstDirection,
    case_at_rest,
    demands,
    safety_factors,
)
from kinematics.machine import Cut
from kinematics.mathematics import near_inverse, row_sums
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow

_REGULAR = 1e-6  # what must be left of 1, which stands for an inverse in the middle of a box


class Strength(Margin):
    """The smallest safety factor of all members; 1 is the limit.

    The load is `robot.load`: its payload, accelerated by its acceleration in the worst direction, from rest, and the
    weights. It is infinite for a mechanism without the hook `statics`.
    """

    name = "strength"
    records = ("inertia", "structure", "load")
    words = "smallest safety factor of the members against buckling and yield, under the robot's load"
    of_members = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """Of each rod, buckling and yield; of each cut of an arm, yield."""
        size, case = WorstDirection(robot.load.acceleration), case_at_rest(robot)
        factors = [f for load in case.loads(case.shared()) for f in safety_factors(load, size).values()]
        return ca.vertcat(*factors) if factors else ca.SX(math.inf)

    def places(self, robot: Mechanism) -> list[str] | None:
        """The member of each component, and by what it fails; None without the hook `statics`."""
        size = WorstDirection(robot.load.acceleration)
        bearers = case_at_rest(robot).bearers
        return [f"{own.member}, {what}" for own in bearers for what in safety_factors(own, size)] or None

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """Capacity - c load >= 0, with t = W^-1 Q enclosed by `_Enclosed`, and an arm's bending by `_Turned`.

        For c <= 0 it says only that there are finite forces, as the factor is never negative.
        """
        case, acceleration = case_at_rest(robot), robot.load.acceleration
        if not case.cuts:
            return super().to_show(robot, claim, inside, positive)
        system, bent = _system(case), [across for load in case.loads(case.shared()) for across in _across(load)]
        count, directions = system.matrix.shape[0], bent[0].shape[1]
        rows = max(count, 3)
        scaling = ca.SX.sym("scaling", rows, count + directions * len(bent))
        turns = [scaling[:directions, k : k + directions] for k in range(count, scaling.shape[1], directions)]
        size = _Turned(acceleration, iter(turns))
        enclosed = _Enclosed.of(system, scaling[:count, :count], size)
        shown = [enclosed.left - _REGULAR, LARGEST - claim.bound]
        for cut, load in zip(case.cuts, case.loads(enclosed.forces), strict=True):
            needs = demands(load, size, enclosed.slack(cut))
            shown += [capacity - claim.bound * need for capacity, need in needs.values()]
        at_middle = ca.horzcat(*(_high(matrix, rows) for matrix in (system.matrix, *bent)))
        return ToShow(ca.vertcat(*shown, *size.rows), scaling, at_middle, partial(_chosen, count, directions))


def _across(load: MemberLoad) -> list[ca.SX]:
    """What `_Turned.norm` is asked for, in its order, without the weights."""
    return [ca.skew(load.along) @ vectors[:, :-1] for vectors in load.ends or (load.moment,)]


class _System(NamedTuple):
    """matrix z = needed; the first `forces` of z are the transmitted forces."""

    matrix: ca.SX
    needed: ca.SX
    forces: int


def _system(case: LoadCase) -> _System:
    """W t = Q; or, of more forces than freedoms, C t = W^T v too, with the platform's displacement v in a unit that
    makes its forces and t comparable.
    """
    f, k = case.wrenches.shape
    if f == k:
        return _System(case.wrenches, case.needed, k)
    unit = ca.trace(case.compliance) / k
    above = ca.horzcat(case.compliance / unit, -case.wrenches.T)
    matrix = ca.vertcat(above, ca.horzcat(case.wrenches, ca.SX(f, f)))
    return _System(matrix, ca.vertcat(ca.SX(k, case.needed.shape[1]), case.needed), k)


class _Enclosed(NamedTuple):
    """z with M z = Q, without an inverse: with any S and E = S M - 1, z = S Q - E z.

    So z_i is within sum_j |E_ij| |z_j| of (S Q)_i, and no |z_j| is more than the largest |S Q| over 1 - |E|. S is near
    M^-1 in the middle of a box, so that E is small. A row's modulus is what an acceleration in its worst direction and
    the weights make of it.

    Attributes:
        forces: (k, c) the first rows of S Q.
        off: (k,) how far each may be from the transmitted force.
        left: 1 - |E|, which must be above 0.
    """

    forces: ca.SX
    off: ca.SX
    left: ca.SX

    @classmethod
    def of(cls, system: _System, scaling: ca.SX, size: WorstDirection) -> _Enclosed:
        first = scaling @ system.needed
        n, k = scaling.shape[0], system.forces
        error = scaling @ system.matrix - ca.SX.eye(n)
        found, moduli = first - error @ first, ca.fabs(error)
        lengths = ca.sqrt(ca.sum2(scaling * scaling))
        units = ca.SX.ones(n) if n == k else ca.sqrt(lengths)  # any will do; so displacements do not dwarf the forces
        away = (moduli @ units) / units
        sizes = ca.vertcat(*(size.modulus(first[i, :]) for i in range(n)))
        largest, left = ca.mmax(sizes / units), 1 - ca.mmax(away)
        off = moduli @ (moduli @ (sizes + away * units * largest / left))
        return cls(found[:k, :], off[:k], left)

    def slack(self, cut: Cut) -> Slack:
        """What a cut may bear besides."""
        tension, torsion = (ca.fabs(cut.along.T @ v) @ self.off for v in (cut.force, cut.moment))
        across = ca.skew(cut.along) @ cut.moment
        return Slack(tension, ca.sqrt(ca.sum1(across * across)) @ self.off, torsion)


class _Turned(WorstDirection):
    """With |A|^2 <= g / h in place of the largest singular value A: of any V, g is the largest row sum of moduli of
    (A V)^T A V, and h > 0 the smallest of V^T V with those beside the diagonal negative (both by Gershgorin).

    V nearly diagonalises A^T A in the middle of a box.

    Attributes:
        rows: what must be above 0 so that this holds.
    """

    def __init__(self, acceleration: float, turns: Iterator[ca.SX]) -> None:
        super().__init__(acceleration)
        self._turns, self.rows = turns, list[ca.SX]()

    def norm(self, vectors: ca.SX) -> ca.SX:
        """As in `WorstDirection`, or a little more."""
        turn = next(self._turns)
        turned = vectors[:, :-1] @ turn
        most = ca.mmax(ca.sum2(ca.fabs(turned.T @ turned)))
        least = ca.mmin(row_sums(turn.T @ turn))
        self.rows.append(least - _REGULAR)
        return self.acceleration * ca.sqrt(ca.fmax(most / least, 0)) + ca.norm_2(vectors[:, -1])


def _high(matrix: ca.SX, rows: int) -> ca.SX:
    """With rows of zeros below."""
    return ca.vertcat(matrix, ca.SX(rows - matrix.shape[0], matrix.shape[1]))


def _chosen(count: int, directions: int, values: Array) -> Array:
    """S beside each V: the inverse of the first `count` columns, the eigenvectors of the others' A^T A."""
    found = np.zeros_like(values)
    found[:, :count, :count] = near_inverse(values[:, :count, :count])
    for first in range(count, values.shape[2], directions):
        bent = values[:, :3, first : first + directions]
        usable = np.isfinite(bent).all(axis=(1, 2), keepdims=True)
        bent = np.where(usable, bent, 0.0)
        found[:, :directions, first : first + directions] = np.linalg.eigh(np.swapaxes(bent, 1, 2) @ bent)[1]
    return found


STRENGTH = Strength()
