"""The fastest law on a fixed path that keeps all limits, jerk among them: s''' piecewise constant, s'' continuous.

The problem of `jerk_problem` is solved on few knots first, then on all, which stand where the first answer needs them.
It keeps every limit at the knots, on both sides. In between, what the last answer exceeds, sampled densely, tightens
the limits at the knots around it, and the problem is solved again; the little that is left is for `repair`.
"""

from __future__ import annotations

import numpy as np

from kinematics import InvalidValue, Mechanism
from trajectory.errors import TimingFailed
from trajectory.jerk_numbers import Numbers, Scale, numbers_of
from trajectory.jerk_problem import Row, Shape, Variables, solver_of
from trajectory.jerk_start import Start, denser_start, polynomial_start
from trajectory.limits import Limits
from trajectory.motion import motion_of
from trajectory.path import Array, Path, require_poses_of, require_smooth
from trajectory.timed import TimedPath
from trajectory.timing import TimeLaw
from trajectory.usage import uses
from trajectory.verification import integrals

INTERVALS = 160
LEAST_INTERVALS = 20
ROUNDS = 4  # of solving and tightening
_CLOSE = 1.0005  # peak over limit that is left to the repair
_SAMPLES = np.linspace(0.0, 1.0, 17)  # of each interval, where limits are looked at between the knots
_SHORTEST = 1e-3  # interval, of the mean one
_RMS = "rms torque"
_CHECKED = 2000  # intervals of arc length on which the path must be smooth and within reach
_ONE_SIDED = ("tool acceleration", "torque at speed", _RMS)

Excess = dict[str, Array]  # by quantity: peak over limit of each interval (n,), at least 1; (m,) for the RMS torque


def jerk_limited(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int = INTERVALS) -> TimedPath:
    """The fastest law from rest to rest, with zero s'' at both ends.

    Args:
        robot: any mechanism with the path's kind of pose.
        path: smooth to its third derivative, without a cusp.
        limits: of joints and tool; all are kept but the position, which the path alone decides.
        payload: mass at the tool [kg].
        intervals: of constant s''', at least 20.

    Raises:
        InvalidValue: too few intervals, no jerk limit, an impossible payload, or another kind of pose.
        RoughPath, UnreachablePose: as `time_optimal`.
        TimingFailed: the solver did not converge.
    """
    if intervals < LEAST_INTERVALS:
        raise InvalidValue("intervals of the jerk law", intervals, f"at least {LEAST_INTERVALS}")
    if limits.jerk is None:
        raise InvalidValue("Limits jerk for the jerk law", None, "a limit; without one the toppra law is the fastest")
    grid = np.linspace(0.0, path.length, _CHECKED + 1)
    require_poses_of(robot, path)
    require_smooth(path, grid)
    robot.require_reachable(path.evaluate(grid, 0)[0])
    start = polynomial_start(robot, path, limits, payload, intervals // 2)
    asked = {**limits.as_dict(), "payload": payload, "intervals": intervals, "path": path.as_dict()}
    coarse = _Knots(robot, path, limits, payload, start, asked)
    timed = coarse.solved({})
    over = np.max([r - 1.0 for name, r in coarse.excess(timed).items() if name != _RMS], axis=0)
    knots = _Knots(robot, path, limits, payload, denser_start(timed.law, over, intervals), asked)
    tight: Excess = {}
    for _ in range(ROUNDS):
        timed = knots.solved(tight)
        found = knots.excess(timed)
        if max(ratio.max() for ratio in found.values()) <= _CLOSE:
            break
        tight = {name: ratio * tight.get(name, 1.0) for name, ratio in found.items()}
    return timed


class _Knots:
    """The problem on given knots."""

    def __init__(
        self, robot: Mechanism, path: Path, limits: Limits, payload: float, start: Start, asked: dict[str, object]
    ) -> None:
        self.robot, self.path, self.limits, self.payload = robot, path, limits, payload
        self.start, self.asked = start, asked
        self.scale = Scale.of(path.length, float(start.times[-1]))
        self.numbers = numbers_of(robot, path, limits, payload, start.position, self.scale)
        self.solver = solver_of(Shape(start.intervals, len(robot.actuator_names), frozenset(self.numbers.bounds)))

    def solved(self, tight: Excess) -> TimedPath:
        """The law with each limit tightened by so much.

        Raises:
            TimingFailed: the solver did not converge.
        """
        start, scale, numbers = self.start, self.scale, self.numbers.parameters
        if "rms" in numbers:
            numbers = numbers | {"rms": numbers["rms"] * tight.get(_RMS, 1.0) ** 2}
        low, high = _variable_bounds(self.numbers, tight)
        row_low, row_high = _row_bounds(self.solver.rows, self.numbers, tight)
        step, acceleration = np.diff(start.times) / scale.time, start.acceleration / scale.acceleration
        first = Variables(start.speed / scale.speed, acceleration, np.diff(acceleration) / step, step)
        found = self.solver.function(
            x0=np.concatenate(first), p=self.solver.parameter(numbers), lbx=low, ubx=high, lbg=row_low, ubg=row_high
        )
        status = self.solver.function.stats()["return_status"]
        if status != "Solve_Succeeded":
            raise TimingFailed("jerk", self.asked, f"no solution ({status})")
        x = Variables.split(np.array(found["x"]).ravel())
        times = np.concatenate([[0.0], np.cumsum(x.step)]) * scale.time
        acceleration = x.acceleration[:-1] * scale.acceleration
        law = TimeLaw("jerk", times, start.position, x.speed * scale.speed, acceleration, x.jerk * scale.jerk)
        return TimedPath(self.path, law)

    def excess(self, timed: TimedPath) -> Excess:
        """What a law uses beyond its limits, between the knots too."""
        times, tool = timed.within(_SAMPLES)
        motion = motion_of(self.robot, tool, self.payload)
        found = {
            name: np.maximum(use.ratio.max(axis=(1, 2)), 1.0)
            for name, use in uses(self.robot, motion, self.limits).items()
            if use.ratio is not None and name != "joint position"
        }
        limit = self.limits.of_joints("rms_torque", motion.torque.shape[-1])
        if limit is not None:
            mean_square = integrals(times, motion.torque**2).sum(axis=0) / timed.duration
            found[_RMS] = np.maximum(np.sqrt(mean_square) / limit, 1.0)
        return found


def _variable_bounds(numbers: Numbers, tight: Excess) -> tuple[Array, Array]:
    """Of all variables; at rest, with zero s'', at both ends."""
    n = numbers.parameters["ds"].size
    top = np.min([speed / _at_knots(tight, name, n) for name, speed in numbers.top_speeds.items()], axis=0)
    low = Variables(np.zeros(n + 1), np.full(n + 1, -np.inf), np.full(n, -np.inf), np.full(n, _SHORTEST / n))
    high = Variables(top, np.full(n + 1, np.inf), np.full(n, np.inf), np.full(n, np.inf))
    for bound in (low, high):
        bound.speed[[0, -1]] = bound.acceleration[[0, -1]] = 0.0
    return np.concatenate(low), np.concatenate(high)


def _row_bounds(rows: tuple[Row, ...], numbers: Numbers, tight: Excess) -> tuple[Array, Array]:
    """Of the 3 n equations and the rows."""
    n = numbers.parameters["ds"].size
    low, high = [np.zeros(3 * n)], [np.zeros(3 * n)]
    for row in rows:
        bound = numbers.bounds[row.quantity][row.joint]
        if row.place == "whole":
            most = np.array([bound])
        else:
            inside = tight.get(row.quantity, np.ones(n))
            there = _at_knots(tight, row.quantity, n) if row.place == "knots" else inside
            most = bound / there ** (2 if row.quantity == "tool acceleration" else 1)
        high.append(most)
        low.append(np.full(most.size, -np.inf) if row.quantity in _ONE_SIDED else -most)
    return np.concatenate(low), np.concatenate(high)


def _at_knots(tight: Excess, quantity: str, intervals: int) -> Array:
    """(n + 1,) the larger number of a knot's two intervals."""
    if quantity not in tight:
        return np.ones(intervals + 1)
    own = tight[quantity]
    return np.maximum(np.append(own, 1.0), np.append(1.0, own))
