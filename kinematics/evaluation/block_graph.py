"""A program as a graph of scaled nodes: every value is k times a node, and equal nodes are one node.

Factors, signs and constants are collected in k. So operations that the geometry's numbers make unnecessary disappear:
(x / l) / (y / l) is x / y, and x - (x - y) is y. If everything is finite, the value is the same except for rounding.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

from kinematics.evaluation.program import Op, Program

_LARGE = 1e100  # a factor beyond this, or below its inverse, is not moved: it might overflow where the program does not


class Block(IntEnum):
    """What the block interpreter adds to `Op`; k and c are the instruction's own constants."""

    SCALE = 64  # k x
    AFFINE = 65  # k x + c
    SUM = 66  # k x + c y
    PRODUCT = 67  # k x y
    PRODUCT_AFFINE = 68  # k x y + c
    PRODUCT_SUM = 69  # k x y + c z
    TWO_PRODUCTS = 70  # k x y + c u v


class Node(NamedTuple):
    """op(rows...) with the constants k and c."""

    op: int
    rows: tuple[int, ...] = ()
    k: float = 1.0
    c: float = 0.0


Scaled = tuple[float, int]  # k and a node
ONE = 0  # the node of the number 1


class Graph:
    """Nodes of a program; those that nothing needs are left to whoever orders them."""

    def __init__(self, program: Program) -> None:
        self.nodes: list[Node] = []
        self._known: dict[tuple[Node, float, float], int] = {}
        self.add(Node(Op.CONST))
        self.outputs: dict[int, int] = {}
        work: list[Scaled] = [(0.0, ONE)] * program.work_size
        columns = (program.op, program.left, program.right, program.target, program.constant)
        for op, left, right, target, constant in zip(*(c.tolist() for c in columns), strict=True):
            if op == Op.CONST:
                work[target] = (constant, ONE)
            elif op == Op.INPUT:
                work[target] = (1.0, self.add(Node(op, (left,))))
            elif op == Op.OUTPUT:
                self.outputs[target] = self.plain(work[left])
            else:
                work[target] = self._apply(op, work[left], work[right])

    def add(self, node: Node) -> int:
        """The node's number; an equal one is not added again."""
        key = (node, math.copysign(1.0, node.k), math.copysign(1.0, node.c))  # 0.0 equals -0.0
        if key not in self._known:
            self._known[key] = len(self.nodes)
            self.nodes.append(node)
        return self._known[key]

    def plain(self, value: Scaled) -> int:
        """The value as a node."""
        k, node = value
        if node == ONE:
            return self.add(Node(Op.CONST, k=k))
        if k == 1.0:
            return node
        return self.add(Node(Block.SCALE, (node,), k))

    def _apply(self, op: int, a: Scaled, b: Scaled) -> Scaled:
        result = self._scaled(op, a, b)
        if result is not None and (1.0 / _LARGE < abs(result[0]) < _LARGE or result[1] == ONE):
            return result
        rows = (self.plain(a), self.plain(b)) if op in _BINARY else (self.plain(a),)
        return 1.0, self.add(Node(op, rows))

    def _scaled(self, op: int, a: Scaled, b: Scaled) -> Scaled | None:
        """With the factors drawn out; None where they have to be multiplied in first."""
        (j, x), (k, y) = a, b
        if not (_movable(a) and (op not in _BINARY or _movable(b))):
            return None
        if op == Op.ASSIGN:
            return a
        if op == Op.NEG:
            return -j, x
        if op == Op.TWICE:
            return 2.0 * j, x
        if op == Op.ADD:
            return self._sum(a, b)
        if op == Op.SUB:
            return self._sum(a, (-k, y))
        if op in (Op.MUL, Op.SQ):
            return self._product(a, b if op == Op.MUL else a)
        if op == Op.DIV:
            return j / k, (x if y == ONE else self.add(Node(Op.INV, (y,)) if x == ONE else Node(op, (x, y))))
        if op == Op.INV:
            return 1.0 / j, (ONE if x == ONE else self.add(Node(op, (x,))))
        if op == Op.FABS:
            return abs(j), (ONE if x == ONE else self.add(Node(op, (x,))))
        if op == Op.SQRT and j > 0.0:
            return math.sqrt(j), (ONE if x == ONE else self.add(Node(op, (x,))))
        if op in (Op.FMIN, Op.FMAX) and j == k and ONE not in (x, y):
            kind = op if j > 0.0 else (Op.FMAX if op == Op.FMIN else Op.FMIN)
            return j, self.add(Node(kind, (x, y)))
        return None

    def _product(self, a: Scaled, b: Scaled) -> Scaled:
        (j, x), (k, y) = a, b
        if ONE in (x, y):
            return j * k, (y if x == ONE else x)
        return j * k, self.add(Node(Block.PRODUCT, (min(x, y), max(x, y))))

    def _sum(self, a: Scaled, b: Scaled) -> Scaled | None:
        (j, x), (k, y) = a, b
        if x == y:
            return (j + k, x) if j + k != 0.0 else None
        if ONE in (x, y):
            (j, x), c = (b, j) if x == ONE else (a, k)
            inner = self.nodes[x]
            if inner.op == Block.AFFINE:
                return 1.0, self.add(Node(Block.AFFINE, inner.rows, j * inner.k, j * inner.c + c))
            return 1.0, self.add(Node(Block.AFFINE, (x,), j, c))
        for (f, u), (g, v) in ((a, b), (b, a)):
            rest = self._without(v, u, _rounded(-f / g))
            if rest is not None:
                return g * rest[0], rest[1]
        if k == 1.0 or (j != 1.0 and x > y):
            (j, x), (k, y) = b, a
        return j, self.add(Node(Block.SUM, (x, y), 1.0, _rounded(k / j)))

    def _without(self, total: int, part: int, factor: float) -> Scaled | None:
        """What is left of `total` when factor * part is taken away, if that is one of its two terms."""
        node = self.nodes[total]
        if node.op != Block.SUM:
            return None
        if node.rows[0] == part and factor == 1.0:
            return node.c, node.rows[1]
        if node.rows[1] == part and factor == node.c:
            return 1.0, node.rows[0]
        return None


_UNARY = {Op.ASSIGN, Op.NEG, Op.SQRT, Op.SQ, Op.TWICE, Op.INV, Op.SIN, Op.COS, Op.FABS, Op.ATAN, Op.ACOS, Op.ASIN}
_UNARY |= {Op.TAN, Op.EXP, Op.LOG, Op.SIGN, Op.NOT}
_BINARY = set(Op) - _UNARY - {Op.CONST, Op.INPUT, Op.OUTPUT}


def _rounded(factor: float) -> float:
    """+-1 where it is that but for rounding."""
    return math.copysign(1.0, factor) if abs(abs(factor) - 1.0) < 1e-15 else factor


def _movable(value: Scaled) -> bool:
    return 1.0 / _LARGE < abs(value[0]) < _LARGE
