"""Clearance: the distance between the surfaces of members that are not joined."""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.machine import Member, Plate, Tube, unjoined
from kinematics.margins.parting import Pair, chosen
from kinematics.mathematics import Convex, LinearForms, shortest_way, signed_distance
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow

_THIN = 0.05  # of the longer member's length: across a thinner gap a direction turns with the members


class Clearance(Margin):
    """Between the surfaces of each pair of members that share no joint [m]; below 0 they intersect.

    Then it is minus the depth: the shortest displacement that parts them.
    """

    name = "clearance"
    unit = "m"
    words = "distance between the surfaces of the nearest two members that are not joined"
    holds_on_paths = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One component for each pair of shapes."""
        return ca.vertcat(*(signed_distance(a.core, b.core) - a.radius - b.radius for a, b in _pairs(_solids(robot))))

    def places(self, robot: Mechanism) -> list[str]:
        """The names of both members."""
        return [f"{a.member.name} and {b.member.name}" for a, b in _pairs(_solids(robot))]

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:  # noqa: ARG002
        """Each pair is parted by a direction; see `parting.py`."""
        pairs = sorted(_grouped(robot, inside), key=lambda pair: pair.thin)
        numbers = ca.SX.sym("direction", sum(pair.numbers for pair in pairs))
        rows, first = [], 0
        for pair in pairs:
            rows.append(pair.rows(claim.bound, numbers[first : first + pair.numbers]))
            first += pair.numbers
        fixed = sum(not pair.thin for pair in pairs)
        seen = ca.vertcat(*(pair.seen(claim.bound) for pair in pairs))
        return ToShow(ca.vertcat(*rows), numbers, seen, lambda at: chosen(at, fixed)[..., None])


class _Solid(NamedTuple):
    """A shape of a member at a pose: all points within `radius` of `core`. `number` is its place."""

    number: int
    member: Member
    core: Convex
    radius: ca.SX

    @property
    def length(self) -> ca.SX:
        """Of its first edge [m]."""
        return ca.norm_2(self.core.corners[:, 1] - self.core.corners[:, 0])


def _solids(robot: Mechanism) -> list[_Solid]:
    """All shapes of all members, their points from one evaluation, so that equal terms are one node."""
    model = robot.model()
    shapes = [(m, shape) for m in robot.members(model.pose, model.joints, model.g) for shape in m.shapes]
    points = [s.outline if isinstance(s, Plate) else ca.horzcat(s.start, s.end) for _, s in shapes]
    at_pose = ca.cse(model.at_pose(ca.horzcat(*points)))
    found, first = [], 0
    for (member, shape), corners in zip(shapes, points, strict=True):
        placed = at_pose[:, first : first + corners.shape[1]]
        first += corners.shape[1]
        flat = isinstance(shape, Plate)
        core = Convex.polygon(placed) if flat else Convex(placed)
        found.append(_Solid(len(found), member, core, shape.thickness / 2 if flat else shape.radius))
    return found


def _pairs(solids: list[_Solid]) -> list[tuple[_Solid, _Solid]]:
    """The pairs of shapes that must not touch."""
    return [
        (a, b) for i, a in enumerate(solids) for b in solids[i + 1 :] if not set(a.member.joints) & set(b.member.joints)
    ]


def _grouped(robot: Mechanism, inside: Array) -> list[Pair]:
    """The pairs as they are parted: rods that are translates of each other together, the nearest pair first.

    Args:
        inside: (n,) a pose; it decides which pair of a group is the first, and which gaps are thin.
    """
    model, solids = robot.model(), _solids(robot)
    forms = LinearForms(model.pose)
    leader = _leaders(solids, forms)
    pairs = _pairs(solids)
    ways = [shortest_way(a.core, b.core) for a, b in pairs]
    rooms = [ca.norm_2(way) - a.radius - b.radius for way, (a, b) in zip(ways, pairs, strict=True)]
    parts = [room / ca.fmax(a.length, b.length) for room, (a, b) in zip(rooms, pairs, strict=True)]
    at = ca.Function("gaps", [model.pose, model.geometry], [ca.vertcat(*rooms), ca.vertcat(*parts)])
    room, part = (np.array(v)[:, 0] for v in at(inside, robot.geometry.vector()))
    groups: dict[tuple[int, int], list[int]] = {}
    for k in np.argsort(room, kind="stable").tolist():
        a, b = pairs[k]
        groups.setdefault((leader[a.number], leader[b.number]), []).append(k)
    found = []
    for places in groups.values():
        a, b = pairs[places[0]]
        differences = [
            forms.difference(b.core.corners[:, j], a.core.corners[:, i])
            for i, j in product(range(a.core.corners.shape[1]), range(b.core.corners.shape[1]))
        ]
        starts = [forms.difference(pairs[k][1].core.corners[:, 0], pairs[k][0].core.corners[:, 0])[1] for k in places]
        segments = None
        if not a.core.faces and not b.core.faces and part[places[0]] < _THIN:
            u, v = (forms.difference(solid.core.corners[:, 1], solid.core.corners[:, 0]) for solid in (a, b))
            segments = u[0] + u[1], v[0] + v[1]
        shifts, of_group = [start - starts[0] for start in starts], [ways[k] for k in places]
        found.append(Pair(differences, shifts, of_group, a.radius + b.radius, segments))
    return found


def _leaders(solids: list[_Solid], forms: LinearForms) -> list[int]:
    """For each solid the first one that is a fixed translate of it, joined to the same members: itself, or a rod."""
    found: list[int] = []
    for solid in solids:
        alike = (first for first in solids[: solid.number] if found[first.number] == first.number)
        found.append(next((first.number for first in alike if _translates(first, solid, forms)), solid.number))
    return found


def _translates(one: _Solid, two: _Solid, forms: LinearForms) -> bool:
    if one.member is two.member or one.member.joints != two.member.joints or one.core.faces or two.core.faces:
        return False
    ends = [forms.difference(two.core.corners[:, i], one.core.corners[:, i]) for i in (0, 1)]
    still = all(moving.is_zero() for moving, _ in ends)
    return still and ca.is_equal(ends[0][1], ends[1][1], 1) and ca.is_equal(one.radius, two.radius, 1)


CLEARANCE = Clearance()
