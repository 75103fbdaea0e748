"""Differences of expressions in which equal summands cancel before anything is evaluated.

The difference of two points of one platform does not depend on where the platform is. Written out, its intervals are
as wide as the platform moves; with equal summands cancelled they are exact.
"""

from __future__ import annotations

from collections.abc import Iterator

import casadi as ca


class LinearForms:
    """Vectors as sums of terms; differences of two vectors split into what depends on a symbol and what does not.

    The vectors must come from one evaluation with common subexpressions shared (`ca.cse`), so that equal terms are one
    node.
    """

    def __init__(self, symbol: ca.SX) -> None:
        """Terms that depend on `symbol` are told from those that do not."""
        self._symbol = symbol
        self._depends: dict[int, bool] = {}
        self._terms: dict[int, dict[int, tuple[float, ca.SX]]] = {}
        self._sums: dict[tuple[tuple[int, float], ...], ca.SX] = {}

    def difference(self, to: ca.SX, start: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Vectors (k,) -> to - start as the sum of two vectors (k,): one that moves with the symbol, one fixed.

        Equal parts of two differences are one node.
        """
        moving, fixed = [], []
        for row in range(to.shape[0]):
            terms = dict(self._of(to[row]))
            for name, (factor, leaf) in self._of(start[row]).items():
                terms[name] = terms.get(name, (0.0, leaf))[0] - factor, leaf
            left = {name: term for name, term in terms.items() if term[0]}
            moves = {name: self._moves(name, leaf) for name, (_, leaf) in left.items()}
            moving.append(self._sum({name: term for name, term in left.items() if moves[name]}))
            fixed.append(self._sum({name: term for name, term in left.items() if not moves[name]}))
        return ca.vertcat(*moving), ca.vertcat(*fixed)

    def _sum(self, terms: dict[int, tuple[float, ca.SX]]) -> ca.SX:
        """The sum; equal terms give one node."""
        key = tuple(sorted((name, factor) for name, (factor, _) in terms.items()))
        if key not in self._sums:
            self._sums[key] = sum((factor * leaf for factor, leaf in terms.values()), ca.SX(0))
        return self._sums[key]

    def _of(self, expression: ca.SX) -> dict[int, tuple[float, ca.SX]]:
        name = expression.element_hash()
        if name not in self._terms:
            found: dict[int, tuple[float, ca.SX]] = {}
            for sign, leaf in _leaves(expression):
                key = leaf.element_hash()
                found[key] = found.get(key, (0.0, leaf))[0] + sign, leaf
            self._terms[name] = found
        return self._terms[name]

    def _moves(self, name: int, leaf: ca.SX) -> bool:
        if name not in self._depends:
            self._depends[name] = bool(ca.depends_on(leaf, self._symbol))
        return self._depends[name]


def _leaves(expression: ca.SX) -> Iterator[tuple[float, ca.SX]]:
    stack = [(1.0, expression)]
    while stack:
        sign, x = stack.pop()
        kind = None if x.is_constant() or x.is_symbolic() else x.op()
        if kind in (ca.OP_ADD, ca.OP_SUB):
            stack += [(sign, x.dep(0)), (sign if kind == ca.OP_ADD else -sign, x.dep(1))]
        elif kind == ca.OP_NEG:
            stack.append((-sign, x.dep(0)))
        else:
            yield sign, x
