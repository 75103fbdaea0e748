"""Clearance: the distance between the surfaces of members that are not joined."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.machine import Plate, Tube, unjoined
from kinematics.mathematics import segment_gap_symbolic
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow

_LONG_ENOUGH = 1e-6  # what |w|^2, 1 in the middle of a box, must exceed


class Clearance(Margin):
    """Between the surfaces of each pair of members that share no joint [m]; below 0 they intersect."""

    name = "clearance"
    unit = "m"
    words = "distance between the surfaces of the nearest two members that are not joined"
    holds_on_paths = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One component for each pair of shapes."""
        pairs = _pairs(robot)
        return ca.vertcat(*(ca.norm_2(_gap(one, two)) - thick for one, two, thick in pairs)) if pairs else ca.SX(np.inf)

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:  # noqa: ARG002
        """Two convex sets are at least c apart where any vector w, not 0, parts them.

        w . (q - p) - c |w| >= 0 for the corners p of one and q of the other, as then all of their points are so far
        apart along w. The shortest line between them in the middle of the box serves as w.
        """
        pairs = _pairs(robot)
        gaps = ca.horzcat(*(_gap(one, two) for one, two, _ in pairs))
        w = ca.SX.sym("w", 3, len(pairs))
        rows = [ca.sumsqr(w[:, k]) - _LONG_ENOUGH for k in range(len(pairs))]
        for k, (one, two, thick) in enumerate(pairs):
            kept = (claim.bound + thick) * ca.norm_2(w[:, k])
            rows += [
                ca.dot(w[:, k], two[:, j] - one[:, i]) - kept for i in range(one.shape[1]) for j in range(two.shape[1])
            ]
        return ToShow(ca.vertcat(*rows), w, gaps, _directions)


def _pairs(robot: Mechanism) -> list[tuple[ca.SX, ca.SX, ca.SX]]:
    """The corners (3, k) of both shapes of each pair at a pose, and the sum of their radii."""
    model = robot.model()

    def corners(shape: Tube | Plate) -> tuple[ca.SX, ca.SX]:
        if isinstance(shape, Plate):
            return model.at_pose(shape.outline), shape.thickness / 2
        return model.at_pose(ca.horzcat(shape.start, shape.end)), shape.radius

    members = robot.members(model.pose, model.joints, model.g)
    placed = {member.name: [corners(shape) for shape in member.shapes] for member in members}
    return [(p, q, r + s) for a, b in unjoined(members) for p, r in placed[a.name] for q, s in placed[b.name]]


def _gap(one: ca.SX, two: ca.SX) -> ca.SX:
    """(3,) the shortest way between their edges."""
    gaps = [segment_gap_symbolic(p, q) for p in _edges(one) for q in _edges(two)]
    best = gaps[0]
    for gap in gaps[1:]:
        best = ca.if_else(ca.sumsqr(gap) < ca.sumsqr(best), gap, best)
    return best


def _edges(corners: ca.SX) -> list[ca.SX]:
    """(3, 2) each."""
    count = corners.shape[1]
    return [corners] if count == 2 else [corners[:, [i, (i + 1) % count]] for i in range(count)]


def _directions(gaps: Array) -> Array:
    """(k, 3, c) each column over its length; e_x where it has none."""
    size = np.linalg.norm(gaps, axis=1, keepdims=True)
    usable = np.isfinite(size) & (size > 1e-150)  # far above where squares underflow
    return np.where(usable, gaps / np.where(usable, size, 1.0), np.array([1.0, 0.0, 0.0])[:, None])


CLEARANCE = Clearance()
