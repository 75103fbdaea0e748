"""Materials: what a body's section is made of."""

from __future__ import annotations

from dataclasses import dataclass, fields
from types import MappingProxyType

from kinematics.errors import InvalidField
from kinematics.machine.geometry_record import numbers_of


@dataclass(frozen=True)
class Material:
    """Of a bar or tube along its axis. SI units.

    Attributes:
        density: [kg/m^3].
        modulus: Young's modulus along the axis [Pa].
        shear_modulus: for torsion about the axis [Pa].
        strength: the largest stress that it bears for many cycles [Pa].

    Raises:
        InvalidValue: a value is no finite number > 0.
    """

    density: float
    modulus: float
    shear_modulus: float
    strength: float

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            number = numbers_of(value)
            if number is None or number.ndim or not 0.0 < number < float("inf"):
                raise InvalidField("Material", f.name, value, "a finite number > 0")
            object.__setattr__(self, f.name, float(number))


# Usual values, rounded. The strengths are those of many load cycles, not of one; a study may state its own.
MATERIALS = MappingProxyType(
    {
        "aluminium": Material(2700.0, 70e9, 26e9, 90e6),
        "steel": Material(7850.0, 210e9, 81e9, 250e6),
        "carbon tube": Material(1600.0, 120e9, 10e9, 400e6),
    }
)
