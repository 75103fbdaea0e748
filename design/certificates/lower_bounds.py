"""Rigorous lower bounds of the claims over boxes of poses.

Each claim f over a box X with midpoint m is bounded in two ways: by interval arithmetic, and by the centred form
f(m) + G(X) (X - m), where G encloses the gradient. The centred form is valid because finite bounds of the first kind
show that f is defined on the whole box, and G contains every gradient there. It is used only if each condition that f
branches on has one value on the box. Then f is smooth, or has a kink (|x|, min) whose gradients G contains. All bounds
are rounded outward.
"""

from __future__ import annotations

import casadi as ca
import numba
import numpy as np

from design.certificates.branch_conditions import branch_conditions
from design.certificates.scaled_rows import ScaledRows
from design.claims import Statement, to_show
from design.regions import Region
from kinematics import (
    Array,
    ClaimSymbols,
    enclose,
    over_spans,
)

_UP = 1.0 + 2.0**-48  # covers the rounding of products and of their sum over fewer than ten coordinates
_TINY = 1e-300


class LowerBounds:
    """Lower bounds of the claims of one statement over boxes of a region.

    Attributes:
        statement: the statement that the claims belong to.
        free: the pose coordinates that the region does not fix. Boxes may be cut across these.
    """

    def __init__(self, statement: Statement, region: Region) -> None:
        """Build the programs."""
        robot, claim = statement.robot, ClaimSymbols.fresh()
        model = robot.model()
        self.statement = statement
        intervals = [region.intervals[name] for name in robot.pose_names]
        self.free = np.array([i for i, (low, high) in enumerate(intervals) if low < high], dtype=np.int64)
        self._extent = np.array([high - low if high > low else 1.0 for low, high in intervals])
        middle = region.from_unit(np.full(region.dimension, 0.5), robot.pose_names)
        claims = to_show(statement, claim, middle)
        moving = ca.vertcat(*(model.pose[int(i)] for i in self.free)) if self.free.size else ca.SX(0, 1)
        gradient = ca.jacobian(claims.expressions, moving)
        self._rows = ScaledRows(statement, claim, claims)
        self._count = claims.expressions.numel()
        conditions = branch_conditions(self._rows.symbols, claims.expressions)
        self._with_gradient = self._rows.program(claims.expressions, gradient, conditions)
        self._plain = self._rows.program(claims.expressions)
        self._slopes = self._count * (1 + self.free.size)  # the place where the conditions start

    def lowest(self, low: Array, high: Array) -> tuple[Array, Array]:
        """Lower bounds, and how much each coordinate widens them.

        Args:
            low, high: (k, n) boxes.

        Returns:
            (k,) lower bound of the smallest claim, and (k, free) the share of each coordinate in the width of the
            undecided claims' bounds; infinite if it is unknown.
        """
        middle = np.clip(0.5 * low + 0.5 * high, low, high)
        scaling = self._rows.scaling(middle)
        natural, highest = enclose(self._with_gradient, np.hstack([low, scaling]), np.hstack([high, scaling]))
        decided = (natural[:, self._slopes :] == highest[:, self._slopes :]).all(axis=1)
        at = np.hstack([middle, scaling])
        point, _ = enclose(self._plain, at, at)
        reach = np.nextafter(np.maximum(high - middle, middle - low)[:, self.free], np.inf)
        lowest, spread = np.empty(len(low)), np.empty((len(low), self.free.size))
        over_spans(
            len(low),
            lambda s: _combine(
                self._count, natural[s], highest[s], decided[s], point[s], reach[s], lowest[s], spread[s]
            ),
        )
        return lowest, spread

    def axis(self, low: Array, high: Array, spread: Array) -> Array:
        """(k,) the coordinate to cut: that of the largest share, or if it is unknown, that of the widest side."""
        if not self.free.size:
            return np.zeros(len(low), dtype=np.int64)
        unknown = ~np.isfinite(spread).all(axis=1) | (spread == 0.0).all(axis=1)
        spread = np.where(unknown[:, None], ((high - low) / self._extent)[:, self.free], spread)
        result: Array = self.free[spread.argmax(axis=1)]
        return result


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _combine(count, natural, highest, decided, point, reach, lowest, spread):  # type: ignore[no-untyped-def]
    """Centred form of each claim, rounded outward; the smallest lower bound, and the undecided claims' width."""
    n = reach.shape[1]
    for i in range(natural.shape[0]):
        least = np.inf
        spread[i, :] = 0.0
        for c in range(count):
            best = natural[i, c]
            if not best >= 0.0:
                loss, width = 0.0, highest[i, c] - best
                for k in range(n):
                    j = count + c * n + k
                    loss += max(abs(natural[i, j]), abs(highest[i, j])) * reach[i, k]
                # The bounds are finite, so the claim is defined on the whole box.
                if decided[i] and width - width == 0.0 and loss - loss == 0.0:
                    centred = point[i, c] - (loss * _UP + _TINY)
                    best = max(best, centred - abs(centred) * 2.0**-52 - _TINY)
                if not best >= 0.0:
                    for k in range(n):
                        j = count + c * n + k
                        spread[i, k] = max(spread[i, k], max(abs(natural[i, j]), abs(highest[i, j])) * reach[i, k])
            least = min(least, best)
        lowest[i] = least
