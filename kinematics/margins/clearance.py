"""Clearance: the distance between members that must not touch."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics import segment_gap_symbolic
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow

_LONG_ENOUGH = 1e-6  # what |w|^2, 1 in the middle of a box, must exceed


class Clearance(Margin):
    """Between the axes of the members of each pair of `segment_pairs` [m]."""

    name = "clearance"
    unit = "m"
    words = "distance between the axes of the two nearest members"
    holds_on_paths = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One component for each pair."""
        return ca.vertcat(*(ca.norm_2(segment_gap_symbolic(one, two)) for one, two in robot.segment_pairs()))

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:  # noqa: ARG002
        """Two segments are at least c apart where any vector w, not 0, parts them.

        w . (p - q) - c |w| >= 0 for the ends p of one and q of the other, as then all of their points are so far apart
        along w. The shortest line between the segments in the middle of the box serves as w.
        """
        pairs = robot.segment_pairs()
        gaps = ca.horzcat(*(segment_gap_symbolic(one, two) for one, two in pairs))
        w = ca.SX.sym("w", 3, len(pairs))
        rows = [ca.sumsqr(w[:, k]) - _LONG_ENOUGH for k in range(len(pairs))]
        for k, (one, two) in enumerate(pairs):
            kept = claim.bound * ca.norm_2(w[:, k])
            rows += [ca.dot(w[:, k], two[:, j] - one[:, i]) - kept for i in (0, 1) for j in (0, 1)]
        return ToShow(ca.vertcat(*rows), w, gaps, _directions)


def _directions(gaps: Array) -> Array:
    """(k, 3, c) each column over its length; e_x where it has none."""
    size = np.linalg.norm(gaps, axis=1, keepdims=True)
    usable = np.isfinite(size) & (size > 1e-150)  # far above where squares underflow
    return np.where(usable, gaps / np.where(usable, size, 1.0), np.array([1.0, 0.0, 0.0])[:, None])


CLEARANCE = Clearance()
