"""Whether a robot fits into its surroundings at home."""

from __future__ import annotations

from kinematics.errors import InvalidField
from kinematics.margins import hull_depth, lowest_of_base
from kinematics.model import Mechanism


def require_room(robot: Mechanism) -> None:
    """Check that the base is above the floor, and that the payload is not inside what carries it.

    Raises:
        InvalidValue: its record is "Surroundings" with the field `floor`, or "PayloadHull" with the field `high`.
    """
    floor = robot.surroundings.floor
    base = None if floor is None else lowest_of_base(robot)
    if floor is not None and base is not None and base.height < floor:
        expected = f"a height below the base: {base.member} reaches down to {base.height:.6g} m"
        raise InvalidField("Surroundings", "floor", floor, expected)
    hull, depth = robot.surroundings.payload_hull, hull_depth(robot)
    if hull is not None and depth > 0.0:
        expected = f"a hull beside the {robot.tool_member}, which carries it; at home it is {depth:.6g} m inside"
        raise InvalidField("PayloadHull", "high", hull.high, expected)
