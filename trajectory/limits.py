"""What the drives and the tool may do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np

from kinematics import InvalidValue

PerJoint = float | tuple[float, ...]
Range = tuple[float, float]
_TOOL_FIELDS = ("tool_speed", "tool_acceleration")


@dataclass(frozen=True)
class Limits:
    """Limits, each but the position the same in both directions; None is no limit. A joint limit is one number (one
    range) or one a joint; where drives couple the joints, as the Peppermill's do, it holds at the actuators.

    Attributes:
        speed: of the joints [rad/s or m/s].
        acceleration: of the joints [rad/s^2 or m/s^2].
        torque: peak of the drives [N m or N].
        jerk: of the joints [rad/s^3 or m/s^3].
        tool_speed: of the tool point [m/s].
        tool_acceleration: of the tool point [m/s^2].
        position: lowest and highest of the joints [rad or m].
        stall_torque, no_load_speed: ends of the drives' speed-torque line, which a motion stays below:
            |tau| <= stall_torque (1 - |q'| / no_load_speed) [N m or N, rad/s or m/s]; both or neither.
        rms_torque: root mean square over each way from rest to rest, so over the whole cycle too [N m or N].

    Raises:
        InvalidValue: a limit that is not finite and positive, a range that does not rise, or half of a line.
    """

    speed: PerJoint
    acceleration: PerJoint | None = None
    torque: PerJoint | None = None
    jerk: PerJoint | None = None
    tool_speed: float | None = None
    tool_acceleration: float | None = None
    position: Range | tuple[Range, ...] | None = None
    stall_torque: PerJoint | None = None
    no_load_speed: PerJoint | None = None
    rms_torque: PerJoint | None = None

    def __post_init__(self) -> None:
        if self.position is not None:
            object.__setattr__(self, "position", _ranges(self.position))
        if (self.stall_torque is None) != (self.no_load_speed is None):
            lacking = "stall_torque" if self.stall_torque is None else "no_load_speed"
            raise InvalidValue(f"Limits {lacking}", None, "both ends of the speed-torque line, or neither")
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name == "position" or (value is None and field.name != "speed"):
                continue
            numbers = _numbers(value)
            if numbers is None or not numbers or not all(np.isfinite(v) and v > 0 for v in numbers):
                raise InvalidValue(f"Limits {field.name}", value, "finite and > 0")
            several = not isinstance(value, int | float)
            if several and field.name in _TOOL_FIELDS:
                raise InvalidValue(f"Limits {field.name}", value, "one number")
            object.__setattr__(self, field.name, numbers if several else numbers[0])

    def of_joints(self, name: str, count: int) -> np.ndarray | None:
        """(count,) a joint limit, None where there is none.

        Args:
            name: any field but those of the tool and the position.
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

    def ranges(self, count: int) -> tuple[np.ndarray, np.ndarray] | None:
        """(count,) lowest and (count,) highest positions, None where there is no limit; errors as `of_joints`."""
        if self.position is None:
            return None
        pairs = np.atleast_2d(np.array(self.position, dtype=float))
        if len(pairs) not in (1, count):
            raise InvalidValue("Limits position", self.position, f"one range or {count}, one a joint")
        low, high = np.broadcast_to(pairs, (count, 2)).T
        return low, high

    def as_dict(self) -> dict[str, object]:
        """The limits that are set; a list for one a joint."""
        return {k: _lists(v) for k, v in asdict(self).items() if v is not None}


def _lists(value: Any) -> Any:
    return [_lists(v) for v in value] if isinstance(value, tuple) else value


def _ranges(value: Any) -> Range | tuple[Range, ...]:
    """(low, high), or one such pair a joint.

    Raises:
        InvalidValue: anything else.
    """
    try:
        pairs = np.array(value, dtype=float)
        if pairs.ndim not in (1, 2) or pairs.shape[-1] != 2 or not pairs.size:
            raise ValueError
    except (ValueError, TypeError):
        raise InvalidValue("Limits position", value, "low < high, or one such pair a joint") from None
    if not (np.isfinite(pairs).all() and (pairs[..., 0] < pairs[..., 1]).all()):
        raise InvalidValue("Limits position", value, "finite, low < high")
    found: Any = tuple(tuple(row) for row in pairs.tolist()) if pairs.ndim == 2 else tuple(pairs.tolist())
    return found


def _numbers(value: object) -> tuple[float, ...] | None:
    """The values as floats; None where they are no numbers."""
    items: Sequence[object] = np.atleast_1d(np.asarray(value, dtype=object)).tolist()
    if any(isinstance(v, bool) or not isinstance(v, int | float | np.integer | np.floating) for v in items):
        return None
    return tuple(float(v) for v in items)  # type: ignore[arg-type]
