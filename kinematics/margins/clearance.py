"""Clearance: the distance between the surfaces of members that are not joined."""

from __future__ import annotations

from itertools import product

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.margins.parting import Parted, chosen
from kinematics.margins.solids import Pair, Solid, rooms
from kinematics.mathematics import LinearForms, shortest_way
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
        """One component for each pair of shapes, and for each shape and what is around it."""
        pairs, walled = rooms(robot)
        return ca.vertcat(
            *(pair.distance for pair in pairs), *(ca.mmin(room.distances) for room in walled), ca.SX(0, 1)
        )

    def places(self, robot: Mechanism) -> list[str]:
        """The names of both members."""
        pairs, walled = rooms(robot)
        return [pair.place for pair in pairs] + [room.place for room in walled]

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:  # noqa: ARG002
        """Each pair is parted by a direction (see `parting.py`), and each corner is on its side of each wall."""
        apart, walled = rooms(robot)
        pairs = sorted(_grouped(robot, apart, inside), key=lambda pair: pair.thin)
        numbers = ca.SX.sym("direction", sum(pair.numbers for pair in pairs))
        rows, first = [room.distances - claim.bound for room in walled], 0
        for pair in pairs:
            rows.append(pair.rows(claim.bound, numbers[first : first + pair.numbers]))
            first += pair.numbers
        fixed = sum(not pair.thin for pair in pairs)
        seen = ca.vertcat(*(pair.seen(claim.bound) for pair in pairs))
        return ToShow(ca.vertcat(*rows), numbers, seen, lambda at: chosen(at, fixed)[..., None])


def _grouped(robot: Mechanism, pairs: list[Pair], inside: Array) -> list[Parted]:
    """The pairs as they are parted: rods that are translates of each other together, the nearest pair first.

    Args:
        inside: (n,) a pose; it decides which pair of a group is the first, and which gaps are thin.
    """
    if not pairs:
        return []
    model = robot.model()
    forms = LinearForms(model.pose)
    leader = _leaders(pairs, forms)
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
        found.append(Parted(differences, shifts, of_group, a.radius + b.radius, segments))
    return found


def _leaders(pairs: list[Pair], forms: LinearForms) -> dict[int, int]:
    """For each solid the first one that is a fixed translate of it, joined to the same members: itself, or a rod."""
    solids = {solid.number: solid for pair in pairs for solid in pair}
    found: dict[int, int] = {}
    for number, solid in sorted(solids.items()):
        alike = (first for first in found if found[first] == first and _translates(solids[first], solid, forms))
        found[number] = next(alike, number)
    return found


def _translates(one: Solid, two: Solid, forms: LinearForms) -> bool:
    if one.member is two.member or one.member.joints != two.member.joints or one.core.faces or two.core.faces:
        return False
    ends = [forms.difference(two.core.corners[:, i], one.core.corners[:, i]) for i in (0, 1)]
    still = all(moving.is_zero() for moving, _ in ends)
    return still and ca.is_equal(ends[0][1], ends[1][1], 1) and ca.is_equal(one.radius, two.radius, 1)


CLEARANCE = Clearance()
