"""The fastest law on a fixed path that keeps all limits, jerk among them: s''' piecewise linear, s'' continuous.

The problem of `jerk_problem` is solved on few knots first, then on all, which stand where the first answer needs them.
It keeps every limit at the knots and midway between. What the last answer exceeds in between, sampled densely, tightens
the limits around it, and the problem is solved again from that answer; the little that is left is for `repair`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from kinematics import InvalidValue, Mechanism
from trajectory.at_rest import require_possible
from trajectory.errors import TimingFailed
from trajectory.jerk_numbers import Numbers, Scale, numbers_of
from trajectory.jerk_problem import Row, Shape, Variables, solver_of
from trajectory.jerk_start import Start, denser_start, polynomial_start, start_of
from trajectory.limits import Limits
from trajectory.motion import motion_of, pose_motion
from trajectory.path import Array, Path, require_poses_of
from trajectory.sampling import integrals
from trajectory.smoothness import require_smooth
from trajectory.timed import TimedPath
from trajectory.timing import TimeLaw
from trajectory.usage import uses

INTERVALS = 200
LEAST_INTERVALS = 20
_FEWER = 4  # times, on the first knots
ROUNDS = 6  # of solving and tightening
_CLOSE = 1.00005  # peak over limit that is left to the repair
_SAMPLES = np.linspace(0.0, 1.0, 65)  # of each interval, where limits are looked at between the knots
_SLOWEST = 0.75  # share of what is exceeded that a round leaves, to be believed
_SHORTEST = 1e-3  # interval, of the mean one
_RMS = "rms torque"
_CHECKED = 2000  # intervals of arc length on which the path must be smooth and within reach
_ONE_SIDED = ("speed", "tool acceleration", "torque at speed", _RMS)

Excess = dict[str, Array]  # by quantity: peak over limit of each interval (n,), at least 1; (m,) for the RMS torque


def jerk_limited(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int = INTERVALS) -> TimedPath:
    """The fastest law from rest to rest, with zero s'' at both ends.

    Args:
        robot: any mechanism with the path's kind of pose.
        path: smooth to its third derivative, without a cusp.
        limits: of joints and tool; all are kept but the position, which the path alone decides.
        payload: mass at the tool [kg].
        intervals: of linear s''', at least 20; the law has fewer where the solver finds no answer on so many.

    Raises:
        InvalidValue: too few intervals, no jerk limit, an impossible payload, or another kind of pose.
        RoughPath, UnreachablePose: as `time_optimal`.
        PathBeyondLimit: a position beyond its range, or a weight beyond the torque at an end.
        TimingFailed: the solver did not converge on the first, few knots.
    """
    if intervals < LEAST_INTERVALS:
        raise InvalidValue("intervals of the jerk law", intervals, f"at least {LEAST_INTERVALS}")
    if limits.jerk is None:
        raise InvalidValue("Limits jerk for the jerk law", None, "a limit; without one the toppra law is the fastest")
    grid = np.linspace(0.0, path.length, _CHECKED + 1)
    require_poses_of(robot, path)
    require_smooth(path)
    robot.require_reachable(path.evaluate(grid, 0)[0])
    require_possible(robot, path, limits, payload, grid)
    asked = {**limits.as_dict(), "payload": payload, "intervals": intervals, "path": path.as_dict()}
    problem = _Problem(robot, path, limits, payload, asked)
    coarse = problem.solved(polynomial_start(robot, path, limits, payload, max(intervals // _FEWER, LEAST_INTERVALS)))
    over = np.max([r - 1.0 for name, r in problem.excess(coarse.timed).items() if name != _RMS], axis=0)
    return _tightened(problem, _refined(problem, coarse, over, intervals)).timed


def _refined(problem: _Problem, coarse: _Answer, over: Array, intervals: int) -> _Answer:
    """On so many knots or, where the solver finds no answer on them, on half of them, down to the first ones."""
    while intervals > over.size:
        try:
            return problem.solved(denser_start(coarse.timed.law, over, intervals))
        except TimingFailed:
            intervals //= 2
    return coarse


def _tightened(problem: _Problem, answer: _Answer) -> _Answer:
    """Solved again and again, on the same knots, until the limits are kept between the stations too, or nearly."""
    found = problem.excess(answer.timed)
    tight, last = {name: np.ones_like(ratio) for name, ratio in found.items()}, found
    best, least = answer, _worst(found)
    for _ in range(ROUNDS):
        if least <= _CLOSE:
            break
        tight = {name: tight[name] * _power(ratio, last[name]) for name, ratio in found.items()}
        try:
            answer, last = problem.solved_again(answer, tight), found
        except TimingFailed:
            break  # the best one so far is for the repair
        found = problem.excess(answer.timed)
        if _worst(found) < least:
            best, least = answer, _worst(found)
    return best


def _worst(excess: Excess) -> float:
    return max(float(ratio.max()) for ratio in excess.values())


def _power(ratio: Array, last: Array) -> Array:
    """How much more to tighten: as if what is exceeded went on to shrink by the same share in each round."""
    now, before = np.log(ratio), np.log(last)
    share = np.divide(now, before, out=np.zeros_like(now), where=before > 0.0)
    return np.exp(now / (1.0 - np.where(share < 1.0, np.minimum(share, _SLOWEST), 0.0)))


class _Answer(NamedTuple):
    """A law, and the multipliers of the variables' bounds and of the rows."""

    timed: TimedPath
    of_variables: Array
    of_rows: Array


@dataclass(frozen=True)
class _Problem:
    """What stays while the knots and the limits' tightening change."""

    robot: Mechanism
    path: Path
    limits: Limits
    payload: float
    asked: dict[str, object]

    def solved(self, start: Start) -> _Answer:
        """From a motion that is close, on its knots."""
        return self._solve(start, {}, None)

    def solved_again(self, answer: _Answer, tight: Excess) -> _Answer:
        """On the same knots, each limit tightened by so much."""
        law = answer.timed.law
        start = start_of(law, law.times)
        try:
            return self._solve(start, tight, answer)
        except TimingFailed:  # far from the answer: its multipliers mislead
            return self._solve(start, tight, None)

    def _solve(self, start: Start, tight: Excess, answer: _Answer | None) -> _Answer:
        scale = Scale.of(self.path.length, float(start.times[-1]))
        numbers = numbers_of(self.robot, self.path, self.limits, self.payload, start.position, scale)
        solver = solver_of(Shape(start.intervals, len(self.robot.actuator_names), frozenset(numbers.bounds)))
        given = numbers.parameters
        if "rms" in given:
            given = given | {"rms": given["rms"] * tight.get(_RMS, 1.0) ** 2}
        low, high = _variable_bounds(numbers, tight)
        row_low, row_high = _row_bounds(solver.rows, numbers, tight)
        first = [start.speed[::2] / scale.speed, start.acceleration[::2] / scale.acceleration]
        first += [jerk / scale.jerk for jerk in start.jerk] + [np.diff(start.times[::2]) / scale.time]
        function = solver.from_start if answer is None else solver.from_answer
        known = {} if answer is None else {"lam_x0": answer.of_variables, "lam_g0": answer.of_rows}
        bounds = {"lbx": low, "ubx": high, "lbg": row_low, "ubg": row_high}
        found = function(x0=np.concatenate(first), p=solver.parameter(given), **bounds, **known)
        status = function.stats()["return_status"]
        if status != "Solve_Succeeded":
            raise TimingFailed("jerk", self.asked, f"no solution ({status})")
        law = _law(Variables.split(np.array(found["x"]).ravel()), start.position[::2], scale)
        return _Answer(TimedPath(self.path, law), np.array(found["lam_x"]), np.array(found["lam_g"]))

    def excess(self, timed: TimedPath) -> Excess:
        """What a law uses beyond its limits, between the stations too."""
        times, along = timed.law.within(_SAMPLES)
        motion = motion_of(self.robot, pose_motion(self.path, along), self.payload)
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


def _law(x: Variables, knots: Array, scale: Scale) -> TimeLaw:
    step = x.step * scale.time
    acceleration, jerk = x.acceleration[:-1] * scale.acceleration, x.jerk * scale.jerk
    snap = (x.last_jerk * scale.jerk - jerk) / step
    times = np.concatenate([[0.0], np.cumsum(step)])
    return TimeLaw("jerk", times, knots, x.speed * scale.speed, acceleration, jerk, snap)


def _variable_bounds(numbers: Numbers, tight: Excess) -> tuple[Array, Array]:
    """Of all variables; at rest, with zero s'', at both ends."""
    n, free = numbers.parameters["ds"].size, np.inf
    top = _top_speed(numbers, tight)[::2]
    knots, intervals = np.full(n + 1, free), np.full(n, free)
    low = Variables(np.zeros(n + 1), -knots, -intervals, -intervals, np.full(n, _SHORTEST / n))
    high = Variables(top, knots, intervals, intervals, intervals)
    for bound in (low, high):
        bound.speed[[0, -1]] = bound.acceleration[[0, -1]] = 0.0
    return np.concatenate(low), np.concatenate(high)


def _row_bounds(rows: tuple[Row, ...], numbers: Numbers, tight: Excess) -> tuple[Array, Array]:
    """Of the 3 n equations and the rows."""
    n = numbers.parameters["ds"].size
    low, high = [np.zeros(3 * n)], [np.zeros(3 * n)]
    for row in rows:
        if row.place == "middles":
            most = _top_speed(numbers, tight)[1::2]
        elif row.place == "whole":
            most = numbers.bounds[row.quantity][[row.joint]]
        else:
            inside = tight.get(row.quantity, np.ones(n))
            there = _at_stations(inside) if row.place == "stations" else inside
            most = numbers.bounds[row.quantity][row.joint] / there ** (2 if row.quantity == "tool acceleration" else 1)
        high.append(most)
        low.append(np.full(most.size, -np.inf) if row.quantity in _ONE_SIDED else -most)
    return np.concatenate(low), np.concatenate(high)


def _top_speed(numbers: Numbers, tight: Excess) -> Array:
    """(2 n + 1,) of v at the stations."""
    none = np.ones(numbers.parameters["ds"].size)
    tops = [speed / _at_stations(tight.get(name, none)) for name, speed in numbers.top_speeds.items()]
    least: Array = np.min(tops, axis=0)
    return least


def _at_stations(inside: Array) -> Array:
    """(2 n + 1,) from (n,): in the middle of an interval its own number, at a knot the larger of its two intervals'."""
    found = np.empty(2 * inside.size + 1)
    found[1::2] = inside
    found[::2] = np.maximum(np.append(inside, 0.0), np.append(0.0, inside))
    return found
