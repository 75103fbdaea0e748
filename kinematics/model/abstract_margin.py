"""Margins: a number at each pose, and whether a larger or a smaller one is better. Each is one object with its data."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, fields
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, ClassVar

import casadi as ca
import numpy as np

from kinematics.arrays import Array, Value
from kinematics.errors import InvalidValue
from kinematics.mathematics import near_inverse
from kinematics.model.bound import Bound
from kinematics.model.indices import FviBounds, largest, sides, smallest

if TYPE_CHECKING:
    from kinematics.model.mechanism import Mechanism


@dataclass(frozen=True)
class Measure:
    """The data that the indices are measured with, in numbers or in symbols.

    Attributes:
        fvi: the fields of `FviBounds`.
        length: the characteristic length [m].
    """

    fvi: Any
    length: Any


@dataclass(frozen=True)
class ClaimSymbols:
    """Symbols of a claim's own numbers. Like those of the geometry they get values before anything is evaluated.

    Attributes:
        bound: the bound that the margin must reach.
        measure: the data that the margin is measured with.
    """

    bound: ca.SX
    measure: Measure

    @classmethod
    def fresh(cls) -> ClaimSymbols:
        """New symbols."""
        fvi = SimpleNamespace(**{f.name: ca.SX.sym(f.name) for f in fields(FviBounds)})
        return cls(ca.SX.sym("bound"), Measure(fvi, ca.SX.sym("length")))

    @property
    def vector(self) -> ca.SX:
        """(6,) in the order of `values`."""
        f = self.measure.fvi
        return ca.vertcat(self.bound, f.joint_speed, f.joint_effort, f.speed, f.force, self.measure.length)

    @staticmethod
    def values(bound: float, fvi: FviBounds, length: float) -> list[float]:
        """The values of the symbols."""
        return [bound, fvi.joint_speed, fvi.joint_effort, fvi.speed, fvi.force, length]


@dataclass(frozen=True, eq=False)
class ToShow(Value):
    """Expressions (c,) that must be shown to be at least 0; `scaling` holds symbols that may have any values.

    The function `chosen` computes these values from `matrix` in the middle of each box: (k, r, c) plain values ->
    (k, rows, columns) of `scaling`. Both are None if the expressions have no scaling.
    """

    expressions: ca.SX
    scaling: ca.SX
    matrix: ca.SX | None = None
    chosen: Callable[[Array], Array] = near_inverse


class Margin(ABC):
    """A number at each pose: the worst of its components. A mechanism lists its own; one file holds one kind.

    Attributes:
        name: its name in studies and files.
        sense: 1 if a larger number is better, so that a bound says `at_least`; -1 if a smaller one is better, so that a
            bound says `at_most`.
        lowest: no value is below it, for any geometry.
        unit: the unit of its numbers; empty if there is none. `rad or m` depends on the joint.
        words: a description for people.
        holds_on_paths: whether it must be above 0 at every pose of a path.
        shown_on_paths: whether the proof along a path needs `to_show`, as its components' own bounds are too wide.
        of_jacobians: whether it depends only on J_x and |J_q|, for any robot.
        beyond_reach: whether it has a value even where a limb cannot reach.
        of_members: whether it is the safety factor of the members, of which a cycle's motion has its own too.
        singularity: the kind of singularity where it is 0; empty if it shows none.
        records: the robot's records that it depends on, besides geometry and ranges: inertia, structure, load.
    """

    name: ClassVar[str]
    sense: ClassVar[int] = 1
    lowest: ClassVar[float] = -math.inf
    unit: ClassVar[str] = ""
    words: ClassVar[str]
    holds_on_paths: ClassVar[bool] = False
    shown_on_paths: ClassVar[bool] = False
    of_jacobians: ClassVar[bool] = False
    beyond_reach: ClassVar[bool] = False
    of_members: ClassVar[bool] = False
    singularity: ClassVar[str] = ""
    records: ClassVar[tuple[str, ...]] = ()

    @abstractmethod
    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:
        """(k,) expressions in the symbols `pose` and `geometry` of the model. Each must keep the bound.

        A new margin needs no other method. Interval arithmetic knows sums, products, quotients, roots, sines, cosines,
        `atan2`, `fabs`, `fmin` and `fmax`. Write a modulus or the worst of several numbers (their minimum, or where
        smaller is better their maximum) as the outermost operation: it is then split.
        """

    def mirrored(self, robot: Mechanism) -> bool:  # noqa: ARG002
        """Whether a mirror that keeps J_x and |J_q|, in another order of the limbs, keeps the margin of this robot."""
        return self.of_jacobians

    def places(self, robot: Mechanism) -> list[str] | None:  # noqa: ARG002
        """(k,) the place of each component in words, such as "limb 1"; None if components have none of their own."""
        return None

    def worst(self, robot: Mechanism, measure: Measure) -> ca.SX:
        """The margin itself."""
        return (smallest if self.sense > 0 else largest)(self.components(robot, measure))

    def bound(self, at_least: float | None = None, at_most: float | None = None) -> Bound:
        """The bound of this margin, given by the right one of two words.

        Raises:
            InvalidValue: the other word is given, or none.
        """
        right, wrong = (at_least, at_most) if self.sense > 0 else (at_most, at_least)
        if right is None or wrong is not None:
            found = "no bound" if wrong is None else f"{'at_most' if self.sense > 0 else 'at_least'} = {wrong}"
            raise InvalidValue(f"bound of {self.name}", found, self.right_word)
        return Bound(right, self.sense)

    @property
    def word(self) -> str:
        """The word of its bounds: `at_least` or `at_most`."""
        return Bound.weakest(self.sense).word

    @property
    def right_word(self) -> str:
        """The word of its bounds, and why, for an error."""
        return f"{self.word}, as {self.name} is better {'larger' if self.sense > 0 else 'smaller'}"

    def to_refute(self, robot: Mechanism, claim: ClaimSymbols) -> ToShow:
        """Expressions that are all at least 0, for any scaling, where the margin has a value and reaches the bound."""
        return ToShow(self.sense * (self.components(robot, claim.measure) - claim.bound), ca.SX(0, 0))

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """Expressions that, if all are at least 0, imply that the margin reaches the bound in a connected region.

        Interval bounds of a quotient of norms are wide. Bounds of its determinants are much closer, so margins of that
        kind override this method. Here a minimum is split into its parts, and a modulus is replaced by the function
        with its sign. Let u be continuous on a connected region. If s u - c >= 0 with one sign s = +-1, then |u| >= c.
        For c > 0 there is no other way. The sign is that at one pose of the region. With a wrong sign the proof fails,
        but nothing false is proved. For |u| <= c both signs are shown.

        Args:
            inside: (n,) a pose of the region; it decides the signs.
            positive: whether the bound is above 0.
        """
        components = self.components(robot, claim.measure)
        least = self.sense > 0
        worst = ca.OP_FMIN if least else ca.OP_FMAX
        parts = [part for i in range(components.numel()) for part in sides(components[i], worst)]
        parts = [p for p in parts if not (p.is_constant() and float(p) == self.sense * np.inf)]  # it always holds
        if positive and least:
            parts = [signed(robot, p.dep(0), inside) if p.op() == ca.OP_FABS else p for p in parts]
        if not least:
            parts = [q for p in parts for q in ((p.dep(0), -p.dep(0)) if p.op() == ca.OP_FABS else (p,))]
        return ToShow(self.sense * (ca.vertcat(*parts) - claim.bound) if parts else ca.SX(0, 1), ca.SX(0, 0))


def signed(robot: Mechanism, expression: ca.SX, inside: Array) -> ca.SX:
    """An expression times the signs that it has at a pose."""
    model = robot.model()
    at = ca.Function("sign", [model.pose, model.geometry], [expression])(inside, robot.geometry.vector())
    return ca.SX(np.where(np.array(at) < 0.0, -1.0, 1.0)) * expression


def by_name(*margins: Margin) -> dict[str, Margin]:
    """The margins by name, for a mechanism's `margins`."""
    return {margin.name: margin for margin in margins}
