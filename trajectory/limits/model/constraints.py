"""What a limit asks of a pace on a way, in a few kinds: the laws know these, and not the limits.

A way p is known by its derivatives by a parameter, such as the arc length: a dash stands for them. The pace is how fast
the parameter grows; u is its second and z sqrt(x) its third derivative by time, and x the square of its first.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from kinematics import Array, JointMotion


class TorqueAlong(NamedTuple):
    """tau = inertia u + square x + viscous sqrt(x) + constant + friction, (..., m) each [N m or N].

    Attributes:
        inertia, square, viscous, constant: as above.
        friction: the Coulomb friction that a law keeps apart from the constant; how it enters, that law knows.
        whole: the constant with all friction, as the way goes.
    """

    inertia: Array
    square: Array
    viscous: Array
    constant: Array
    friction: Array
    whole: Array


@dataclass(frozen=True, eq=False)
class Along:
    """A way at some of its points.

    Attributes:
        joints: of the actuators by the parameter, (..., m) each.
        tool: the first two derivatives of the tool point by the parameter, (..., 2 or 3) each.
        split: finds `torque`; it is called only where a limit asks for it.
    """

    joints: JointMotion
    tool: tuple[Array, Array]
    split: Callable[[], TorqueAlong]

    @cached_property
    def torque(self) -> TorqueAlong:
        """The torque's parts."""
        return self.split()


@dataclass(frozen=True, eq=False)
class Place:
    """Decided by where the way is, whatever the pace."""


@dataclass(frozen=True, eq=False)
class Cap:
    """x <= most, (...,); infinite where nothing moves."""

    most: Array


@dataclass(frozen=True, eq=False)
class Linear:
    """|by_u u + by_x x + by_rate sqrt(x) + constant + friction| <= 1, (..., rows) each.

    `friction` is that of `TorqueAlong`, over the limit.
    """

    by_u: Array
    by_x: Array
    by_rate: Array
    constant: Array
    friction: Array


@dataclass(frozen=True, eq=False)
class Sloped(Linear):
    """|...| + slope sqrt(x) <= 1, the rest as in `Linear`."""

    slope: Array


@dataclass(frozen=True, eq=False)
class Disc:
    """|by_u u + by_x x| <= 1, vectors (..., 2 or 3)."""

    by_u: Array
    by_x: Array


@dataclass(frozen=True, eq=False)
class Third:
    """sqrt(x) |by_z z + by_u u + by_x x| <= 1, (..., rows) each."""

    by_z: Array
    by_u: Array
    by_x: Array


@dataclass(frozen=True, eq=False)
class Squared:
    """The mean over the time of (by_u u + by_x x + by_rate sqrt(x) + constant)^2 is at most 1, (..., rows) each."""

    by_u: Array
    by_x: Array
    by_rate: Array
    constant: Array


Constraint = Place | Cap | Linear | Disc | Third | Squared


def torque_over(limit: Array, torque: TorqueAlong) -> tuple[Array, Array, Array, Array, Array]:
    """The five parts of a `Linear` for the torque over a limit (m,)."""
    t = torque
    return t.inertia / limit, t.square / limit, t.viscous / limit, t.constant / limit, t.friction / limit
