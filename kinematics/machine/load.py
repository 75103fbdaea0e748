"""What a machine is asked to carry, and how hard it is asked to accelerate it."""

from __future__ import annotations

from dataclasses import dataclass, fields

from kinematics.errors import InvalidField
from kinematics.machine.geometry_record import numbers_of


@dataclass(frozen=True)
class Load:
    """The load that `natural_frequency` and `strength` are for. A cycle states its own payloads.

    Attributes:
        payload: a mass at the tool point [kg].
        acceleration: of the tool point, in the worst direction [m/s^2].

    Raises:
        InvalidValue: it names the field.
    """

    payload: float = 1.0
    acceleration: float = 100.0

    def __post_init__(self) -> None:
        for f in fields(self):
            number = numbers_of(getattr(self, f.name))
            if number is None or number.ndim or not 0.0 <= number < float("inf"):
                raise InvalidField("Load", f.name, getattr(self, f.name), "a finite number >= 0")
            object.__setattr__(self, f.name, float(number))
