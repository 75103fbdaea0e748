"""The ranges of a mechanism's joints, driven and passive."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.errors import InvalidField
from kinematics.machine.geometry_record import numbers_of

Pair = tuple[float, float]
# Squared sine of a tilt that is taken for smaller ones, beyond what doubles tell apart from 0 beside an angle of
# about 1: there the tilt's cone has its tip, without a gradient, and joints often rest in it.
_TIP = 1e-26


@dataclass(frozen=True)
class JointRanges:
    """The ranges of the driven joints.

    Attributes:
        joints: lowest and highest value, one pair for all driven joints or one for each [m or rad]; may be infinite.
    """

    dimensions: ClassVar[Mapping[str, str]] = {}  # as in a geometry, of the other fields
    joints: Pair | tuple[Pair, ...] = (-math.inf, math.inf)

    def limits(self, count: int) -> Array:
        """(count, 2) lowest and highest value of each driven joint.

        Raises:
            InvalidValue: there is not one pair, or one for each joint, or the lower value of a pair is not first.
        """
        given = numbers_of(self.joints)
        if given is None or given.shape not in ((2,), (count, 2)) or not (given[..., 0] < given[..., 1]).all():
            wanted = f"lowest < highest, one pair or {count} pairs"
            raise InvalidField(type(self).__name__, "joints", self.joints, wanted)
        return np.broadcast_to(given, (count, 2))

    def check(self, count: int) -> None:
        """Check every number, for `count` driven joints.

        Raises:
            InvalidValue: naming the field.
        """
        self.limits(count)


@dataclass(frozen=True)
class RodRanges(JointRanges):
    """The ranges of the driven joints and of the joints at the rods' ends.

    Attributes:
        passive: the largest angles from rest, at the rods' ends on the drives and at those on the platform [rad].
    """

    dimensions: ClassVar[Mapping[str, str]] = {"passive": "angle"}
    passive: Pair = (1.0, 1.0)

    def check(self, count: int) -> None:
        """As for `JointRanges`; and each passive angle must be in (0, pi]."""
        super().check(count)
        given = numbers_of(self.passive)
        if given is None or given.shape != (2,) or not ((given > 0.0) & (given <= math.pi)).all():
            wanted = "two angles in (0, pi] rad: rods' ends on the drives, on the platform"
            raise InvalidField(type(self).__name__, "passive", self.passive, wanted)


class PassiveJoint(NamedTuple):
    """A joint at an end of a rod.

    Attributes:
        axis: (3,) unit vector fixed in the part that holds the joint.
        rod: (3,) along the rod [m].
        length: |rod|.
        end: 0 at the drive, 1 at the platform.
        swivels: it turns freely about its axis and rests where the rod stands square to that; else it rests where the
            rod lies along the axis.
    """

    axis: ca.SX
    rod: ca.SX
    length: ca.SX
    end: int
    swivels: bool = True

    def room(self, limits: Pair) -> list[ca.SX]:
        """What is left to the limit [rad], each to be at least the margin; within 1e-13 of an axis 1e-13 less."""
        along = ca.dot(self.axis, self.rod) / self.length
        across = ca.sumsqr(ca.cross(self.axis, self.rod)) / self.length**2
        if self.swivels:
            lean = ca.atan2(along, ca.sqrt(across))
            return [limits[self.end] - lean, limits[self.end] + lean]
        return [limits[self.end] - ca.atan2(ca.sqrt(ca.fmax(across, _TIP)), along)]

    def within(self, limits: Pair, margin: ca.SX) -> list[ca.SX]:
        """At least 0 if and only if the room is at least the margin; without an arctangent.

        With a = limit - margin in [0, pi / 2] for a swivelling joint and [0, pi] for another, which keep their angle in
        these too: the sine of a lean is at most sin a, the cosine of a tilt at least cos a. For larger a, which hold
        trivially, both are stricter.
        """
        allowed, along = limits[self.end] - margin, ca.dot(self.axis, self.rod)
        if self.swivels:
            reach = ca.sin(allowed) * self.length
            return [reach - along, reach + along, allowed]
        return [along - ca.cos(allowed) * self.length, allowed]
