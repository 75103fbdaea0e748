"""From a slow motion to the fastest one: searches on finer and finer knots, each from the motion before it.

A search keeps the rows at its stations. What its answer exceeds between them tightens the rows around it, and the
search goes on; how much time that costs says whether the knots are close enough, and if not there are twice as many.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Mechanism
from trajectory.jerk.barrier import SOLVED, keeping, row_count, search
from trajectory.jerk.between import used
from trajectory.jerk.mesh import first_mesh, next_mesh, piece_edges
from trajectory.jerk.motion import SquaredRate
from trajectory.jerk.refusal import refused
from trajectory.jerk.rows import PARTS, Array, Rows, rows_of, uniform_rate, weight_use
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
_PRESSED = (1e-2, 1.0)  # barriers of further tries
_HELD = 1.1  # by what more than needed rows are loosened
_INSIDE = 1e-2  # barrier where a motion far from the rows is sought
_DRAWS = 40  # of loosened rows
_DRAWN = 0.999  # of the last ones: less is no progress
_LEFT = 0.2  # of the room that was found
_FASTEST = 1e6  # of x in units of the slow motion's, where nothing bounds it
_SLOWER = 0.98  # of the rate that just keeps every row


class Problem(NamedTuple):
    """What is asked, as `jerk_limited`."""

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
    """The fastest motion on so many intervals, or on as many as it needs.

    Raises:
        TimingFailed: no motion keeps the limits, and why.
    """
    edges = piece_edges(problem.path)
    asked = max(intervals, _IN_PIECE * (edges.size - 1))
    first, duals = _first(problem, first_mesh(edges, asked // _COARSE))
    answer = None
    for _ in range(_DOUBLINGS + 1):
        over = np.maximum(_uses(first.motion, first.rows).max(axis=1) - 1.0, 0.0)
        knots = next_mesh(edges, first.motion, over, asked)
        rows = _in_unit(rows_of(*problem, knots), first.unit)
        start = SquaredRate(knots, first.motion.at(knots))
        finer = _searched(start, rows, first.unit, duals.means, _NEAR, _CLOSELY)
        if finer is None:
            break
        first, duals = finer
        answer = _tightened(first, duals)
        if answer.time <= (1.0 + _STANDS) * first.time:
            break
        asked *= 2
    return answer or _tightened(first, duals)


def _first(problem: Problem, knots: Array) -> tuple[Answer, _Duals]:
    """On few knots, from the motion of one rate or, where the drives cannot hold the weight everywhere, of another."""
    rows = rows_of(*problem, knots)
    start = SquaredRate(knots, np.tile([1.0, 0.0], knots.size))
    rate = uniform_rate(rows, max(1.0, _HELD * weight_use(rows)))
    unit = 1.0 / (_SLOWER * rate)
    found = _searched(start, _in_unit(rows, unit), unit, None, _FAR, _ROUGHLY)
    if found is None:
        raise refused(*problem)
    return found


def _in_unit(rows: Rows, unit: float) -> Rows:
    rows = rows.in_unit(unit)
    return rows._replace(most=np.minimum(rows.most, _FASTEST))


def _searched(
    start: SquaredRate, rows: Rows, unit: float, means: Array | None, barrier: float, tolerance: float
) -> tuple[Answer, _Duals] | None:
    """From a motion, slowed down until it keeps every row; None where no motion was found that does."""
    tight, ones = np.ones((start.knots.size - 1, rows.tight_count)), np.ones(rows.mean.shape[1])
    sizes, y = np.diff(start.knots), start.values
    share = keeping(sizes, rows, tight, ones, y)
    y = share * y if share else _held(start, rows)
    if y is None:
        return None
    for pressed in (barrier, *_PRESSED):
        duals = _Duals(_no_duals(sizes.size, rows), np.zeros(ones.size) if means is None else means.copy())
        found = y.copy()
        status, _, time, _ = search(sizes, rows, tight, ones, found, *duals, pressed, tolerance, _STEPS)
        if status == SOLVED:
            motion = SquaredRate(start.knots, found)
            return Answer(motion, rows, unit, time, float(_uses(motion, rows).max())), duals
    return None


def _no_duals(intervals: int, rows: Rows) -> Array:
    return np.zeros((intervals, PARTS + 1, row_count(rows)))


def _held(start: SquaredRate, rows: Rows) -> Array | None:
    """A motion that keeps the rows where slowing down does not help: the drives cannot hold the weight everywhere.

    The forces' rows are loosened until the start keeps them, and drawn in, from one motion well inside them to the
    next. None where they cannot be drawn in any more.
    """
    sizes, y = np.diff(start.knots), start.values
    ones, tight = np.ones(rows.mean.shape[1]), np.ones((sizes.size, rows.tight_count))
    forces = rows.force.shape[1]
    loose = _HELD * float(_uses(start, rows)[:, :forces].max(initial=1.0))
    for _ in range(_DRAWS):
        kept = np.where(np.arange(rows.tight_count) < forces, loose, tight)
        y = y * keeping(sizes, rows, kept, loose**2 * ones, y)
        duals = _Duals(_no_duals(sizes.size, rows), np.zeros(ones.size))
        search(sizes, rows, kept, loose**2 * ones, y, *duals, _INSIDE, 1.0, _STEPS)
        if (share := keeping(sizes, rows, tight, ones, y)) > 0.0:
            return share * y
        use = float(_uses(SquaredRate(start.knots, y), rows)[:, :forces].max())
        if not use < _DRAWN * loose:
            return None
        loose = max(1.0, use + _LEFT * (loose - use))
    return None


def _uses(motion: SquaredRate, rows: Rows) -> Array:
    found = np.empty((motion.knots.size - 1, rows.tight_count))
    used(np.diff(motion.knots), motion.values, rows, found)
    return found


def _tightened(answer: Answer, duals: _Duals) -> Answer:
    """On the same knots, until the rows are kept between the stations too, or nearly."""
    motion, rows, sizes = answer.motion, answer.rows, answer.sizes
    use, means = _uses(motion, rows), np.ones(rows.mean.shape[1])
    tight, best = np.ones_like(use), answer
    for _ in range(_ROUNDS):
        if best.use <= 1.0 + _KEPT:
            break
        tight /= np.where(use > 1.0, use * (1.0 + _KEPT / 2), 1.0)
        y = motion.values * keeping(sizes, rows, tight, means, motion.values)
        status, _, time, _ = search(sizes, rows, tight, means, y, *duals, _SAME, _CLOSELY, _STEPS)
        if status != SOLVED:
            break
        motion = SquaredRate(motion.knots, y)
        use = _uses(motion, rows)
        if use.max() < best.use:
            best = answer._replace(motion=motion, time=time, use=float(use.max()))
    return best
