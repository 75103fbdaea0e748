"""How a region was cut into boxes: a binary tree. Its leaves cover the region, because no cut leaves a gap.

A box is cut in the middle of one coordinate, and both halves include the face between them. The codes are stored level
by level. So a list of codes is either one whole tree or is refused, and the boxes follow from the root alone.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from design.errors import BrokenCertificate
from design.regions import Cylinder, Region
from kinematics import Array

PROVED, OUTSIDE, LEFT = -1, -2, -3  # leaves; a code from 0 on is the coordinate that is cut
Part = tuple[Array, Array, Array]  # places in a tree (k,), lower and upper bounds (k, n)
BATCH = 1 << 16
MOST_NODES = 1 << 24  # of a tree: some hundred megabytes while it is read
_MOST_LEVELS = 2200  # for each coordinate: after so many halvings no double is left between its bounds


def root(region: Region, names: tuple[str, ...]) -> tuple[Array, Array]:
    """(1, n) bounds of a box around the region."""
    low, high = np.array([region.intervals[name] for name in names]).T
    return low[None].copy(), high[None].copy()


def halves(low: Array, high: Array, axis: Array) -> tuple[Array, Array]:
    """(k, n) boxes cut across coordinate axis (k,) -> (2 k, n): lower and upper half of each, next to each other."""
    rows = np.arange(len(low))
    cut = 0.5 * low[rows, axis] + 0.5 * high[rows, axis]
    lows, highs = np.repeat(low, 2, axis=0), np.repeat(high, 2, axis=0)
    highs[2 * rows, axis] = cut
    lows[2 * rows + 1, axis] = cut
    return lows, highs


def known(shares: Array, widths: Array) -> Array:
    """(k, n) how much each coordinate counts for the next cut of k boxes; the widths where this is unknown."""
    unknown = ~np.isfinite(shares).all(axis=1) | (shares == 0.0).all(axis=1)
    return np.where(unknown[:, None], widths, shares)


def outside(region: Region, low: Array, high: Array, names: tuple[str, ...]) -> Array:
    """(k,) whether no point of the box is in the region. Rounding can never make this true wrongly."""
    if not isinstance(region, Cylinder):
        return np.zeros(len(low), dtype=bool)
    columns = [names.index("x"), names.index("y")]
    nearest = np.maximum(np.maximum(low[:, columns], -high[:, columns]), 0.0)
    result: Array = (nearest**2).sum(axis=1) * (1.0 - 1e-15) > region.radius**2 * (1.0 + 1e-15)
    return result


def taken(stack: list[Part], most: int) -> Part:
    """At most `most` boxes from the top of the stack, the deepest first."""
    parts, count = list[Part](), 0
    while stack and count < most:
        nodes, low, high = stack.pop()
        room = most - count
        if len(nodes) > room:
            stack.append((nodes[:-room], low[:-room], high[:-room]))
        parts.append((nodes[-room:], low[-room:], high[-room:]))
        count += len(parts[-1][0])
    nodes, low, high = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    return nodes, low, high


class Tree:
    """The codes of the nodes in the order in which they were decided, and the places of their halves."""

    def __init__(self) -> None:
        self._code = np.full(1 << 12, LEFT, dtype=np.int8)
        self._first = np.full(1 << 12, -1, dtype=np.int64)
        self._size = 1

    def leaves(self, nodes: Array, code: int) -> None:
        """Make these nodes (k,) leaves with this code."""
        self._code[nodes] = code

    def cut(self, nodes: Array, axis: Array) -> Array:
        """Cut these nodes (k,) across coordinate axis (k,); returns (2 k,) their halves, next to each other."""
        end = self._size + 2 * len(nodes)
        while end > len(self._code):
            self._code = np.concatenate([self._code, np.full_like(self._code, LEFT)])
            self._first = np.concatenate([self._first, np.full_like(self._first, -1)])
        self._code[nodes] = axis
        self._first[nodes] = np.arange(self._size, end, 2)
        found = np.arange(self._size, end)
        self._size = end
        return found

    def by_level(self) -> Array:
        """(nodes,) int8 codes, the root first, then each level from left to right."""
        levels, level = [], np.zeros(1, dtype=np.int64)
        while level.size:
            code = self._code[level]
            levels.append(code)
            first = self._first[level[code >= 0]]
            level = np.stack([first, first + 1], axis=1).ravel()
        return np.concatenate(levels)


def leaves(codes: Array, low: Array, high: Array) -> Iterator[tuple[Array, Array, Array]]:
    """Batches of leaves: codes (k,), lower and upper bounds (k, n).

    The arguments are all codes by level and the root's bounds. The order is depth first, so that memory holds at most
    one batch of boxes for each level.

    Raises:
        BrokenCertificate: the codes are not one whole tree over the root's coordinates.
    """
    first = _first_halves(codes, low.shape[1])
    stack = [(0, low, high)]
    while stack:
        start, low, high = stack.pop()
        if len(low) > BATCH:
            stack.append((start + BATCH, low[BATCH:], high[BATCH:]))
            low, high = low[:BATCH], high[:BATCH]
        code = codes[start : start + len(low)]
        leaf = code < 0
        if leaf.any():
            yield code[leaf], low[leaf], high[leaf]
        if not leaf.all():
            stack.append((int(first[start]), *halves(low[~leaf], high[~leaf], code[~leaf].astype(np.int64))))


def _first_halves(codes: Array, coordinates: int) -> Array:
    """(nodes,) the place where the halves of each node start. For a leaf: those of the next node that is cut.

    Raises:
        BrokenCertificate: as in `leaves`.
    """
    if len(codes) > MOST_NODES:
        raise BrokenCertificate(f"its list of boxes has {len(codes)} entries, more than {MOST_NODES}")
    if (codes >= coordinates).any() or (codes < LEFT).any():
        raise BrokenCertificate("its list of boxes has an unknown code")
    cut = codes >= 0
    ends = 1 + 2 * np.cumsum(cut, dtype=np.int32)  # the list's length, as known from the nodes up to each one
    if not len(codes) or ends[-1] > len(codes) or (ends <= np.arange(1, len(codes) + 1))[:-1].any():
        raise BrokenCertificate("its list of boxes does not cover the region")
    if ends[-1] < len(codes):
        raise BrokenCertificate("its list of boxes has more entries than the region's tree")
    ends[1:], ends[0] = ends[:-1].copy(), 1  # the halves before a node's own
    _require_few_levels(ends, _MOST_LEVELS * coordinates)
    return ends


def _require_few_levels(first: Array, most: int) -> None:
    """Refuse trees with too many levels: a chain of a million boxes would be read one box at a time."""
    level, count = 0, 0
    while level < len(first) - 1 and (below := int(first[level])) > level:
        level, count = below, count + 1
        if count > most:
            raise BrokenCertificate(f"its boxes are cut more than {most} times")
