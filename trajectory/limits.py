"""What the drives and the tool may do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields

import numpy as np

from kinematics import InvalidValue

PerJoint = float | tuple[float, ...]
_JOINT_FIELDS = ("speed", "acceleration", "torque", "jerk")


@dataclass(frozen=True)
class Limits:
    """Limits, each the same in both directions; None is no limit. A joint limit is one number or one a joint;
    where drives couple the joints, as the Peppermill's do, it holds at the actuators.

    Attributes:
        speed: of the joints [rad/s or m/s].
        acceleration: of the joints [rad/s^2 or m/s^2].
        torque: of the drives [N m or N].
        jerk: of the joints [rad/s^3 or m/s^3].
        tool_speed: of the tool point [m/s].
        tool_acceleration: of the tool point [m/s^2].

    Raises:
        InvalidValue: a limit that is not finite and positive.
    """

    speed: PerJoint
    acceleration: PerJoint | None = None
    torque: PerJoint | None = None
    jerk: PerJoint | None = None
    tool_speed: float | None = None
    tool_acceleration: float | None = None

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if value is None and field.name != "speed":
                continue
            numbers = _numbers(value)
            if numbers is None or not numbers or not all(np.isfinite(v) and v > 0 for v in numbers):
                raise InvalidValue(f"Limits {field.name}", value, "finite and > 0")
            several = not isinstance(value, int | float)
            if several and field.name not in _JOINT_FIELDS:
                raise InvalidValue(f"Limits {field.name}", value, "one number")
            object.__setattr__(self, field.name, numbers if several else numbers[0])

    def of_joints(self, name: str, count: int) -> np.ndarray | None:
        """(count,) a joint limit, None where there is none.

        Args:
            name: speed, acceleration, torque or jerk.
            count: number of joints of the robot.

        Raises:
            InvalidValue: the limit is given for another number of joints.
        """
        value = getattr(self, name)
        if value is None:
            return None
        if isinstance(value, tuple) and len(value) != count:
            raise InvalidValue(f"Limits {name}", value, f"one number or {count}, one a joint")
        return np.broadcast_to(np.asarray(value, dtype=float), (count,)).copy()

    def as_dict(self) -> dict[str, object]:
        """The limits that are set; a list for one a joint."""
        return {k: list(v) if isinstance(v, tuple) else v for k, v in asdict(self).items() if v is not None}


def _numbers(value: object) -> tuple[float, ...] | None:
    """The values as floats; None where they are no numbers."""
    items: Sequence[object] = np.atleast_1d(np.asarray(value, dtype=object)).tolist()
    if any(isinstance(v, bool) or not isinstance(v, int | float | np.integer | np.floating) for v in items):
        return None
    return tuple(float(v) for v in items)  # type: ignore[arg-type]
