"""The working mode: the branch of the inverse model of each limb, and where each joint angle jumps by a turn (its cut).

Both are data of the robot. They follow from its home, the pose that it works around, and do not change: to reach
another branch a limb would have to pass a singularity.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.model.symbolic_model import model_of

if TYPE_CHECKING:
    from kinematics.model.mechanism import Mechanism

_QUARTER = math.pi / 2


class Mode(NamedTuple):
    """A working mode of m limbs.

    Attributes:
        branches: (m,) +1 for the usual branch in the mechanism's documentation, else -1.
        quarters: (m,) the quarter turn in the middle of each angle's turn; its cut is opposite. 0 for a length.
    """

    branches: tuple[int, ...]
    quarters: tuple[int, ...]

    @classmethod
    def usual(cls, count: int) -> Mode:
        """The usual branches, angles around 0."""
        return cls((1,) * count, (0,) * count)

    def angles(self, cosines: ca.SX, sines: ca.SX, first: int = 0) -> ca.SX:
        """(k,) angles of these joints, counted on from joint `first`, each within half a turn of its quarter turn.

        Args:
            cosines, sines: (k,) both times any positive number.
        """
        rows = []
        for i in range(cosines.shape[0]):
            quarter = self.quarters[first + i]
            c, s = cosines[i], sines[i]
            ahead, aside = ((c, s), (s, -c), (-c, -s), (-s, c))[quarter % 4]
            rows.append(quarter * _QUARTER + ca.atan2(aside, ahead))
        return ca.vertcat(*rows)


def mode_at(robot: Mechanism, joints: Array | None) -> Mode:
    """The mode of a robot at its home.

    Args:
        joints: (m,) at home, which choose each limb's branch by being nearer to it; None takes the usual branches.
    """
    count = len(robot.joint_names)
    usual = robot.usual_branches(robot.home, robot.geometry)
    if joints is not None:
        both = [_joints(robot, Mode(tuple(side * b for b in usual), (0,) * count)) for side in (1, -1)]
        away = np.array([_apart(robot, found, joints) for found in both])
        nearer = away[1] < away[0]  # False where a limb cannot reach home
        usual = tuple(-b if other else b for b, other in zip(usual, nearer.tolist(), strict=True))
    at_home = _joints(robot, Mode(usual, (0,) * count))
    limits = robot.ranges.limits(count)
    quarters = [
        _quarter(float(angle), low, high) if unit == "rad" else 0
        for angle, (low, high), unit in zip(at_home, limits.tolist(), robot.joint_units, strict=True)
    ]
    return Mode(usual, tuple(quarters))


def _joints(robot: Mechanism, mode: Mode) -> Array:
    """(m,) at home; NaN of a limb that cannot reach it."""
    function = model_of(type(robot), mode).inverse_function
    return np.array(function(robot.home, robot.geometry.vector()))[:, 0]


def _apart(robot: Mechanism, found: Array, wanted: Array) -> Array:
    """(m,) how far joints are apart, angles as if a turn were nothing."""
    turns = np.array([unit == "rad" for unit in robot.joint_units])
    gap = found - wanted
    result: Array = np.where(turns, 2 * np.abs(np.sin(gap / 2)), np.abs(gap))
    return result


def _quarter(angle: float, low: float, high: float) -> int:
    """The quarter turn nearest to the angle, counted in the turn around the middle of its range (or a quarter turn).

    Where the angle is within its range, so that the range is in use: the nearest whose cut lies outside the range.
    """
    bounded = math.isfinite(low) and math.isfinite(high)
    middle = (low + high) / 2 if bounded else _QUARTER
    if math.isnan(angle):
        angle = middle
    angle -= 2 * math.pi * round((angle - middle) / (2 * math.pi))
    nearest = math.floor(angle / _QUARTER + 0.5)
    if bounded and low <= angle <= high:
        first, last = math.floor((high - math.pi) / _QUARTER) + 1, math.ceil((low + math.pi) / _QUARTER) - 1
        if first <= last:
            return min(max(nearest, first), last)
    return nearest
