"""Caps of the tool point's speed and acceleration, for what it carries."""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics import Array, Mechanism
from trajectory.limits.model import (
    Along,
    Cap,
    Disc,
    InstantLimit,
    IntervalRows,
    LimitValues,
    OverIntervals,
    SlopesOverIntervals,
    SymbolicMotion,
    ToolField,
    Use,
    against,
)
from trajectory.motions import Motion
from trajectory.paths import places


class ToolSpeed(InstantLimit):
    """|v| <= cap."""

    name = "tool speed"
    fields = (ToolField("tool_speed", "The largest speed of the tool point.", "a speed > 0 (m/s)", "m/s"),)
    kind = Cap
    pace_power = 1
    not_for_moves = "a move keeps the joints' limits"

    def use(self, robot: Mechanism, motion: Motion, limits: LimitValues, slack: Motion) -> Use:
        """The speed itself."""
        return _of_tool(robot, motion.tool.velocity, slack.tool.velocity, limits.of_tool("tool_speed"))

    def constraint(self, along: Along, limits: LimitValues) -> Cap:
        """v = dp sqrt(x)."""
        with np.errstate(divide="ignore"):
            return Cap((np.linalg.norm(along.tool[0], axis=-1) / limits.set_of_tool("tool_speed")) ** -2.0)

    def highest_over_intervals(self, slopes: SlopesOverIntervals, limits: LimitValues) -> Array | None:
        """Where the tool moves, its speed is s'."""
        cap = limits.of_tool("tool_speed")
        return None if cap is None else np.where(slopes.moving, cap**2, np.inf)

    def symbolic(self, motion: SymbolicMotion, limits: LimitValues) -> ca.SX:
        """Its square over the cap's."""
        return ca.sumsqr(motion.tool_velocity) / limits.set_of_tool("tool_speed") ** 2


class ToolAcceleration(InstantLimit):
    """|a| <= cap."""

    name = "tool acceleration"
    fields = (
        ToolField(
            "tool_acceleration", "The largest acceleration of the tool point.", "an acceleration > 0 (m/s^2)", "m/s^2"
        ),
    )
    kind = Disc
    pace_power = 2
    not_for_moves = "a move keeps the joints' limits"

    def use(self, robot: Mechanism, motion: Motion, limits: LimitValues, slack: Motion) -> Use:
        """The acceleration itself."""
        return _of_tool(robot, motion.tool.acceleration, slack.tool.acceleration, limits.of_tool("tool_acceleration"))

    def constraint(self, along: Along, limits: LimitValues) -> Disc:
        """a = dp u + ddp x."""
        (first, second), cap = along.tool, limits.set_of_tool("tool_acceleration")
        return Disc(first / cap, second / cap)

    def rows_over_intervals(self, over: OverIntervals, limits: LimitValues) -> IntervalRows | None:
        """Over the cap."""
        cap = limits.of_tool("tool_acceleration")
        return None if cap is None else over.tool.over(cap)

    def symbolic(self, motion: SymbolicMotion, limits: LimitValues) -> ca.SX:
        """Its square over the cap's."""
        return ca.sumsqr(motion.tool_acceleration) / limits.set_of_tool("tool_acceleration") ** 2


def _of_tool(robot: Mechanism, values: Array, away: Array, cap: float | None) -> Use:
    """The size of a rate of the pose (..., n) at the tool point, (..., 1)."""
    point = places(robot.pose_names)
    size = sum(np.linalg.norm(np.atleast_1d(v)[..., :point], axis=-1) for v in (values, away))
    return against(np.asarray(size)[..., None], None if cap is None else np.array([cap]))


TOOL_SPEED, TOOL_ACCELERATION = ToolSpeed(), ToolAcceleration()
