"""Where the search for a jerk-limited law starts, and where its knots stand."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Mechanism
from trajectory.limits import Limits
from trajectory.motion import PoseMotion, motion_of, pose_motion
from trajectory.path import Array, Path
from trajectory.timing import PathMotion, TimeLaw
from trajectory.usage import uses

_WHERE_EXCEEDED = 0.1  # share of the knots; more of them leave too few for the switches elsewhere
_POWERS = {"joint speed": 1.0, "tool speed": 1.0, "joint jerk": 3.0}  # of the speed; about 2 for the others


class Start(NamedTuple):
    """A motion along the path at its stations: the knots, and the middle of each interval's time.

    Attributes:
        times, position, speed, acceleration: (2 n + 1,) [s, m, m/s, m/s^2].
    """

    times: Array
    position: Array
    speed: Array
    acceleration: Array

    @property
    def intervals(self) -> int:
        """n."""
        return self.times.size // 2

    @property
    def jerk(self) -> tuple[Array, Array]:
        """(n,) where each interval starts, and where it ends: of the parabola through its three accelerations."""
        first, middle, last = self.acceleration[:-1:2], self.acceleration[1::2], self.acceleration[2::2]
        step = np.diff(self.times[::2])
        return (4 * middle - 3 * first - last) / step, (first - 4 * middle + 3 * last) / step


def polynomial_start(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int) -> Start:
    """The quintic from rest to rest with zero s'' at both ends, about as fast as its stations keep their limits."""
    u = np.linspace(0.0, 1.0, 2 * intervals + 1)
    along = PathMotion(
        path.length * u**3 * (10 - 15 * u + 6 * u**2),
        path.length * 30 * u**2 * (1 - u) ** 2,
        path.length * 60 * u * (1 - u) * (1 - 2 * u),
        path.length * 60 * (1 - 6 * u + 6 * u**2),
        path.length * 360 * (2 * u - 1),
    )
    tool = pose_motion(path, along)
    time = 1.0
    for _ in range(2):  # the weight makes the torque's power inexact: once more, from about the right duration
        slower = tool._replace(
            velocity=tool.velocity / time, acceleration=tool.acceleration / time**2, jerk=tool.jerk / time**3
        )
        time *= _stretch(robot, slower, limits, payload)
    return Start(u * time, along.position, along.speed / time, along.acceleration / time**2)


def _stretch(robot: Mechanism, tool: PoseMotion, limits: Limits, payload: float) -> float:
    motion = motion_of(robot, tool, payload)
    factors = [
        use.ratio.max() ** (1 / _POWERS.get(name, 2.0))
        for name, use in uses(robot, motion, limits).items()
        if use.ratio is not None and name != "joint position"
    ]
    rms = limits.of_joints("rms_torque", motion.torque.shape[-1])
    if rms is not None:
        factors.append((np.sqrt((motion.torque**2).mean(axis=0)) / rms).max() ** 0.5)
    return float(max(factors))


def denser_start(law: TimeLaw, over: Array, intervals: int) -> Start:
    """A law's own motion at new knots: most at equal times, the others where limits were exceeded between stations.

    What an interval h exceeds grows with h^2: knots in proportion to its root make it even.

    Args:
        law: of n intervals.
        over: (n,) peak over limit less 1 of each.
        intervals: wanted.
    """
    share = np.diff(law.times) / law.duration
    root = np.sqrt(over)
    if root.any():
        share = (1.0 - _WHERE_EXCEEDED) * share + _WHERE_EXCEEDED * root / root.sum()
    filled = np.concatenate([[0.0], np.cumsum(share)])
    return start_of(law, np.interp(np.linspace(0.0, filled[-1], intervals + 1), filled, law.times))


def start_of(law: TimeLaw, knots: Array) -> Start:
    """A law's own motion at knots (n + 1,) of time, from the first to the last of its own [s]."""
    times = np.empty(2 * knots.size - 1)
    times[::2], times[1::2] = knots, (knots[1:] + knots[:-1]) / 2
    along = law.at(times)
    position = along.position.copy()
    position[[0, -1]] = law.position[[0, -1]]
    return Start(times, position, along.speed, along.acceleration)
