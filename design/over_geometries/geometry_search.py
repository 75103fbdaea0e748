"""Cut the box of geometries until each part is excluded: no geometry in it keeps all rows at all poses."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from design.budget import Budget
from design.certificates import PROVED, Part, Tree, halves, known, taken
from design.over_geometries.design_box import DesignBox
from design.over_geometries.upper_bounds import UpperBounds
from design.over_geometries.weights import weighted
from kinematics import AffineForms, Array

_BATCH = 4096  # boxes: their rows' slopes at all poses are in memory at once
SMALLEST = 1e-5  # boxes narrower than this part of the bounds in every variable are not cut
_MOST_SMALL = 20  # the search ends after so many of these


class GeometrySearch:
    """A search, which may go on with more poses: what was excluded stays excluded.

    Attributes:
        boxes: the number of boxes that were bounded.
    """

    def __init__(self, box: DesignBox) -> None:
        self.boxes = 0
        self._extent = np.where(box.high > box.low, box.high - box.low, 1.0)
        self._tree, self._small = Tree(), list[Part]()
        self._stack: list[Part] = [(np.zeros(1, dtype=np.int64), box.low[None], box.high[None])]

    @property
    def codes(self) -> Array:
        """(nodes,) the tree by level, as of a certificate."""
        return self._tree.by_level()

    @property
    def left(self) -> Array:
        """(j, 2, k) lower and upper bounds of the boxes that are not excluded."""
        parts = [np.stack([low, high], axis=1) for _, low, high in [*self._stack, *self._small]]
        return np.concatenate([np.empty((0, 2, len(self._extent))), *parts])

    def run(
        self, bounds: Sequence[UpperBounds], most_boxes: int, budget: Budget, progress: Callable[[str], None]
    ) -> None:
        """Exclude boxes, the deepest first, until none is left, some are too small, or no boxes or time are left.

        Args:
            bounds: of the sums and of the rows at each pose. The first poses should exclude the most.
            most_boxes, budget: the allowed boxes, in all, and time.
            progress: called with a line of text after each batch.
        """
        self._stack, self._small = [*self._stack, *self._small], []
        small = 0
        while self._stack and self.boxes < most_boxes and small < _MOST_SMALL and not budget.spent:
            nodes, low, high = taken(self._stack, min(_BATCH, most_boxes - self.boxes))
            none, spread = excluded(bounds, low, high)
            self.boxes += len(nodes)
            progress(f"{self.boxes} boxes bounded, {sum(len(part[0]) for part in self._stack)} more waiting")
            self._tree.leaves(nodes[none], PROVED)
            nodes, low, high, spread = nodes[~none], low[~none], high[~none], spread[~none]
            width = (high - low) / self._extent
            tiny = (width <= SMALLEST).all(axis=1)
            if tiny.any():
                small += int(tiny.sum())
                self._small.append((nodes[tiny], low[tiny], high[tiny]))
                nodes, low, high, spread, width = (part[~tiny] for part in (nodes, low, high, spread, width))
            if len(nodes):
                axis = _axis(spread, width)
                self._stack.append((self._tree.cut(nodes, axis), *halves(low, high, axis)))


def excluded(bounds: Sequence[UpperBounds], low: Array, high: Array) -> tuple[Array, Array]:
    """Which boxes (n, k) are excluded (n,), and how much each variable widens what excludes the others (n, k).

    A box is excluded by one row at one pose that is below 0 on all of it, or by a weighted sum of rows at all poses.
    """
    none, spread = np.ones(len(low), dtype=bool), np.zeros(low.shape)
    rest, parts = np.arange(len(low)), list[tuple[Array, AffineForms]]()
    for at_pose in bounds:
        rows = at_pose.over(low[rest], high[rest])
        parts.append((rest, rows))
        rest = rest[np.logical_not((rows.upper < 0.0).any(axis=1))]
        if not len(rest):
            return none, spread
    kept = [AffineForms(*(part[np.searchsorted(boxes, rest)] for part in rows)) for boxes, rows in parts]
    leads = np.concatenate([np.full(at_pose.count, at_pose.leads) for at_pose in bounds])
    _, most, slopes, bends = (np.concatenate(columns, axis=1) for columns in zip(*kept, strict=True))
    none[rest], spread[rest] = weighted(most, slopes, bends, leads)
    return none, spread


def _axis(spread: Array, width: Array) -> Array:
    """(n,) the variable to cut: that of the largest share, the wide ones a little before; or the widest if unknown."""
    result: Array = np.where(width > SMALLEST, known(spread, width) * width**0.25, -1.0).argmax(axis=1)
    return result
