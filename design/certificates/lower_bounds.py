"""Rigorous lower bounds of the claims over boxes of poses, by affine arithmetic (`kinematics.evaluation`)."""

from __future__ import annotations

import numpy as np

from design.certificates.box_tree import known
from design.certificates.scaled_rows import ScaledRows
from design.claims import Statement, to_show
from design.regions import Region
from kinematics import Array, ClaimSymbols, bound_below


class LowerBounds:
    """Lower bounds of the claims of one statement over boxes of a region.

    Attributes:
        statement: the statement that the claims belong to.
        free: the pose coordinates that the region does not fix. Boxes may be cut across these.
    """

    def __init__(self, statement: Statement, region: Region) -> None:
        """Build the program."""
        robot, claim = statement.robot, ClaimSymbols.fresh()
        self.statement = statement
        intervals = [region.intervals[name] for name in robot.pose_names]
        self.free = np.array([i for i, (low, high) in enumerate(intervals) if low < high], dtype=np.int64)
        self._extent = np.array([high - low if high > low else 1.0 for low, high in intervals])
        middle = region.from_unit(np.full(region.dimension, 0.5), robot.pose_names)
        claims = to_show(statement, claim, middle)
        self._rows = ScaledRows(statement, claim, claims)
        self._program = self._rows.program(claims.expressions)

    def lowest(self, low: Array, high: Array) -> tuple[Array, Array]:
        """Lower bounds, and how much each coordinate widens them.

        Args:
            low, high: (k, n) boxes.

        Returns:
            (k,) lower bound of the smallest claim, and (k, free) the most that each coordinate moves or blurs an
            undecided claim; infinite if it is unknown.
        """
        scaling = self._rows.scaling(np.clip(0.5 * low + 0.5 * high, low, high))
        return bound_below(self._program, np.hstack([low, scaling]), np.hstack([high, scaling]), self.free)

    def axis(self, low: Array, high: Array, spread: Array) -> Array:
        """(k,) the coordinate to cut: that of the largest share, or if it is unknown, that of the widest side."""
        if not self.free.size:
            return np.zeros(len(low), dtype=np.int64)
        result: Array = self.free[known(spread, ((high - low) / self._extent)[:, self.free]).argmax(axis=1)]
        return result
