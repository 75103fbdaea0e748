"""Expressions as sums of products with exact coefficients. Equal forms are equal functions.

A sine, a root, a quotient and so on is an atom: an unknown that is named by its operands' forms. All rules hold for all
real numbers: sums and products are expanded, sin(-x) = -sin x, cos(-x) = cos x, |-x| = |x|. No quotient is cancelled.
"""

from __future__ import annotations

from collections.abc import Hashable
from fractions import Fraction
from typing import Any

import casadi as ca
import numpy as np

from kinematics import LinkwrightError, Op, Program, run_through

_MOST_TERMS = 2000  # of a form; with more terms the comparison would take too long
Monomial = tuple[Hashable, ...]  # atoms in order; a squared atom is there twice


class NoForm(LinkwrightError):
    """An expression has an operation without a rule, a number that is not finite, or too many terms."""


class Form:
    """A sum of monomials. It is immutable."""

    def __init__(self, terms: dict[Monomial, Fraction]) -> None:
        self._terms = {monomial: factor for monomial, factor in terms.items() if factor}
        if len(self._terms) > _MOST_TERMS:
            raise NoForm(f"more than {_MOST_TERMS} terms")
        self.key = tuple(sorted(self._terms.items(), key=repr))

    @classmethod
    def of(cls, value: Form | float) -> Form:
        """The form of a number is its exact value."""
        return value if isinstance(value, Form) else cls({(): Fraction(value)})

    @classmethod
    def atom(cls, name: Hashable) -> Form:
        """The form of one unknown."""
        return cls({(name,): Fraction(1)})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Form) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)

    def __neg__(self) -> Form:
        return Form({monomial: -factor for monomial, factor in self._terms.items()})

    def __add__(self, other: Form) -> Form:
        terms = dict(self._terms)
        for monomial, factor in other._terms.items():
            terms[monomial] = terms.get(monomial, Fraction(0)) + factor
        return Form(terms)

    def __mul__(self, other: Form) -> Form:
        terms: dict[Monomial, Fraction] = {}
        for left, a in self._terms.items():
            for right, b in other._terms.items():
                monomial = tuple(sorted((*left, *right), key=repr))
                terms[monomial] = terms.get(monomial, Fraction(0)) + a * b
        return Form(terms)

    def signed(self) -> tuple[int, Form]:
        """+1 or -1, and a form: of two opposite forms always the same one, so that their product is this form."""
        return (-1, -self) if self.key and self.key[0][1] < 0 else (1, self)


def forms(symbols: list[ca.SX], expressions: ca.SX, inputs: list[Form]) -> tuple[list[Form], set[Form]]:
    """Forms of the entries, row by row, with the inputs instead of the symbols; and all forms that must be defined.

    Raises:
        NoForm: an entry has no such form.
    """
    partial: set[Form] = set()
    program = Program.of(ca.Function("form", symbols, [ca.densify(expressions)]))

    def needed(name: str, *operands: Any) -> Form:
        form = Form.atom((name, *(Form.of(o).key for o in operands)))
        partial.add(form)
        return form

    def odd(name: str, operand: Any, sign_kept: bool) -> Form:
        sign, form = Form.of(operand).signed()
        atom = Form.atom((name, form.key))
        return -atom if sign < 0 and sign_kept else atom

    rules = {
        Op.ASSIGN: lambda a, _: a,
        Op.ADD: lambda a, b: Form.of(a) + Form.of(b),
        Op.SUB: lambda a, b: Form.of(a) + -Form.of(b),
        Op.MUL: lambda a, b: Form.of(a) * Form.of(b),
        Op.SQ: lambda a, _: Form.of(a) * Form.of(a),
        Op.NEG: lambda a, _: -Form.of(a),
        Op.TWICE: lambda a, _: Form.of(a) + Form.of(a),
        Op.SQRT: lambda a, _: needed("sqrt", a),
        Op.INV: lambda a, _: needed("inverse", a),
        Op.DIV: lambda a, b: Form.of(a) * needed("inverse", b),
        Op.SIN: lambda a, _: odd("sin", a, True),
        Op.COS: lambda a, _: odd("cos", a, False),
        Op.FABS: lambda a, _: odd("abs", a, False),
    }
    missing = {Op(int(op)) for op in program.op} - {Op.CONST, Op.INPUT, Op.OUTPUT} - rules.keys()
    if missing or not np.isfinite(program.constant).all():
        raise NoForm(f"{missing or 'a constant that is not finite'}")
    return [Form.of(value) for value in run_through(program, inputs, rules)], partial
