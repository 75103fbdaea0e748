"""The only importer of ruckig: jerk-limited motion of independent axes from state to state.

Berscheid and Kroeger, "Jerk-limited real-time trajectory generation with arbitrary target states", RSS 2021. One motion
from state to state: intermediate waypoints are never used, since this edition of ruckig sends them to a cloud.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from ruckig import (
    ControlInterface,
    DurationDiscretization,
    InputParameter,
    Result,
    Ruckig,
    RuckigError,
    Synchronization,
    Trajectory,
)

from kinematics import Array
from trajectory.errors import TimingFailed

_ROUNDING = 1e-9  # of a period
_MOST_SAMPLES = 4_000_000


class AxisLimits(NamedTuple):
    """Speed, acceleration and jerk of each axis, (m,) [rad or m, and seconds]."""

    speed: Sequence[float]
    acceleration: Sequence[float]
    jerk: Sequence[float]


class Profile(NamedTuple):
    """A motion at equal steps of time.

    Attributes:
        times: (k,) [s].
        position, speed, acceleration: (k, m).
        periods: how many whole periods of the bus it takes.
    """

    times: Array
    position: Array
    speed: Array
    acceleration: Array
    periods: int


def fastest_move(
    start: Array, target: Array, limits: AxisLimits, period: float, parts: int, asked: Mapping[str, object]
) -> Profile:
    """From rest to rest, all axes on one straight line.

    Args:
        start, target: (m,) positions.
        limits: of each axis.
        period: of the bus; the duration is a whole number of periods [s].
        parts: samples of each period.
        asked: what an error says was asked for.

    Raises:
        TimingFailed: it would take too long, or ruckig reports anything but success.
    """
    given = _input(limits)
    given.current_position, given.target_position = start.tolist(), target.tolist()
    return _profile(given, period, parts, asked)


def fastest_stop(
    state: tuple[Array, Array, Array], limits: AxisLimits, period: float, parts: int, asked: Mapping[str, object]
) -> Profile:
    """From positions, speeds and accelerations (m,) to rest, wherever that is; else as `fastest_move`."""
    given = _input(limits)
    given.control_interface = ControlInterface.Velocity
    given.current_position, given.current_velocity, given.current_acceleration = (v.tolist() for v in state)
    return _profile(given, period, parts, asked)


def _input(limits: AxisLimits) -> InputParameter:
    """At rest, within the limits; where from and where to is left to fill in."""
    given = InputParameter(len(limits.speed))
    given.max_velocity, given.max_acceleration, given.max_jerk = (list(map(float, limit)) for limit in limits)
    given.duration_discretization = DurationDiscretization.Discrete
    given.synchronization = Synchronization.Phase  # a straight line of the axes
    return given


def _profile(given: InputParameter, period: float, parts: int, asked: Mapping[str, object]) -> Profile:
    plan = Trajectory(given.degrees_of_freedom)
    try:
        result = Ruckig(given.degrees_of_freedom, period).calculate(given, plan)
    except RuckigError as error:
        raise TimingFailed("ruckig", asked, str(error)) from error
    except ValueError as error:  # a code without a name: its longest duration, in this edition
        raise TimingFailed("ruckig", asked, "no solution: it would take longer than ruckig can plan") from error
    if result not in (Result.Working, Result.Finished):
        raise TimingFailed("ruckig", asked, f"no solution ({Result(result).name})")
    if plan.duration * parts > (most := _MOST_SAMPLES * period):
        raise TimingFailed("ruckig", asked, f"the move takes {plan.duration:.4g} s, more than {most / parts:g} s")
    count = max(1, round(plan.duration / period))  # a period at rest where the target is the start
    if plan.duration > 0.0 and abs(count * period - plan.duration) > _ROUNDING * period:
        raise TimingFailed("ruckig", asked, f"{plan.duration} s is no whole number of periods")
    times = np.arange(count * parts + 1) * (period / parts)
    times[-1] = count * period
    rows = np.empty((times.size, 3, given.degrees_of_freedom))
    for row, t in zip(rows, times.tolist(), strict=True):  # ruckig takes one time at a time
        row[:] = plan.at_time(min(t, plan.duration))
    return Profile(times, rows[:, 0], rows[:, 1], rows[:, 2], count)
