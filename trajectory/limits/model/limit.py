"""A limit: one object with its fields, the use that a motion makes of it, its constraint on the pace, and its words.

The verification of a motion calls only `use` (or `quantity` and `excess`). The laws call the rest. The two parts share
nothing but the limit's own numbers.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar, NamedTuple

import casadi as ca
import numpy as np

from kinematics import Array, JointMotion, Mechanism
from trajectory.limits.model.constraints import Along, Constraint
from trajectory.limits.model.field import LimitField
from trajectory.limits.model.over_intervals import IntervalRows, OverIntervals, SlopesOverIntervals
from trajectory.limits.model.stretch import Sampled
from trajectory.limits.model.values import LimitValues
from trajectory.motions import Motion, PoseMotion

NO_SLACK = Motion(PoseMotion(*np.zeros(4)), JointMotion(*np.zeros(4)), np.zeros(1))


class Use(NamedTuple):
    """One quantity at each sample, (..., m), or (..., 1) for the tool; SI units.

    `limit` and `ratio` are None if nothing limits the quantity. A ratio above 1 breaks the limit.
    """

    value: Array
    limit: Array | None
    ratio: Array | None


class SymbolicMotion(NamedTuple):
    """A motion at one instant, in symbols: the actuators' four orders, the tool point's two rates, the torque."""

    joints: tuple[ca.SX, ca.SX, ca.SX, ca.SX]
    tool_velocity: ca.SX
    tool_acceleration: ca.SX
    torque: ca.SX


class Limit(ABC):
    """A bound that a motion must keep. One file holds one kind. A limit that is not set has None in its fields.

    Attributes:
        name: the name of the quantity in tables, files and errors.
        fields: its fields of `Limits`; all of them are set, or none.
        both: the words of the error if only some of the fields are set.
        kind: the kind of its constraint on the pace along a way.
        exact: whether every motion within the limit keeps its constraint; false if the constraint is stricter. The
            emergency stop then leaves it out, is verified against the limit all the same, and may fail.
        pace_power: the power of the pace with which the quantity grows, about; 0 if no pace changes it. The default
            stretch and single moves use it.
        of_torque: whether the torque is part of it.
        not_for_moves: why a single move from pose to pose does not keep it; empty if it does.
    """

    name: ClassVar[str]
    fields: ClassVar[tuple[LimitField, ...]]
    both: ClassVar[str] = ""
    kind: ClassVar[type[Constraint]]
    exact: ClassVar[bool] = True
    pace_power: ClassVar[int]
    of_torque: ClassVar[bool] = False
    not_for_moves: ClassVar[str] = ""

    def is_set(self, limits: LimitValues) -> bool:
        """Whether the limit is set."""
        return getattr(limits, self.fields[0].name) is not None

    def least_stretch(self, peak: float, motion: Sampled, limits: LimitValues) -> float:  # noqa: ARG002
        """The least factor, at least 1, by which stretching the time brings a motion within the limit.

        Args:
            peak: the largest use of the motion, over the limit.
            motion: samples of the motion.
            limits: the limits, of which this one is set.

        Raises:
            LimitsExceeded: there is no such factor.
        """
        result: float = max(1.0, peak ** (1 / self.pace_power))
        return result

    def holding_torque(self, limits: LimitValues, count: int) -> Array | None:  # noqa: ARG002
        """(count,) the torque that it leaves to the drives at rest [N m or N]; None if it limits no torque."""
        return None

    @abstractmethod
    def constraint(self, along: Along, limits: LimitValues) -> Constraint:
        """Its constraint, of its `kind`, on the pace along a way."""

    def highest_over_intervals(self, slopes: SlopesOverIntervals, limits: LimitValues) -> Array | None:  # noqa: ARG002
        """(k,) the largest x in intervals of a path [m^2/s^2]; None if it does not bound x directly.

        A limit that gives neither this nor `rows_over_intervals` is left out of bounds of the least time, which is
        safe.
        """
        return None

    def rows_over_intervals(self, over: OverIntervals, limits: LimitValues) -> IntervalRows | None:  # noqa: ARG002
        """Its rows over intervals of a path, if any."""
        return None

    @abstractmethod
    def symbolic(self, motion: SymbolicMotion, limits: LimitValues) -> ca.SX:
        """The expression that must stay between -1 and 1; for a mean square, the quantity over its limit."""


class InstantLimit(Limit):
    """A limit that holds at every instant.

    Attributes:
        jumps: whether the quantity is infinite where the acceleration jumps.
    """

    jumps: ClassVar[bool] = False

    @abstractmethod
    def use(self, robot: Mechanism, motion: Motion, limits: LimitValues, slack: Motion) -> Use | None:
        """How much of it a motion uses, sample by sample; None if the quantity means nothing without a limit.

        Args:
            robot: the robot that moves.
            motion: (..., m) samples.
            limits: the limits; this one may be set or not.
            slack: bounds of the error of each sample; the result is then the largest possible use.
        """


class MeanSquareLimit(Limit):
    """A limit of the root mean square of a quantity over a way from rest to rest."""

    not_for_moves = "it is a mean over a cycle, and a single move is not a cycle"

    @abstractmethod
    def quantity(self, motion: Motion) -> Array:
        """(..., m) the quantity whose mean square is limited."""

    @abstractmethod
    def excess(self, slack: Motion, mean_torque: Array) -> tuple[Array, Array]:
        """How much larger the quantity can be in a part of the motion than in the part's middle, (k, m) each.

        Args:
            slack: bounds of the motion's distance from that in the middle.
            mean_torque: (k, m) bounds of the mean of |torque| minus |torque| in the middle.

        Returns:
            The bound at every instant, and the bound of the mean.
        """

    @abstractmethod
    def most(self, limits: LimitValues, count: int) -> Array | None:
        """(count,) the limit of the root mean square; None if it is not set."""


@np.errstate(over="ignore")  # a bound that is too wide proves nothing
def against(value: Array, limit: Array | None) -> Use:
    """The use of a quantity whose limit does not depend on anything else."""
    if limit is None:
        return Use(value, None, None)
    return Use(value, np.broadcast_to(limit, value.shape), value / limit)
