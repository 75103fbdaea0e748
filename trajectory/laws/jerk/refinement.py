"""From a slow motion to the fastest one: searches on finer and finer knots, each from the motion before it.

A search keeps the rows at its stations. If its answer exceeds a row between stations, the rows around it are tightened,
and the search continues. If this costs too much time, the knots are too far apart, and their number is doubled. Each
answer is slowed down until it keeps the rows of the path itself between the stations. The fastest answer is returned.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kinematics import Array, Mechanism, bisected
from trajectory.laws.jerk.between_stations import used
from trajectory.laws.jerk.interior_point import SOLVED, Kept, descend
from trajectory.laws.jerk.limit_rows import PARTS, Rows, rows_of, uniform_rate, weight_use
from trajectory.laws.jerk.mesh import first_mesh, next_mesh, piece_edges
from trajectory.laws.jerk.motion import SquaredRate
from trajectory.laws.jerk.refusal import refuse
from trajectory.laws.jerk.stations import keeping, row_count
from trajectory.limits import Limits
from trajectory.paths import Path

_COARSE = 4  # times fewer intervals at first
_IN_PIECE = 8  # intervals, at least, for each piece of the path on average
_DOUBLINGS = 5
_STANDS = 2e-4  # of the time: what tightening may cost on knots that are close enough
_MOST = 16_000  # intervals, where a motion was found on fewer
_ROUNDS = 4  # of tightening
_NEARLY = 1e-3  # over a row: more is no answer
_KEPT = 1e-4  # over a row that is left to the end
_BETWEEN = 4  # parts of an interval, at whose own stations an answer is measured
_LEAST_RATE = 0.1  # to which an answer is slowed down
_RATE = 1e-6  # of the rates that are tried: how finely one is found
_ROUGHLY, _CLOSELY = 1e-2, 1e-5  # of the time: how far from the least one a search may end
_FAR, _NEAR, _SAME = 1e-4, 1e-5, 1e-6  # barrier of a search that starts from a slow, a good, its own motion
_STEPS = 400
_DRAWING = 100  # steps in which loosened rows are drawn in
_LITTLE = 0.1  # share of a motion's squared rate: with less it is a poor start
_PRESSED = (1e-2,)  # barriers of further tries
_HELD = 1.1  # by what more than needed rows are loosened
_INSIDE = 1e-2  # barrier where a motion far from the rows is sought
_ROOM = 5e-4  # of every row that is left where the drives cannot hold the weight: there no stretch mends a motion
_PRICE = 1e3  # of what loosens the forces, in units of the slow motion's time
_SLOWER = 0.98  # of the rate that just keeps every row


class TimingTask(NamedTuple):
    """What is asked, as `jerk_limited`."""

    robot: Mechanism
    path: Path
    limits: Limits
    payload: float


class Answer(NamedTuple):
    """A motion, its rows, its unit of time [s], and about the most that it uses of a row between the stations.

    `tolerance` is how far its time may be above the least one on its knots, relative.
    """

    motion: SquaredRate
    rows: Rows
    unit: float
    time: float
    tolerance: float
    use: float

    @property
    def sizes(self) -> Array:
        """(n,) of the intervals."""
        return np.diff(self.motion.knots)


class _Duals(NamedTuple):
    rows: Array
    means: Array


class _Found(NamedTuple):
    """What a search ended with: a motion in any case, the least one where it converged."""

    answer: Answer
    duals: _Duals
    converged: bool


def fastest(task: TimingTask, intervals: int) -> Answer:
    """The fastest motion on so many intervals, or on as many as it needs.

    Raises:
        TimingFailed: no motion keeps the limits, and why; or the search did not converge.
    """
    edges = piece_edges(task.path)
    asked = max(intervals, _IN_PIECE * (edges.size - 1))
    found, best, settled = _first(task, first_mesh(edges, asked // _COARSE)), None, False
    for _ in range(_DOUBLINGS + 1):
        finer = _on_finer_knots(task, edges, found, asked)
        if finer is None:
            break
        before, found, asked = found, finer, 2 * asked
        if not found.converged:
            if settled:
                break  # so fine that the search fails: the knots before were fine enough
            continue
        answer = _tightened(found.answer, found.duals)
        slowed = _slowed(task, answer)
        if slowed is None:
            continue
        if best is None or slowed.time < best.time:
            best = slowed
        if slowed.time <= (1.0 + _NEARLY) * answer.time:
            settled = True
            left = max(answer.time / found.answer.time - 1.0, _to_be_gained(before.answer, answer))
            if left <= _STANDS or asked > _MOST:
                break
    if best is None:
        refuse(*task, found.answer.sizes.size)
    return best


def _slowed(task: TimingTask, answer: Answer) -> Answer | None:
    """The answer at the largest share of its rate that keeps the rows of the path between the stations too.

    None where no share does, and the answer itself exceeds a row by more than a little: where the drives cannot hold
    the weight, only a motion at speed keeps them.
    """
    between = answer.motion.finer(_BETWEEN)
    rows = _in_unit(rows_of(*task, between.knots), answer.unit)

    def most(rate: float) -> float:
        return float(_uses(between._replace(values=between.values * rate**2), rows).max())

    rate = _largest_rate(most)
    if rate is None:
        return answer if most(1.0) <= 1.0 + _NEARLY else None
    motion = answer.motion._replace(values=answer.motion.values * rate**2)
    return answer._replace(motion=motion, time=answer.time / rate)


def _largest_rate(used_at: Callable[[float], float]) -> float | None:
    """The largest share of the rate, up to 1, at which no row is exceeded; None where none is found."""
    if used_at(1.0) <= 1.0:
        return 1.0
    low, high = _LEAST_RATE, 1.0
    if not used_at(low) <= 1.0:
        return None
    return float(bisected(lambda rate: used_at(float(rate)) <= 1.0, low, high, _RATE * (high - low))[0])


def _to_be_gained(coarse: Answer, fine: Answer) -> float:
    """The share of the time that closer knots still save, as what they save falls with the square of their distance.

    The coarse motion may be above the least one on its knots by what its search left.
    """
    saved = abs(coarse.time - fine.time) / fine.time - coarse.tolerance
    return max(saved, 0.0) / ((fine.sizes.size / coarse.sizes.size) ** 2 - 1.0)


def _on_finer_knots(task: TimingTask, edges: Array, found: _Found, intervals: int) -> _Found | None:
    before = found.answer
    over = np.clip(_uses(before.motion, before.rows).max(axis=1) - 1.0, 0.0, 1.0)
    knots = next_mesh(edges, before.motion, over, intervals)
    rows = _in_unit(rows_of(*task, knots), before.unit)
    start = before.motion.on(knots)
    return _searched(start, rows, before.unit, found.duals.means, _NEAR, _CLOSELY)


def _first(task: TimingTask, knots: Array) -> _Found:
    """On few knots, from the motion of one rate, which the forces may have to be loosened for."""
    rows = rows_of(*task, knots)
    start = SquaredRate(knots, np.tile([1.0, 0.0], knots.size))
    unit = 1.0 / (_SLOWER * uniform_rate(rows, max(1.0, _HELD * weight_use(rows))))
    found = _searched(start, _in_unit(rows, unit), unit, np.zeros(rows.mean.shape[1]), _FAR, _ROUGHLY)
    if found is None:
        refuse(*task, knots.size - 1)
    return found


def _in_unit(rows: Rows, unit: float) -> Rows:
    """With a bound of x too where nothing moves: the largest of all the others."""
    rows = rows.in_unit(unit)
    bounded = np.isfinite(rows.most)
    return rows._replace(most=np.where(bounded, rows.most, rows.most[bounded].max()))


def _searched(
    start: SquaredRate, rows: Rows, unit: float, means: Array, barrier: float, tolerance: float
) -> _Found | None:
    """From a motion, slowed down until it keeps every row; None where no motion was found that does."""
    kept = _untightened(rows, start)
    y = _started(start, kept)
    if y is None:
        return None
    for pressed in (barrier, *_PRESSED):
        duals, found = _Duals(_no_duals(kept), means.copy()), y.copy()
        status, _, time = descend(kept, found, *duals, pressed, tolerance, _STEPS, 0.0, 0.0)
        if status == SOLVED:
            break
    motion = SquaredRate(start.knots, found)
    answer = Answer(motion, rows, unit, time, tolerance, float(_uses(motion, rows).max()))
    return _Found(answer, duals, status == SOLVED)


def _untightened(rows: Rows, motion: SquaredRate) -> Kept:
    """What is kept at first."""
    sizes = np.diff(motion.knots)
    most = 1.0 if weight_use(rows) <= 1.0 else 1.0 - _ROOM
    return Kept(sizes, rows, np.full((sizes.size, rows.tight_count), most), np.ones(rows.mean.shape[1]))


def _started(start: SquaredRate, kept: Kept) -> Array | None:
    """The start slowed down until it keeps the rows or, where that is not enough, another motion; None without one.

    Where the drives cannot hold the weight, slowing down does not help: the rows are loosened until the start keeps
    them, and drawn in again. Where it helps too late, a motion found so is the better start.
    """
    share = keeping(kept.sizes, kept.rows, kept.tight, start.values)
    if share > _LITTLE:
        result: Array | None = share * start.values
        return result
    loose = _HELD * float((_uses(start, kept.rows) - kept.tight).max()) + _HELD - 1.0
    y, duals = start.values.copy(), _Duals(_no_duals(kept), np.zeros(kept.mean_tight.size))
    status, *_ = descend(kept, y, *duals, _INSIDE, 0.0, _DRAWING, loose, _PRICE)
    if status == SOLVED:
        return y
    return share * start.values if share else None


def _no_duals(kept: Kept) -> Array:
    return np.zeros((kept.sizes.size, PARTS + 1, row_count(kept.rows)))


def _holding(rows: Rows) -> Array:
    """(n, rows) what tightening leaves: of a force half of what the weight leaves, where it leaves something."""
    weight = np.abs(rows.force[..., 3]) + rows.force[..., 5]
    most = np.max([weight[k : weight.shape[0] - PARTS + k : PARTS] for k in range(PARTS + 1)], axis=0)
    least = np.where(most < 1.0, 0.5 * (1.0 + most), 0.0)
    return np.pad(least, ((0, 0), (0, rows.tight_count - most.shape[1])))


def _uses(motion: SquaredRate, rows: Rows) -> Array:
    found = np.empty((motion.knots.size - 1, rows.tight_count))
    used(np.diff(motion.knots), motion.values, rows, found)
    return found


def _tightened(answer: Answer, duals: _Duals) -> Answer:
    """On the same knots, until the rows are kept between the stations too, or nearly."""
    motion, rows = answer.motion, answer.rows
    kept, floor, best, use = _untightened(rows, motion), _holding(rows), answer, _uses(motion, rows)
    aim = float(kept.tight[0, 0])
    for _ in range(_ROUNDS):
        if best.use <= aim + _KEPT:
            break
        tight = kept.tight / np.where(use > aim, use / aim * (1.0 + _KEPT / 2), 1.0)
        kept = kept._replace(tight=np.maximum(tight, floor))
        if (y := _started(motion, kept)) is None:
            break
        status, _, time = descend(kept, y, *duals, _SAME, _CLOSELY, _STEPS, 0.0, 0.0)
        if status != SOLVED:
            break
        motion = SquaredRate(motion.knots, y)
        use = _uses(motion, rows)
        if use.max() < best.use:
            best = answer._replace(motion=motion, time=time, use=float(use.max()))
    return best
