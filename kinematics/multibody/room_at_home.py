"""Whether a robot fits into its surroundings at home."""

from __future__ import annotations

from kinematics.errors import InvalidField
from kinematics.margins import lowest_of_base, payload_inside
from kinematics.model import Mechanism


def require_room(robot: Mechanism) -> None:
    """Check that the base is above the floor, and that the payload is inside no member.

    Raises:
        InvalidValue: its record is "Surroundings" with the field `floor`, or "PayloadHull" with the field `high`.
    """
    floor = robot.surroundings.floor
    base = None if floor is None else lowest_of_base(robot)
    if floor is not None and base is not None and base.height < floor:
        expected = f"a height below the base: {base.member} reaches down to {base.height:.6g} m"
        raise InvalidField("Surroundings", "floor", floor, expected)
    hull, found = robot.surroundings.payload_hull, payload_inside(robot)
    if hull is not None and found is not None:
        expected = f"a hull outside all members; at home it is {found.depth:.6g} m inside the {found.member}"
        raise InvalidField("PayloadHull", "high", hull.high, expected)
