"""How an angle changes along a path: monotonically from each given value to the next one.

It follows the septic smoothstep of the arc length, so that its first three derivatives are 0 where a value is given.
Where the tool turns in place, only the angle changes, and it changes evenly.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Array, evaluate
from trajectory.paths.corner import SEPTIC_MOST, septic, septic_program
from trajectory.paths.knots import interval_of


class Angle(NamedTuple):
    """An angle along a path.

    Attributes:
        at: (k,) increasing arc lengths where its values are given [m].
        values: (k,) [rad].
        even: (k - 1,) whether it changes evenly between two of them.
    """

    at: Array
    values: Array
    even: Array

    def evaluate(self, s: Array, order: int) -> list[Array]:
        """(..., 1) the angle and its derivatives by s, order + 1 of them."""
        span, w = self._within(s)
        extent, change = np.diff(self.at)[span], np.diff(self.values)[span]
        # By S7(w) = 1 - S7(1 - w), from the nearer end: there its derivatives vanish without cancellation.
        left = w <= 0.5
        nearer = np.where(left, w, np.clip((self.at[span + 1] - s) / extent, 0.0, 1.0))
        shares = [share[..., 0] for share in evaluate(septic_program(), nearer[..., None], 1 / extent[..., None])]
        shares = [share if k % 2 else np.where(left, share, -share) for k, share in enumerate(shares)]
        shares[0] = np.where(left, shares[0], 1.0 + shares[0])
        evenly = [w, 1 / extent, *[np.zeros_like(w)] * (len(shares) - 2)]
        found = [change * np.where(self.even[span], e, share) for e, share in zip(evenly, shares, strict=True)]
        found[0] = self.values[span] + found[0]
        return [value[..., None] for value in found[: order + 1]]

    def bounds(self, low: Array, high: Array) -> tuple[Array, Array]:
        """(2, k) bounds of the angle and of its rate between s (k,) and s (k,), both in one span.

        The rate is the change times 140 w^3 (1 - w)^3, which rises up to w = 1/2.
        """
        span, _ = self._within(0.5 * low + 0.5 * high)
        extent, change, even = np.diff(self.at)[span], np.diff(self.values)[span], self.even[span]
        w = np.stack([np.clip((s - self.at[span]) / extent, 0.0, 1.0) for s in (low, high)])
        angle = self.values[span] + change * np.where(even, w, septic(w))
        there = np.stack([*w, np.clip(0.5, w[0], w[1])])
        rates = change / extent * np.where(even, 1.0, 140 * there**3 * (1 - there) ** 3)
        return np.stack([angle.min(axis=0), angle.max(axis=0)]), np.stack([rates.min(axis=0), rates.max(axis=0)])

    def steepest(self, s: Array, order: int) -> Array:
        """(k,) bound of the modulus of the fourth or fifth derivative on the whole span around each s."""
        most = SEPTIC_MOST[order] * np.abs(np.diff(self.values)) / np.diff(self.at) ** order
        result: Array = np.where(self.even, 0.0, most)[interval_of(self.at, s)]
        return result

    def _within(self, s: Array) -> tuple[Array, Array]:
        """Which span, and how far into it as a fraction."""
        span = interval_of(self.at, s)
        return span, np.clip((s - self.at[span]) / np.diff(self.at)[span], 0.0, 1.0)
