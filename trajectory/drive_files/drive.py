"""The data of the drives that a drive file needs besides the set-points: data of the machine, not of the motion."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

from kinematics import Array, InvalidField

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_ ./-]*")


@dataclass(frozen=True)
class Drive:
    """Names and encoders of the axes, in the order of the set-points' actuators.

    Attributes:
        axes: (m,) names; None takes the names of each format.
        increments: increments of the encoder, for one turn of it (actuators in rad) or one metre (actuators in m); one
            number, or one for each axis. None if no format needs it.
        encoder_gear: turns of the encoder for one turn of the actuator (metres for one metre), negative if the encoder
            counts the other way; one number, or one for each axis. It is 1 if the encoder is on the output of the gear.

    Raises:
        InvalidValue: a value is impossible for a drive; the message names the field.
    """

    axes: tuple[str, ...] | None = None
    increments: int | tuple[int, ...] | None = None
    encoder_gear: float | tuple[float, ...] = 1.0

    def __post_init__(self) -> None:
        if self.axes is not None:
            object.__setattr__(self, "axes", tuple(self.axes))
            if len(set(self.axes)) != len(self.axes) or not all(_NAME.fullmatch(name) for name in self.axes):
                raise InvalidField("Drive", "axes", self.axes, "different names of letters, digits and _ ./-")
        increments = () if self.increments is None else _several(self.increments)
        if not all(isinstance(n, int) and n > 0 for n in increments):
            raise InvalidField("Drive", "increments", self.increments, "whole numbers > 0")
        if not all(math.isfinite(ratio) and ratio != 0 for ratio in _several(self.encoder_gear)):
            raise InvalidField("Drive", "encoder_gear", self.encoder_gear, "finite numbers other than 0")

    def names(self, own: tuple[str, ...]) -> tuple[str, ...]:
        """(m,) the axes' names; `own` are the format's names.

        Raises:
            InvalidValue: there are not as many names as axes.
        """
        if self.axes is None:
            return own
        if len(self.axes) != len(own):
            raise InvalidField("Drive", "axes", self.axes, f"{len(own)} names, one for each actuator")
        return self.axes

    def increments_per_unit(self, joint_units: tuple[str, ...]) -> Array:
        """(m,) encoder increments for a radian or a metre of each actuator; negative where it turns the other way.

        Raises:
            InvalidValue: increments are not given, or their number is not that of the axes.
        """
        if self.increments is None:
            raise InvalidField(
                "Drive", "increments", None, "the increments of the encoder in one turn (in one metre on a rail)"
            )
        count = len(joint_units)
        for name, value in (("increments", self.increments), ("encoder_gear", self.encoder_gear)):
            if len(_several(value)) not in (1, count):
                raise InvalidField("Drive", name, value, f"one number, or {count}: one for each actuator")
        turns = np.array([2 * math.pi if unit == "rad" else 1.0 for unit in joint_units])
        result: Array = np.asarray(self.increments) * np.asarray(self.encoder_gear) / turns
        return result


def _several(value: float | tuple[float, ...]) -> tuple[float, ...]:
    return tuple(value) if isinstance(value, tuple) else (value,)
