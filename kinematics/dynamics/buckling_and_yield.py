"""Safety factors: a member's capacity over its load, against buckling and against yield.

A rod between ball joints buckles as Euler's column on two hinges, at pi^2 E I / l^2. It yields where its tension and
the bending by its own mass reach the material's strength. An arm yields where tension and bending, and torsion by von
Mises, reach it. Bending and tension are added as if both were largest at one point of the section.
"""

from __future__ import annotations

import math
from functools import reduce
from typing import NamedTuple

import casadi as ca

from kinematics.dynamics.member_loads import MemberLoad

_TRIANGLE = 9 * math.sqrt(3)  # the largest moment of a beam on two supports under a triangular load w is w l^2 over it
LARGEST = 1e9  # factor; a member that bears less has this one
_TINY = 1e-24  # under a root, so that it has a derivative where it is 0; what it adds is less than rounding
_APART = 1e-20  # likewise, of the sum of two eigenvalues: the square of their difference


class Size:
    """How large loads of one column are."""

    def most(self, row: ca.SX) -> ca.SX:
        """Of a row (1, c), with its sign."""
        return row

    def norm(self, vectors: ca.SX) -> ca.SX:
        """Of vectors (3, c) in one plane."""
        return _length(vectors)

    def modulus(self, row: ca.SX) -> ca.SX:
        """Of a row (1, c)."""
        return ca.fmax(self.most(row), self.most(-row))


class WorstDirection(Size):
    """The largest over all directions of an acceleration: the last column is constant, the others are those of 1 m/s^2.

    Attributes:
        acceleration: [m/s^2].
    """

    def __init__(self, acceleration: float | ca.SX) -> None:
        self.acceleration = acceleration

    def most(self, row: ca.SX) -> ca.SX:
        """Exactly: along the row."""
        return self.acceleration * _length(row[:-1]) + row[-1]

    def norm(self, vectors: ca.SX) -> ca.SX:
        """At most: the largest singular value, of at most two, and the constant, as if both had one direction."""
        moving = vectors[:, :-1]
        gram = moving.T @ moving
        trace = ca.trace(gram)
        count = gram.shape[0]
        minors = sum(gram[i, i] * gram[j, j] - gram[i, j] ** 2 for i in range(count) for j in range(i))
        apart = ca.sqrt(ca.fmax(trace**2 - 4 * minors, _APART * trace**2) + _TINY**2)
        return self.acceleration * ca.sqrt((trace + apart) / 2 + _TINY) + _length(vectors[:, -1])


def _length(vector: ca.SX) -> ca.SX:
    return ca.sqrt(ca.sumsqr(vector) + _TINY) if vector.nnz() else ca.SX(0)


class Slack(NamedTuple):
    """How much more than its load says a member may bear [N, N m]."""

    tension: float | ca.SX = 0.0
    bending: float | ca.SX = 0.0
    torsion: float | ca.SX = 0.0


def demands(load: MemberLoad, size: Size, slack: Slack = Slack()) -> dict[str, tuple[ca.SX, ca.SX]]:  # noqa: B008
    """By what may fail first, "buckling" [N] or "yield" [Pa]: the member's capacity, and what it needs."""
    section, radius, tensions = load.section, load.tube.radius, load.tensions()
    bending = bending_of(load, size) + slack.bending
    push, pull = (reduce(ca.fmax, [size.most(sign * row) for row in tensions]) + slack.tension for sign in (-1, 1))
    stress = ca.fmax(push, pull) / section.area + bending * radius / section.second_moment
    if not load.ends:
        torsion = size.modulus(load.along.T @ load.moment) + slack.torsion
        shear = torsion * radius / (2 * section.second_moment)
        return {"yield": (ca.SX(load.material.strength), ca.sqrt(stress**2 + 3 * shear**2))}
    column = math.pi**2 * load.material.modulus * section.second_moment / load.length**2
    return {"buckling": (column, push), "yield": (ca.SX(load.material.strength), stress)}


def safety_factors(load: MemberLoad, size: Size) -> dict[str, ca.SX]:
    """By what may fail first, "buckling" or "yield": the member's capacity over what it needs."""
    needs = demands(load, size)
    return {what: capacity / ca.fmax(need, capacity / LARGEST) for what, (capacity, need) in needs.items()}


def bending_of(load: MemberLoad, size: Size) -> ca.SX:
    """The largest moment across a member [N m]: of a rod under its own mass, or at the cut."""
    if not load.ends:
        return size.norm(ca.skew(load.along) @ load.moment)
    across = sum(size.norm(ca.skew(load.along) @ end) for end in load.ends)
    return load.per_length * load.length**2 / _TRIANGLE * across
