"""A limit: one object that knows its fields, what a motion uses of it, what it asks of a pace, and its words.

What verifies a motion asks `use` (or `quantity` and `excess`) alone; the laws ask the rest. The two share nothing but
the limit's own numbers.
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

    `limit` and `ratio` are None where nothing limits the quantity; a ratio over 1 breaks the limit.
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
    """What a motion may not exceed. One file holds one kind; a limit that is not set has None in its fields.

    Attributes:
        name: of the quantity; tables, files and errors call it so.
        fields: of `Limits`, all of them set or none.
        both: what is asked for where only some of the fields are set.
        kind: of the constraint that it is to a pace on a way.
        exact: whether a motion within the limit keeps its constraint; false where that asks for more than the limit.
        pace_power: of the pace, with which the quantity grows, about; 0 where no pace changes it.
        of_torque: whether the torque is part of it.
        not_for_moves: why a single move from pose to pose does not keep it; empty where it does.
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
        """Whether a motion has to keep it."""
        return getattr(limits, self.fields[0].name) is not None

    def least_stretch(self, peak: float, motion: Sampled, limits: LimitValues) -> float:  # noqa: ARG002
        """The least factor, at least 1, by which stretching the time brings a motion within the limit.

        Args:
            peak: what the motion uses, over the limit.
            motion: what it does.
            limits: of which this one is set.

        Raises:
            LimitsExceeded: no factor does.
        """
        result: float = max(1.0, peak ** (1 / self.pace_power))
        return result

    def holding_torque(self, limits: LimitValues, count: int) -> Array | None:  # noqa: ARG002
        """(count,) what it leaves to the drives at rest [N m or N]; None where it limits no torque."""
        return None

    @abstractmethod
    def constraint(self, along: Along, limits: LimitValues) -> Constraint:
        """What it asks of a pace on a way, of its `kind`."""

    def highest_over_intervals(self, slopes: SlopesOverIntervals, limits: LimitValues) -> Array | None:  # noqa: ARG002
        """(k,) the largest x in intervals of a path [m^2/s^2]; None where it bounds none by itself.

        Bounds of the least time leave out what gives neither this nor `rows_over_intervals`, which is safe.
        """
        return None

    def rows_over_intervals(self, over: OverIntervals, limits: LimitValues) -> IntervalRows | None:  # noqa: ARG002
        """What it asks in intervals of a path."""
        return None

    @abstractmethod
    def symbolic(self, motion: SymbolicMotion, limits: LimitValues) -> ca.SX:
        """What it keeps between -1 and 1; of a mean square the quantity over its limit."""


class InstantLimit(Limit):
    """A limit that holds at every instant.

    Attributes:
        jumps: whether the quantity is without bound where the acceleration jumps.
    """

    jumps: ClassVar[bool] = False

    @abstractmethod
    def use(self, robot: Mechanism, motion: Motion, limits: LimitValues, slack: Motion) -> Use | None:
        """What a motion uses of it, sample by sample; None where there is nothing to tell without a limit.

        Args:
            robot: of the motion.
            motion: (..., m) samples.
            limits: in which this one may be set or not.
            slack: how far each sample may be from what it is; the most that it may use is then found.
        """


class MeanSquareLimit(Limit):
    """A limit of the root mean square of a quantity over a way from rest to rest."""

    not_for_moves = "it is a mean over a cycle, which a single move is none of"

    @abstractmethod
    def quantity(self, motion: Motion) -> Array:
        """(..., m) whose mean square is limited."""

    @abstractmethod
    def excess(self, slack: Motion, mean_torque: Array) -> tuple[Array, Array]:
        """By how much the size of the quantity may exceed that in the middle of a part of the motion, (k, m) each.

        Args:
            slack: how far the motion may be from that in the middle.
            mean_torque: (k, m) by how much the mean of |torque| may exceed |torque| in the middle.

        Returns:
            At most, and in the mean.
        """

    @abstractmethod
    def most(self, limits: LimitValues, count: int) -> Array | None:
        """(count,) of the root mean square; None where it is not set."""


@np.errstate(over="ignore")  # a bound that is too wide proves nothing
def against(value: Array, limit: Array | None) -> Use:
    """The use of a quantity whose limit does not depend on anything else."""
    if limit is None:
        return Use(value, None, None)
    return Use(value, np.broadcast_to(limit, value.shape), value / limit)
