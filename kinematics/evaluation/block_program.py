"""A program made ready for blocks of poses: fewer instructions, fewer work rows, none written where it is read."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Value
from kinematics.evaluation.block_graph import Block, Graph, Node
from kinematics.evaluation.program import Columns, Op, Program

_LEAVES = (int(Op.INPUT), int(Op.CONST))
_SCALED = (Block.SUM, Block.PRODUCT, Block.PRODUCT_AFFINE, Block.PRODUCT_SUM, Block.TWO_PRODUCTS)


@dataclass(frozen=True, eq=False)
class BlockProgram(Value, Columns):
    """Instructions in order: work[target] = op(work[a], work[b], work[c], work[d]; k, c).

    The first rows hold the inputs' columns laid side by side. OUTPUT writes column `target` of the outputs laid side
    by side (dense, row by row). A target is never an operand of its instruction: compilers vectorise no loop that
    writes where it reads.
    """

    code: np.ndarray  # (k, 6) int64: op, four rows, target
    constant: np.ndarray  # (k, 2)

    @classmethod
    def of(cls, program: Program) -> BlockProgram:
        """Simplify, fuse, order and give rows."""
        graph = Graph(program)
        nodes = _fused(_reciprocals(graph), graph.outputs)
        order = _order(nodes, graph.outputs)
        code, constant, size = _rows(nodes, order, graph.outputs, sum(program.inputs))
        return cls(program.inputs, program.outputs, size, code, constant)


def _needed(nodes: list[Node], outputs: dict[int, int]) -> set[int]:
    found: set[int] = set()
    stack = list(outputs.values())
    while stack:
        n = stack.pop()
        if n not in found:
            found.add(n)
            stack.extend(_operands(nodes[n]))
    return found


def _operands(node: Node) -> tuple[int, ...]:
    return () if node.op in _LEAVES else node.rows


def _reciprocals(graph: Graph) -> list[Node]:
    """A divisor that serves more than once is inverted once."""
    needed = sorted(_needed(graph.nodes, graph.outputs))
    shared = Counter(graph.nodes[n].rows[-1] for n in needed if graph.nodes[n].op in (Op.DIV, Op.INV))
    for n in needed:
        node = graph.nodes[n]
        if node.op == Op.DIV and shared[node.rows[1]] > 1:
            inverse = graph.add(Node(Op.INV, (node.rows[1],)))
            graph.nodes[n] = Node(Block.PRODUCT, (node.rows[0], inverse))
    return graph.nodes


def _fused(nodes: list[Node], outputs: dict[int, int]) -> list[Node]:
    """What serves one sum, product or factor alone is taken into it."""
    order = sorted(n for n in _needed(nodes, outputs) if _operands(nodes[n]))
    uses = Counter(outputs.values())
    for n in order:
        uses.update(_operands(nodes[n]))
    result = list(nodes)
    for n in order:
        node = result[n]
        x, y = (*node.rows, n, n)[:2]
        inner = result[x]
        alone = uses[x] == 1 and inner.op == Block.PRODUCT
        if node.op == Block.SUM:
            other = result[y]
            if uses[y] == 1 and other.op == Block.PRODUCT:
                if alone:
                    rows, k, c = inner.rows + other.rows, node.k * inner.k, node.c * other.k
                    result[n] = Node(Block.TWO_PRODUCTS, rows, k, c)
                else:
                    result[n] = Node(Block.PRODUCT_SUM, (*other.rows, x), node.c * other.k, node.k)
            elif alone:
                result[n] = Node(Block.PRODUCT_SUM, (*inner.rows, y), node.k * inner.k, node.c)
        elif node.op == Block.AFFINE and alone:
            result[n] = Node(Block.PRODUCT_AFFINE, inner.rows, node.k * inner.k, node.c)
        elif node.op == Block.SCALE and uses[x] == 1 and inner.op in _SCALED:
            result[n] = Node(inner.op, inner.rows, node.k * inner.k, node.k * inner.c)
    return result


def _order(nodes: list[Node], outputs: dict[int, int]) -> list[int]:
    """Each node after its operands, close to where it is used, so that few rows are alive at once."""
    order: list[int] = []
    done: set[int] = set()
    for root in outputs.values():
        stack = [root]
        while stack:
            n = stack[-1]
            waiting = [o for o in _operands(nodes[n]) if o not in done]
            if n in done or not waiting:
                stack.pop()
                if n not in done:
                    done.add(n)
                    order.append(n)
            else:
                stack.append(waiting[0])
    return order


def _rows(
    nodes: list[Node], order: list[int], outputs: dict[int, int], inputs: int
) -> tuple[np.ndarray, np.ndarray, int]:
    """Instructions over work rows, the inputs' first; how many rows."""
    last = {o: place for place, n in enumerate(order) for o in (*_operands(nodes[n]), n)}
    columns: dict[int, list[int]] = {}
    for column, n in outputs.items():
        columns.setdefault(n, []).append(column)
    code: list[tuple[int, ...]] = []
    constant: list[tuple[float, float]] = []
    row: dict[int, int] = {}
    spare: list[int] = []
    size = inputs
    for place, n in enumerate(order):
        node = nodes[n]
        if node.op == Op.INPUT:
            row[n] = node.rows[0]
        else:
            if not spare:
                spare.append(size)
                size += 1
            row[n] = spare.pop()
            read = [row[o] for o in _operands(node)]
            code.append((node.op, *read, *(4 - len(read)) * [0], row[n]))
            constant.append((node.k, node.c))
        for column in columns.get(n, []):
            code.append((Op.OUTPUT, row[n], 0, 0, 0, column))
            constant.append((1.0, 0.0))
        spare += [row[o] for o in {*_operands(node), n} if last[o] == place and row[o] >= inputs]
    return np.array(code, dtype=np.int64).reshape(-1, 6), np.array(constant).reshape(-1, 2), size
