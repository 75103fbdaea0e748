"""The rigid-body model of a mechanism: which masses the joints move, and which the pose."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TypeVar

import casadi as ca
import numpy as np

from kinematics.errors import InvalidValue

Record = TypeVar("Record")


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


def require_masses(inertia: Record) -> Record:
    """The record itself, whose every number must be finite and not negative.

    Raises:
        InvalidValue: naming the field.
    """
    for f in fields(inertia):  # type: ignore[arg-type]
        value = getattr(inertia, f.name)
        if not np.all(np.isfinite(value)) or np.any(np.asarray(value) < 0.0):
            raise InvalidValue(f"{type(inertia).__name__} {f.name}", value, "finite and >= 0")
    return inertia
