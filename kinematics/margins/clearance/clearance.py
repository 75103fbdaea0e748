"""Clearance: the distance between the surfaces of members that are not joined."""

from __future__ import annotations

from itertools import product

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.margins.clearance.parting import Corner, Fixed, Turning, chosen
from kinematics.margins.clearance.solids import Pair, Solid, rooms
from kinematics.mathematics import LinearForms, shortest_way
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow

# Of the longer member's length:
_THIN = 0.05  # across a thinner gap a direction turns with the members
_WIDE = 0.1  # across a wider gap one direction parts all shapes of two members


class Clearance(Margin):
    """Between the surfaces of each pair of members that share no joint [m]; below 0 they intersect.

    Then it is minus the depth: the shortest displacement that parts them.
    """

    name = "clearance"
    records = ("surroundings",)
    unit = "m"
    words = "distance between the surfaces of the nearest two members that are not joined"
    holds_on_paths = True
    shown_on_paths = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One component for each pair of shapes, and for each shape and what is around it; infinite without any."""
        pairs, walled = rooms(robot)
        found = [pair.distance for pair in pairs] + [ca.mmin(room.distances) for room in walled]
        return ca.vertcat(*found) if found else ca.SX(ca.inf)

    def places(self, robot: Mechanism) -> list[str] | None:
        """The names of both members."""
        pairs, walled = rooms(robot)
        return [pair.place for pair in pairs] + [room.place for room in walled] or None

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:  # noqa: ARG002
        """Each pair is parted by a direction (see `parting.py`), and each corner is on its side of each wall."""
        apart, walled = rooms(robot)
        pairs = sorted(_grouped(robot, apart, inside), key=lambda pair: isinstance(pair, Turning))
        numbers = ca.SX.sym("direction", sum(pair.numbers for pair in pairs))
        rows, first = [room.distances - claim.bound for room in walled], 0
        for pair in pairs:
            rows.append(pair.rows(claim.bound, numbers[first : first + pair.numbers]))
            first += pair.numbers
        if not pairs:
            return ToShow(ca.vertcat(*rows, ca.SX(0, 1)), ca.SX(0, 0))
        fixed = sum(isinstance(pair, Fixed) for pair in pairs)
        seen = ca.vertcat(*(pair.seen(claim.bound) for pair in pairs))
        return ToShow(ca.vertcat(*rows), numbers, seen, lambda at: chosen(at, fixed)[..., None])


def _grouped(robot: Mechanism, pairs: list[Pair], inside: Array) -> list[Fixed | Turning]:
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
    groups: dict[tuple[object, ...], list[int]] = {}
    for k in np.argsort(room, kind="stable").tolist():
        a, b = (leader[solid.number] for solid in pairs[k])
        of_members = (a.member.name, b.member.name) if part[k] > _WIDE else (a.number, b.number)
        groups.setdefault(of_members, []).append(k)
    found: list[Fixed | Turning] = []
    for places in groups.values():
        members, of_group = [pairs[k] for k in places], [ways[k] for k in places]
        segments = not any(solid.core.faces for solid in members[0])
        if segments and part[places[0]] < _THIN:
            found.append(_turning(members, of_group, forms))
        else:
            found.append(Fixed([(_corners(pair, forms), pair.thick) for pair in members], of_group))
    return found


def _turning(pairs: list[Pair], ways: list[ca.SX], forms: LinearForms) -> Turning:
    """The first pair, and the others as its translates."""
    ends = _corners(pairs[0], forms)
    u, v = (forms.difference(solid.core.corners[:, 1], solid.core.corners[:, 0]) for solid in pairs[0])
    shifts = [_corners(pair, forms)[0].fixed - ends[0].fixed for pair in pairs]
    return Turning(ends, (u[0] + u[1], v[0] + v[1]), shifts, ways, pairs[0].thick)


def _corners(pair: Pair, forms: LinearForms) -> list[Corner]:
    one, two = (solid.core.corners for solid in pair)
    return [
        Corner(*forms.difference(two[:, j], one[:, i])) for i, j in product(range(one.shape[1]), range(two.shape[1]))
    ]


def _leaders(pairs: list[Pair], forms: LinearForms) -> dict[int, Solid]:
    """For each solid the first one that is a fixed translate of it, joined to the same members: itself, or a rod."""
    solids = {solid.number: solid for pair in pairs for solid in pair}
    found: dict[int, Solid] = {}
    for number, solid in sorted(solids.items()):
        alike = (first for first in found.values() if _translates(first, solid, forms))
        found[number] = next(alike, solid)
    return found


def _translates(one: Solid, two: Solid, forms: LinearForms) -> bool:
    if one.member is two.member or one.member.joints != two.member.joints or one.core.faces or two.core.faces:
        return False
    ends = [forms.difference(two.core.corners[:, i], one.core.corners[:, i]) for i in (0, 1)]
    still = all(moving.is_zero() for moving, _ in ends)
    return still and ca.is_equal(ends[0][1], ends[1][1], 1) and ca.is_equal(one.radius, two.radius, 1)


CLEARANCE = Clearance()
