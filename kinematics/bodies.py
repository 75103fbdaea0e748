"""The rigid-body model of a mechanism: which masses the joints move, and which the pose."""

from __future__ import annotations

from dataclasses import dataclass, field

import casadi as ca


@dataclass(frozen=True)
class BodySet:
    """Particles at points (3,) [kg, m] and rotors about fixed axes with their angles [kg m^2, rad]."""

    particles: list[tuple[float, ca.SX]] = field(default_factory=list)
    rotors: list[tuple[float, ca.SX]] = field(default_factory=list)


@dataclass(frozen=True)
class Bodies:
    """A mechanism's masses, each moved either by the joints or by the pose."""

    of_joints: BodySet = field(default_factory=BodySet)
    of_pose: BodySet = field(default_factory=BodySet)
