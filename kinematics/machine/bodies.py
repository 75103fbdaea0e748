"""The rigid-body model of a mechanism: particles, rotors and rods at points of its joints and pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import ClassVar, NamedTuple

import casadi as ca
import numpy as np

from kinematics.errors import InvalidField
from kinematics.machine.drive_train import DriveTrain
from kinematics.machine.geometry_record import frozen, numbers_of

UNIFORM = 2 / 3  # the `rod_middle` of a thin uniform rod: with 1/6 at each end, its mass, centre and inertia


@dataclass(frozen=True)
class InertiaRecord:
    """Base of every mechanism's `Inertia`: finite numbers >= 0, or tuples of as many numbers as the default has.

    A field whose default is None follows from the members: their sections, lengths and materials. A number that is
    given takes its place, as for a machine that was built and weighed.

    Attributes:
        rod_middle: share of each rod's mass at its middle; half of the rest is at each end. 0 splits the mass between
            the ends. `UNIFORM` is exactly a thin uniform rod. 1 - 4 I / (m l^2) is any other symmetric rod with
            inertia I about its middle. None takes a uniform tube with a joint at each end.
        drive_train: gear, motor and friction of the actuators.

    Raises:
        InvalidValue: it names the field.
    """

    dimensions: ClassVar[Mapping[str, str]] = {}  # as in a geometry, of fields that a file may give in mm
    _shapes: ClassVar[Mapping[str, tuple[int, ...]]] = {}  # of fields that are None by default and no single number
    rod_middle: float | None = field(default=None, kw_only=True)
    drive_train: DriveTrain = field(default=DriveTrain(), kw_only=True)

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            if f.name == "drive_train":
                if not isinstance(value, DriveTrain):
                    raise InvalidField(type(self).__name__, "drive_train", value, "a DriveTrain")
                continue
            follows = f.default is None
            if follows and value is None:
                continue
            shape = self._shapes.get(f.name, ()) if follows else np.shape(f.default)  # type: ignore[arg-type]
            array = numbers_of(value)
            if array is None or array.shape != shape or not np.isfinite(array).all() or np.any(array < 0.0):
                count = f"{shape[0]} numbers, " if shape else ""
                raise InvalidField(type(self).__name__, f.name, value, f"{count}finite and >= 0")
            object.__setattr__(self, f.name, frozen(array))
        if self.rod_middle is not None and self.rod_middle > 1.0:
            raise InvalidField(type(self).__name__, "rod_middle", self.rod_middle, "a number from 0 to 1")

    def check(self, count: int) -> None:
        """Check that every drive's data suits `count` actuators.

        Raises:
            InvalidValue: naming the field.
        """
        self.drive_train.check(count)


class Particle(NamedTuple):
    """A mass [kg] at a point (3,) [m] of a link."""

    link: str
    mass: float | ca.SX
    point: ca.SX


class Rotor(NamedTuple):
    """An inertia [kg m^2] and the angle [rad] it turns by, a linear function of joints and pose.

    A mass that only slides is one too: its mass [kg] and how far it has slid [m].

    Attributes:
        axis: (3,) the unit direction that it turns about; None if it slides, or if nobody knows it. The frame feels
            only rotors with a known axis.
        link: whose mass it is, beyond that link's particles; None of a drive.
    """

    inertia: float | ca.SX
    angle: ca.SX
    axis: ca.SX | None = None
    link: str | None = None


class Rod(NamedTuple):
    """A rod of constant length, or a pair that moves as one, between points (3,) of two links.

    Attributes:
        mass: [kg].
        middle: its share at the middle, as `InertiaRecord.rod_middle`.
    """

    mass: float | ca.SX
    middle: float | ca.SX
    links: tuple[str, str]
    start: ca.SX
    end: ca.SX

    @property
    def split(self) -> bool:
        """Whether all of its mass is at its ends."""
        return isinstance(self.middle, float) and self.middle == 0.0


@dataclass(frozen=True)
class Bodies:
    """A mechanism's masses."""

    particles: list[Particle] = field(default_factory=list)
    rotors: list[Rotor] = field(default_factory=list)
    rods: list[Rod] = field(default_factory=list)

    def all_particles(self) -> list[Particle]:
        """The particles, and each rod as two or three: its ends on its links, its middle on a link of its own."""
        result = list(self.particles)
        for k, rod in enumerate(self.rods):
            near, middle, far = self.rod_particles(k)
            result += [near._replace(link=rod.links[0]), far._replace(link=rod.links[1])]
            result += [] if rod.split else [middle]
        return result

    def rod_particles(self, k: int) -> list[Particle]:
        """Start, middle and end of a rod, as particles of the link `rod`, counted from 1."""
        rod, link = self.rods[k], f"rod {k + 1}"
        end = (1 - rod.middle) / 2
        points = (rod.start, (rod.start + rod.end) / 2, rod.end)
        shares = (end, rod.middle, end)
        return [Particle(link, share * rod.mass, point) for share, point in zip(shares, points, strict=True)]
