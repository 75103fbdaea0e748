"""Access to the values of the fields of `Limits`."""

from __future__ import annotations

import numpy as np

from kinematics import Array, InvalidField


class LimitValues:
    """The part of `Limits` that a limit uses: values by the names of fields."""

    def of_joints(self, name: str, count: int) -> Array | None:
        """(count,) a joint limit; None if it is not set.

        Args:
            name: any field except those of the tool and the position.
            count: number of joints of the robot.

        Raises:
            InvalidValue: the limit is given for another number of joints.
        """
        value = getattr(self, name)
        if value is None:
            return None
        if isinstance(value, tuple) and len(value) != count:
            raise InvalidField("Limits", name, value, f"one number, or {count}: one for each joint")
        return np.broadcast_to(np.asarray(value, dtype=float), (count,)).copy()

    def set_of_joints(self, name: str, count: int) -> Array:
        """(count,) as `of_joints`, of a limit that is set."""
        limit = self.of_joints(name, count)
        assert limit is not None, name
        return limit

    def ranges(self, count: int, name: str = "position") -> tuple[Array, Array] | None:
        """(count,) lowest and (count,) highest positions, None where there is no limit; errors as `of_joints`."""
        value = getattr(self, name)
        if value is None:
            return None
        pairs = np.atleast_2d(np.array(value, dtype=float))
        if len(pairs) not in (1, count):
            raise InvalidField("Limits", name, value, f"one range, or {count}: one for each joint")
        low, high = np.broadcast_to(pairs, (count, 2)).T
        return low, high

    def of_tool(self, name: str) -> float | None:
        """A limit of the tool, None where there is none."""
        found: float | None = getattr(self, name)
        return found

    def set_of_tool(self, name: str) -> float:
        """As `of_tool`, of a limit that is set."""
        limit = self.of_tool(name)
        assert limit is not None, name
        return limit
