"""The drive train between motor and actuator: gear, motor inertia, friction, and how far the position may be off."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from kinematics.errors import InvalidField
from kinematics.machine.geometry_record import frozen, numbers_of

PerActuator = float | tuple[float, ...]
REST = 1e-9  # [rad/s or m/s], above what rounding leaves of a speed of 0


@dataclass(frozen=True)
class DriveTrain:
    """The drive train of each actuator: a number for all actuators, or one for each. SI units.

    Torques, speeds and limits are always those of the actuator, at the output of the gear. The motor turns `gear_ratio`
    times as fast, with the torque over `gear_ratio`. Friction is at the actuator too: coulomb sign(speed) + viscous
    speed. A drive at rest, slower than `REST`, has no Coulomb friction.

    Attributes:
        gear_ratio: motor [rad] per actuator [rad or m].
        motor_inertia: of each motor about its own axis; an actuator moves `gear_ratio`^2 times as much [kg m^2].
        coulomb: [N m] or [N].
        viscous: [N m s/rad] or [N s/m].
        stiffness: of gear and servo loop, at the actuator [N m/rad] or [N/m]; inf if they do not give way.
        encoder_resolution: one step of the encoder, at the actuator [rad or m]. The servo holds the position that the
            encoder tells to one step, so the motor may be off by so much to either side.
        backlash: how far the actuator moves freely while its motor stands, from one flank to the other [rad or m]. The
            encoder is the motor's and is set to the middle, so the actuator may be off by half of it to either side.

    Raises:
        InvalidValue: a value is infinite, NaN or negative, or a gear ratio or stiffness is 0.
    """

    gear_ratio: PerActuator = 1.0
    motor_inertia: PerActuator = 0.0
    coulomb: PerActuator = 0.0
    viscous: PerActuator = 0.0
    stiffness: PerActuator = float("inf")
    encoder_resolution: PerActuator = 0.0
    backlash: PerActuator = 0.0

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            numbers = numbers_of(value)
            above = f.name in ("gear_ratio", "stiffness")
            good = numbers is not None and numbers.ndim < 2 and np.all(numbers > 0.0 if above else numbers >= 0.0)
            if numbers is None or not good or not (f.name == "stiffness" or np.isfinite(numbers).all()):
                expected = "> 0, or inf" if f.name == "stiffness" else "finite and > 0" if above else "finite and >= 0"
                raise InvalidField("DriveTrain", f.name, value, expected)
            object.__setattr__(self, f.name, frozen(numbers))

    def check(self, count: int) -> None:
        """Check that every field suits `count` actuators.

        Raises:
            InvalidValue: naming the field.
        """
        for f in fields(self):
            self.of_actuators(f.name, count)

    def friction(self, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(..., m) actuator speeds [rad/s or m/s] -> Coulomb and viscous friction, (..., m) each [N m or N]."""
        coulomb, viscous = (self.of_actuators(name, speed.shape[-1]) for name in ("coulomb", "viscous"))
        return coulomb * np.sign(speed) * (np.abs(speed) > REST), viscous * speed

    def position_errors(self, count: int) -> np.ndarray:
        """(count,) how far each actuator may be off to either side [rad or m]: a step and half of the backlash."""
        return self.of_actuators("encoder_resolution", count) + self.of_actuators("backlash", count) / 2

    def of_actuators(self, name: str, count: int) -> np.ndarray:
        """(count,) one field.

        Raises:
            InvalidValue: it is given for another number of actuators.
        """
        value = getattr(self, name)
        if np.ndim(value) and np.shape(value) != (count,):
            raise InvalidField("DriveTrain", name, value, f"one number, or {count}: one for each actuator")
        return np.broadcast_to(np.asarray(value, dtype=float), (count,))


# Assumptions of this project, for mechanisms whose drives are not known; both are fine for a servo of today.
ROTARY = DriveTrain(encoder_resolution=1e-4)  # rad: 16 bits a turn of the actuator
LINEAR = DriveTrain(encoder_resolution=1e-6)  # m: a linear scale, or a screw of 10 mm a turn with 13 bits
