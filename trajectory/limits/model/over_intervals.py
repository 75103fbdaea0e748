"""Rows that a limit gives over intervals of a path, for any pace inside; they are used in lower bounds of the time.

Here s is the arc length, u = s'' and x = s'^2. Each coefficient has a value in the middle of an interval, and a radius
by which it may differ inside.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Self

from kinematics import Array


class IntervalRows(NamedTuple):
    """|a u + b x + c| <= 1 over intervals of s, (k, rows) each: a at both ends, and each coefficient in the middle with
    the radius by which it may differ inside. w = b - a' / 2, a dash for the derivative by s."""

    a_start: Array
    a_end: Array
    a: Array
    a_radius: Array
    b: Array
    b_radius: Array
    c: Array
    c_radius: Array
    w: Array
    w_radius: Array

    def over(self, limit: Array | float) -> Self:
        """All over a limit."""
        return type(self)(*(part / limit for part in self))


class SlopesOverIntervals(NamedTuple):
    """The slopes of a path in intervals: `joints` (k, m) is what |dq/ds| is at least; `moving` (k,) says where the tool
    point moves, and then as far as the arc length says."""

    joints: Array
    moving: Array


@dataclass(frozen=True, eq=False)
class OverIntervals:
    """A path in intervals of its arc length.

    Attributes:
        acceleration: rows of the actuators' acceleration, in SI units.
        split: finds `torque`, the rows of the torque, friction in c.
        bend: finds `tool`, the rows of the tool's acceleration in some directions.
    """

    acceleration: IntervalRows
    split: Callable[[], IntervalRows]
    bend: Callable[[], IntervalRows]

    @cached_property
    def torque(self) -> IntervalRows:
        """In SI units."""
        return self.split()

    @cached_property
    def tool(self) -> IntervalRows:
        """In SI units."""
        return self.bend()
