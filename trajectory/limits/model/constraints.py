"""The few kinds of constraints that limits put on the pace along a way. The laws know these kinds, and not the limits.

A way p has a parameter, such as the arc length; a dash is the derivative by it. The pace is the rate of the parameter
in
time: x is the square of this rate, u the second derivative of the parameter by time, and z sqrt(x) the third.
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
        friction: the Coulomb friction that a law keeps apart from the constant; the law decides how to use it.
        whole: the constant with all friction, in the direction of the way.
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
        joints: derivatives of the actuators by the parameter, (..., m) each.
        tool: the first two derivatives of the tool point by the parameter, (..., 2 or 3) each.
        split: computes `torque`; it is called only if a limit needs it.
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
    """A constraint that only the place of the way decides, at any pace."""


@dataclass(frozen=True, eq=False)
class Cap:
    """x <= most, (...,); `most` is infinite where nothing moves."""

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
    """sqrt(x) |by_z z + by_u u + by_x x| <= 1, (..., rows) each; none of them from `Along.torque`."""

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
