"""From a slow motion to the fastest one: searches on finer and finer knots, each from the motion before it.

A search keeps the rows at its stations. What its answer exceeds between them tightens the rows around it, and the
search goes on; how much time that costs says whether the knots are close enough, and if not there are twice as many.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Mechanism
from trajectory.errors import TimingFailed
from trajectory.jerk.barrier import OUTSIDE, SOLVED, keeping, row_count, search
from trajectory.jerk.between import used
from trajectory.jerk.mesh import first_mesh, next_mesh, piece_edges
from trajectory.jerk.motion import SquaredRate
from trajectory.jerk.rows import PARTS, Array, Rows, rows_of, uniform_rate
from trajectory.limits import Limits
from trajectory.path import Path

_COARSE = 4  # times fewer intervals at first
_IN_PIECE = 8  # intervals, at least, for each piece of the path on average
_DOUBLINGS = 6
_STANDS = 2e-4  # of the time: what tightening may cost on knots that are close enough
_ROUNDS = 4  # of tightening
_KEPT = 5e-5  # over a row that is left to the end
_ROUGHLY, _CLOSELY = 1e-2, 1e-5  # of the time: how far from the least one a search may end
_FAR, _NEAR, _SAME = 1e-4, 1e-5, 1e-6  # barrier of a search that starts from a slow, a good, its own motion
_STEPS = 150
_FASTEST = 1e6  # of x in units of the slow motion's, where nothing bounds it
_SLOWER = 0.98  # of the rate that just keeps every row


class Problem(NamedTuple):
    """What is asked."""

    robot: Mechanism
    path: Path
    limits: Limits
    payload: float


class Answer(NamedTuple):
    """A motion, its rows, its unit of time [s], and the most that it uses of a row between the stations."""

    motion: SquaredRate
    rows: Rows
    unit: float
    time: float
    use: float

    @property
    def sizes(self) -> Array:
        """(n,) of the intervals."""
        return np.diff(self.motion.knots)


class _Duals(NamedTuple):
    rows: Array
    means: Array


def fastest(problem: Problem, intervals: int) -> Answer:
    """The fastest motion on so many intervals, or on as many as it needs."""
    edges = piece_edges(problem.path)
    asked = max(intervals, _IN_PIECE * (edges.size - 1))
    knots = first_mesh(edges, asked // _COARSE)
    rows = rows_of(*problem, knots)
    unit = 1.0 / (_SLOWER * uniform_rate(rows))
    still = np.tile([1.0, 0.0], knots.size)
    answer, duals = _searched(SquaredRate(knots, still), _in_unit(rows, unit), unit, None, _FAR, _ROUGHLY)
    for _ in range(_DOUBLINGS + 1):
        finer = answer.motion.finer(PARTS)
        knots = next_mesh(edges, finer.knots, finer.times(), asked)
        rows = _in_unit(rows_of(*problem, knots), unit)
        start = SquaredRate(knots, answer.motion.at(knots))
        first, duals = _searched(start, rows, unit, duals.means, _NEAR, _CLOSELY)
        answer = _tightened(first, duals)
        if answer.time <= (1.0 + _STANDS) * first.time:
            break
        asked *= 2
    return answer


def _in_unit(rows: Rows, unit: float) -> Rows:
    rows = rows.in_unit(unit)
    return rows._replace(most=np.minimum(rows.most, _FASTEST))


def _searched(
    start: SquaredRate, rows: Rows, unit: float, means: Array | None, barrier: float, tolerance: float
) -> tuple[Answer, _Duals]:
    """From a motion, slowed down until it keeps every row."""
    tight = np.ones((start.knots.size - 1, rows.tight_count))
    shape = (tight.shape[0], PARTS + 1, row_count(rows))
    duals = _Duals(np.zeros(shape), np.zeros(rows.mean.shape[1]) if means is None else means.copy())
    found = _descended(start, rows, tight, duals, barrier, tolerance)
    if found is None:
        raise TimingFailed("jerk", {}, "no solution")
    y, time = found
    motion = SquaredRate(start.knots, y)
    return Answer(motion, rows, unit, time, float(_uses(motion, rows).max())), duals


def _descended(
    start: SquaredRate, rows: Rows, tight: Array, duals: _Duals, barrier: float, tolerance: float
) -> tuple[Array, float] | None:
    sizes, means = np.diff(start.knots), np.ones(rows.mean.shape[1])
    share = keeping(sizes, rows, tight, means, start.values)
    y = share * start.values
    status, _, time, _ = search(sizes, rows, tight, means, y, *duals, 1.0, barrier, tolerance, _STEPS)
    return (y, time) if status == SOLVED else None


def _uses(motion: SquaredRate, rows: Rows) -> Array:
    found = np.empty((motion.knots.size - 1, rows.tight_count))
    used(np.diff(motion.knots), motion.values, rows, found)
    return found


def _tightened(answer: Answer, duals: _Duals) -> Answer:
    """On the same knots, until the rows are kept between the stations too, or nearly."""
    motion, rows = answer.motion, answer.rows
    use = _uses(motion, rows)
    tight, best = np.ones_like(use), answer
    for _ in range(_ROUNDS):
        if best.use <= 1.0 + _KEPT:
            break
        tight /= np.where(use > 1.0, use * (1.0 + _KEPT / 2), 1.0)
        found = _descended(motion, rows, tight, duals, _SAME, _CLOSELY)
        if found is None:
            break
        motion = SquaredRate(motion.knots, found[0])
        use = _uses(motion, rows)
        if use.max() < best.use:
            best = answer._replace(motion=motion, time=found[1], use=float(use.max()))
    return best
