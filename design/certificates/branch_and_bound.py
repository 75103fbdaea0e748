"""Cut a region into boxes until each is proved, one fails, or no boxes or time are left.

Boxes are taken depth first in batches, so that memory holds only a few batches for each level.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from design.budget import Budget
from design.certificates.box_tree import BATCH, OUTSIDE, PROVED, Part, Tree, halves, outside, root, taken
from design.certificates.lower_bounds import LowerBounds
from design.certificates.refutation import Refutation, Refuter
from design.certificates.symmetry import Mirrors, one_side
from design.regions import Region
from kinematics import Array, Value

SMALLEST = 1e-6  # boxes narrower than this part of the region in every coordinate are not cut
_MOST_SMALL = 1000  # the search ends after so many of these boxes


@dataclass(frozen=True, eq=False)
class Search(Value):
    """The result of the search.

    Attributes:
        codes: (nodes,) the tree by level.
        boxes: the number of boxes that were bounded.
        left: (k, 2, n) lower and upper bounds of the boxes that were not proved.
        refutation: a pose that fails, else None.
    """

    codes: Array
    boxes: int
    left: Array
    refutation: Refutation | None


def search(
    bounds: LowerBounds,
    refuter: Refuter,
    region: Region,
    mirrors: Mirrors,
    most_boxes: int,
    budget: Budget,
    progress: Callable[[str], None],
) -> Search:
    """Bound boxes. An undecided box is cut across the coordinate that widens the bounds of its claims the most.

    Args:
        bounds: the lower bounds of the statement, over a region that contains this one.
        refuter: finds poses that refute the same statement.
        mirrors: the mirrors for which one side of the region is enough.
        most_boxes, budget: the allowed boxes and time; at their end the answer is undecided, with the boxes left.
        progress: called with a line of text after each batch.
    """
    names = bounds.statement.robot.pose_names
    low, high = one_side(*root(region, names), mirrors, names)
    extent = np.where(high[0] > low[0], high[0] - low[0], 1.0)
    tree = Tree()
    stack: list[Part] = [(np.zeros(1, dtype=np.int64), low, high)]
    small: list[Array] = []
    boxes, refutation = 0, None
    while stack and boxes < most_boxes and len(small) < _MOST_SMALL and refutation is None and not budget.spent:
        nodes, low, high = taken(stack, min(BATCH, most_boxes - boxes))
        off = outside(region, low, high, names)
        tree.leaves(nodes[off], OUTSIDE)
        nodes, low, high = nodes[~off], low[~off], high[~off]
        lowest, spread = bounds.lowest(low, high)
        boxes += len(low)
        progress(f"{boxes} boxes bounded, {sum(len(top[0]) for top in stack)} more waiting")
        proved = lowest >= 0.0
        tree.leaves(nodes[proved], PROVED)
        nodes, low, high, spread = nodes[~proved], low[~proved], high[~proved], spread[~proved]
        if not len(nodes):
            continue
        refutation = refuter.refutation(region, 0.5 * low + 0.5 * high)
        tiny = ((high - low) / extent <= SMALLEST).all(axis=1)
        small += list(np.stack([low[tiny], high[tiny]], axis=1))
        nodes, low, high, spread = nodes[~tiny], low[~tiny], high[~tiny], spread[~tiny]
        axis = bounds.axis(low, high, spread)
        stack.append((tree.cut(nodes, axis), *halves(low, high, axis)))
    left = [np.stack([low, high], axis=1) for _, low, high in stack]
    left.append(np.array(small).reshape(-1, 2, len(names)))
    return Search(tree.by_level(), boxes, np.concatenate(left), refutation)
