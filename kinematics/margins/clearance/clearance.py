"""Clearance: the distance between the surfaces of members that are not joined."""

from __future__ import annotations

from itertools import product

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.margins.clearance.parting import Corner, Fixed, Turning, chosen
from kinematics.margins.clearance.solids import Pair, rooms
from kinematics.mathematics import LinearForms, shortest_way
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow

_THIN = 0.05  # of the longer member's length: across a thinner gap a direction turns with the members


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
        return rooms(robot).distances

    def places(self, robot: Mechanism) -> list[str] | None:
        """The names of both members."""
        pairs, walled, _ = rooms(robot)
        return [pair.place for pair in pairs] + [room.place for room in walled] or None

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:  # noqa: ARG002
        """Each pair is parted by a direction (see `parting.py`), and each corner is on its side of each wall."""
        apart, walled, _ = rooms(robot)
        pairs = sorted(_parted(robot, apart, inside), key=lambda pair: isinstance(pair, Turning))
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


def _parted(robot: Mechanism, pairs: tuple[Pair, ...], inside: Array) -> list[Fixed | Turning]:
    """Each pair as it is parted.

    Args:
        inside: (n,) a pose; it decides which gaps are thin.
    """
    if not pairs:
        return []
    model = robot.model()
    forms = LinearForms(model.pose)
    ways = [shortest_way(a.core, b.core) for a, b in pairs]
    rooms = (ca.norm_2(way) - a.radius - b.radius for way, (a, b) in zip(ways, pairs, strict=True))
    parts = [room / ca.fmax(a.length, b.length) for room, (a, b) in zip(rooms, pairs, strict=True)]
    at = ca.Function("gaps", [model.pose, model.geometry], [ca.vertcat(*parts)])
    part = np.array(at(inside, robot.geometry.vector()))[:, 0]
    found: list[Fixed | Turning] = []
    for k, (one, two) in enumerate(pairs):
        corners = _corners(pairs[k], forms)
        if part[k] < _THIN and not (one.core.faces or two.core.faces):
            u, v = (sum(forms.difference(s.core.corners[:, 1], s.core.corners[:, 0]), ca.SX(3, 1)) for s in (one, two))
            found.append(Turning(corners, (u, v), ways[k], pairs[k].thick))
        else:
            found.append(Fixed(corners, ways[k], pairs[k].thick))
    return found


def _corners(pair: Pair, forms: LinearForms) -> list[Corner]:
    one, two = (solid.core.corners for solid in pair)
    return [
        Corner(*forms.difference(two[:, j], one[:, i])) for i, j in product(range(one.shape[1]), range(two.shape[1]))
    ]


CLEARANCE = Clearance()
