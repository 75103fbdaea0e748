"""A program prepared for interval evaluation: values that do not depend on the box are computed once, as intervals.

The geometry's numbers are the exact values of their doubles. Every constant that follows from them is an interval
around the real number. Nothing is computed in plain floating point, neither in a function nor in its gradient.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from kinematics.arrays import Value
from kinematics.errors import InvalidValue
from kinematics.evaluation.interval_interpreter import operate
from kinematics.evaluation.program import Op, Program

# Defined for all real operands.
_TOTAL = {Op.ADD, Op.SUB, Op.MUL, Op.SQ, Op.NEG, Op.TWICE, Op.SIN, Op.COS, Op.ASSIGN, Op.LT, Op.LE, Op.NOT}
_ZERO, _ONE = (0.0, 0.0), (1.0, 1.0)


@dataclass(frozen=True, eq=False)
class BoxProgram(Value):
    """Instructions as in `Program`, with CONST an interval; no instruction writes where it reads."""

    op: np.ndarray  # (k,) int64
    left: np.ndarray  # (k,) int64
    right: np.ndarray  # (k,) int64
    target: np.ndarray  # (k,) int64
    low: np.ndarray  # (k,) of constants
    high: np.ndarray  # (k,)
    work_size: int
    inputs: int
    outputs: int

    @classmethod
    def of(cls, program: Program, fixed: Sequence[float] = ()) -> BoxProgram:
        """Fix the last input columns at these numbers and compute what follows from them alone.

        Raises:
            InvalidValue: more numbers than columns, or one that is NaN.
        """
        free = sum(program.inputs) - len(fixed)
        if free < 0 or np.isnan(np.asarray(fixed, dtype=float)).any():
            raise InvalidValue("fixed inputs", list(fixed), f"at most {sum(program.inputs)} numbers")
        graph = _Graph()
        work, outputs = [0] * program.work_size, {}
        rows = zip(*(c.tolist() for c in (program.op, program.left, program.right, program.target)), strict=True)
        for (code, left, right, target), constant in zip(rows, program.constant.tolist(), strict=True):
            op = Op(code)
            if op is Op.CONST:
                work[target] = graph.constant(constant, constant)
            elif op is Op.INPUT:
                given = left >= free
                work[target] = graph.constant(*(2 * [float(fixed[left - free])])) if given else graph.input(left)
            elif op is Op.OUTPUT:
                outputs[target] = work[left]
            else:
                work[target] = graph.operation(op, work[left], work[right])
        table, work_size = graph.emit(outputs)
        code, left_, right_, target_ = (np.array([row[i] for row in table], dtype=np.int64) for i in range(4))
        low, high = (np.array([row[i] for row in table]) for i in (4, 5))
        return cls(code, left_, right_, target_, low, high, work_size, free, program.output_size)


@dataclass
class _Graph:
    """Each value once, in an order in which operands come first."""

    nodes: list[tuple[Op, int, int]] = field(default_factory=list)
    constants: dict[int, tuple[float, float]] = field(default_factory=dict)
    total: list[bool] = field(default_factory=list)  # defined whatever the inputs
    _known: dict[object, int] = field(default_factory=dict)

    def _add(self, key: tuple[Op, int, int], total: bool, unique: object = None) -> int:
        key_ = (key, unique)
        if key_ not in self._known:
            self._known[key_] = len(self.nodes)
            self.nodes.append(key)
            self.total.append(total)
        return self._known[key_]

    def constant(self, low: float, high: float) -> int:
        """An interval; unbounded where it is NaN."""
        if not low <= high:
            low, high = -np.inf, np.inf
        node = self._add((Op.CONST, 0, 0), bool(np.isfinite(low + high)), (low, high))
        self.constants[node] = (low, high)
        return node

    def input(self, column: int) -> int:
        """A column of the boxes."""
        return self._add((Op.INPUT, column, 0), True)

    def operation(self, op: Op, a: int, b: int) -> int:
        """Computed at once where both operands are constant; exact identities are used."""
        x, y = self.constants.get(a), self.constants.get(b)
        if x is not None and y is not None:
            return self.constant(*operate(op, x, y, a == b))
        if op is Op.ASSIGN or (op in (Op.ADD, Op.SUB) and y == _ZERO) or (op in (Op.MUL, Op.DIV) and y == _ONE):
            return a
        if (op is Op.ADD and x == _ZERO) or (op is Op.MUL and x == _ONE):
            return b
        if op is Op.SUB and x == _ZERO:
            return self.operation(Op.NEG, b, b)
        if op is Op.MUL and ((x == _ZERO and self.total[b]) or (y == _ZERO and self.total[a])):
            return self.constant(0.0, 0.0)
        return self._add((op, a, b), op in _TOTAL and self.total[a] and self.total[b])

    def emit(self, outputs: dict[int, int]) -> tuple[list[tuple[int, int, int, int, float, float]], int]:
        """Rows (op, left, right, target, low, high) of what the outputs need, and how many registers they use."""
        needed, stack = set(), list(outputs.values())
        while stack:
            node = stack.pop()
            if node not in needed:
                needed.add(node)
                stack.extend(self._operands(node))
        columns_of: dict[int, list[int]] = {}
        for column, node in outputs.items():
            columns_of.setdefault(node, []).append(column)
        order = sorted(n for n in needed if n not in self.constants)
        order += [n for n in columns_of if n in self.constants]
        last = {operand: place for place, node in enumerate(order) for operand in (*self._operands(node), node)}
        rows: list[tuple[int, int, int, int, float, float]] = []
        registers = _Registers()

        def load(node: int) -> int:
            if node in self.constants and not registers.holds(node):
                rows.append((Op.CONST, 0, 0, registers.take(node), *self.constants[node]))
            return registers.place[node]

        for place, node in enumerate(order):
            op, a, b = self.nodes[node]
            if op is Op.INPUT:
                rows.append((op, a, 0, registers.take(node), 0.0, 0.0))
            elif op is not Op.CONST:
                left, right = load(a), load(b)
                rows.append((op, left, right, registers.take(node), 0.0, 0.0))
            rows += [(Op.OUTPUT, load(node), 0, column, 0.0, 0.0) for column in columns_of.get(node, [])]
            for used in {*self._operands(node), node}:
                if last[used] == place:
                    registers.free(used)
        return rows, registers.count

    def _operands(self, node: int) -> tuple[int, ...]:
        op, a, b = self.nodes[node]
        return () if op in (Op.INPUT, Op.CONST) else (a, b)


@dataclass
class _Registers:
    """Which value lies in which work row."""

    place: dict[int, int] = field(default_factory=dict)
    count: int = 0
    _spare: list[int] = field(default_factory=list)

    def holds(self, node: int) -> bool:
        return node in self.place

    def take(self, node: int) -> int:
        if self._spare:
            self.place[node] = self._spare.pop()
        else:
            self.place[node] = self.count
            self.count += 1
        return self.place[node]

    def free(self, node: int) -> None:
        self._spare.append(self.place.pop(node))
