"""Margins: a number at each pose, the larger the better. Each is one object, which knows all that is asked of it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, fields
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, ClassVar

import casadi as ca
import numpy as np

from kinematics.arrays import Array, Value
from kinematics.mathematics import near_inverse
from kinematics.model.indices import FviBounds, sides, smallest

if TYPE_CHECKING:
    from kinematics.model.mechanism import Mechanism


@dataclass(frozen=True)
class Measure:
    """What the indices are measured with, in numbers or in symbols.

    Attributes:
        fvi: the fields of `FviBounds`.
        length: the characteristic length [m].
    """

    fvi: Any
    length: Any


@dataclass(frozen=True)
class ClaimSymbols:
    """Symbols of a claim's own numbers, which the geometry's join; all are fixed before anything is evaluated.

    Attributes:
        bound: what the margin must reach.
        measure: what the margin is measured with.
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
    def values(at_least: float, fvi: FviBounds, length: float) -> list[float]:
        """What the symbols stand for."""
        return [at_least, fvi.joint_speed, fvi.joint_effort, fvi.speed, fvi.force, length]


@dataclass(frozen=True, eq=False)
class ToShow(Value):
    """Expressions (c,) of which is shown whether they are at least 0; `scaling` holds symbols of any numbers.

    `matrix` is what these come from, in the middle of each box, by `chosen`: (k, r, c) plain values -> (k, rows,
    columns) of `scaling`. None where no scaling stands in the expressions.
    """

    expressions: ca.SX
    scaling: ca.SX
    matrix: ca.SX | None = None
    chosen: Callable[[Array], Array] = near_inverse


class Margin(ABC):
    """A number at each pose: the smallest of its components. A mechanism lists its own; one file holds one kind.

    Attributes:
        name: what studies and files call it.
        unit: of its numbers; empty where it has none. Radians or metres, by the joint, are `rad or m`.
        words: what it is, for people.
        holds_on_paths: a path is travelled only where it is above 0.
        of_jacobians: it follows from J_x and |J_q| alone, so that a mirror that keeps these keeps it.
        beyond_reach: it has a value where a limb cannot reach, too.
        singularity: the kind of singularity that it is 0 at; empty where it tells none.
    """

    name: ClassVar[str]
    unit: ClassVar[str] = ""
    words: ClassVar[str]
    holds_on_paths: ClassVar[bool] = False
    of_jacobians: ClassVar[bool] = False
    beyond_reach: ClassVar[bool] = False
    singularity: ClassVar[str] = ""

    @abstractmethod
    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:
        """(k,) in the symbols `pose` and `geometry` of the robot's model, each to be at least the bound."""

    def limbs(self, robot: Mechanism) -> list[int] | None:  # noqa: ARG002
        """(k,) the limb of each component, counted from 1; None where they belong to no limb."""
        return None

    def smallest(self, robot: Mechanism, measure: Measure) -> ca.SX:
        """The margin itself."""
        return smallest(self.components(robot, measure))

    def to_refute(self, robot: Mechanism, claim: ClaimSymbols) -> ToShow:
        """Expressions of which none is below 0 where the margin has a value and reaches the bound, for any scaling."""
        return ToShow(self.components(robot, claim.measure) - claim.bound, ca.SX(0, 0))

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """What implies that the margin reaches the bound everywhere in a connected region.

        Interval bounds of a quotient of norms are wide, those of the determinants behind it far tighter: margins of
        that kind replace this. Here a minimum is taken apart, and a modulus replaced by the function with its sign:

        |u| >= c for a continuous u on a connected region: s u - c >= 0 with one sign s = +-1 implies it for every c,
        and for c > 0 no other way exists. The sign is taken at a pose of the region; a wrong one only fails to prove.

        Args:
            inside: (n,) a pose of the region, which gives the signs.
            positive: whether the bound is above 0.
        """
        components = self.components(robot, claim.measure)
        parts = [part for i in range(components.numel()) for part in sides(components[i])]
        parts = [part for part in parts if not (part.is_constant() and float(part) == np.inf)]  # nothing limits these
        if positive:
            parts = [signed(robot, p.dep(0), inside) if p.op() == ca.OP_FABS else p for p in parts]
        return ToShow(ca.vertcat(*parts) - claim.bound if parts else ca.SX(0, 1), ca.SX(0, 0))


def signed(robot: Mechanism, expression: ca.SX, inside: Array) -> ca.SX:
    """An expression times the signs that it has at a pose."""
    model = robot.model()
    at = ca.Function("sign", [model.pose, model.geometry], [expression])(inside, robot.geometry.vector())
    return ca.SX(np.where(np.array(at) < 0.0, -1.0, 1.0)) * expression


def by_name(*margins: Margin) -> dict[str, Margin]:
    """What a mechanism's `margins` holds."""
    return {margin.name: margin for margin in margins}
