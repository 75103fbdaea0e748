"""The fastest law on a fixed path that keeps all limits, with jerk: s''' is piecewise linear, s'' continuous."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from kinematics import Array, InvalidValue, Mechanism
from trajectory.errors import PathBeyondLimit, TimingFailed
from trajectory.laws import LAWS
from trajectory.laws.at_rest import require_possible
from trajectory.laws.jerk.limit_rows import PARTS, smoothstep
from trajectory.laws.jerk.motion import law_in_time
from trajectory.laws.jerk.refinement import Answer, TimingTask, fastest
from trajectory.laws.jerk.refusal import refuse
from trajectory.limits import Limits
from trajectory.motions import TimedPath, TimeLaw
from trajectory.paths import Part, Path, require_poses_of, require_smooth

INTERVALS = 200
LEAST_INTERVALS = 20
# Of the path: pieces in whose middle a motion may rest, which costs next to nothing there. With the first ones it is
# always tried: their scales are so far from the path's that a search may end with a slower motion.
_SHORT = (1e-5, 1e-3)
_PARTS = (2, 4, 8)  # equal ones, between which a motion rests if nothing else is found
_CHECKED = 2000  # intervals of arc length between which the joints' positions are looked at


def jerk_limited(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int = INTERVALS) -> TimedPath:
    """The fastest law from rest to rest, with zero s'' at both ends.

    It may also rest in very short corners, if that is faster or if no other law is found. If still none is found, it
    rests at equal distances.

    Args:
        robot: any mechanism with the path's kind of pose.
        path: a path that is smooth to its third derivative, without a cusp.
        limits: limits of joints and tool. All are kept except the position, which only the path decides.
        payload: mass at the tool [kg].
        intervals: number of intervals at the start, at least 20. More are used until the time stops changing.

    Raises:
        InvalidValue: too few intervals, no jerk limit, an impossible payload, or another kind of pose.
        RoughPath, UnreachablePose: as `time_optimal`.
        PathBeyondLimit: a position is outside its range; or the weight needs more torque than a drive has, at an end,
            or in between where no motion at speed was found.
        TimingFailed: no law was found within the limits.
    """
    if intervals < LEAST_INTERVALS:
        raise InvalidValue("intervals of the jerk law", intervals, f"at least {LEAST_INTERVALS}")
    LAWS["jerk"].require_kept(limits)
    require_poses_of(robot, path)
    require_smooth(path)
    require_possible(robot, path, limits, payload, np.linspace(0.0, path.length, _CHECKED + 1))
    task = TimingTask(robot, path, limits, payload)
    failed: TimingFailed | None = None
    laws = []
    try:
        laws.append(_passing(task, intervals))
    except TimingFailed as error:
        failed = error
    for share in _SHORT:
        if (share == _SHORT[0] or not laws) and (rests := _middles(np.array(path.knots), share * path.length)):
            laws += _resting(task, intervals, rests)
    for parts in _PARTS:
        if not laws:  # slower than need be, but where the robot can rest there is a motion
            laws += _resting(task, intervals, (path.length * np.arange(1, parts) / parts).tolist())
    if not laws:
        assert failed is not None
        raise failed
    return TimedPath(path, min(laws, key=lambda law: law.duration))


def _passing(task: TimingTask, intervals: int) -> TimeLaw:
    """The law that rests at both ends alone."""
    answer = fastest(task, intervals)
    length = task.path.length
    law = law_in_time(answer.motion, length, answer.unit, _per_jerk(answer, length))
    if law is None:
        refuse(*task, answer.sizes.size)
    return law


def _resting(task: TimingTask, intervals: int, rests: Sequence[float]) -> list[TimeLaw]:
    """The law that rests at these arc lengths too; none where there is no such law."""
    path = task.path
    parts = [Part(path, a, b) for a, b in pairwise((0.0, *rests, path.length))]
    try:
        return [TimeLaw.joined([_passing(task._replace(path=part), intervals) for part in parts])]
    except (TimingFailed, PathBeyondLimit):
        return []


def _middles(knots: Array, short: float) -> list[float]:
    """Of the runs of pieces that are so short, but at both ends."""
    is_short = np.diff(knots) <= short
    inside = np.concatenate([[False], is_short[1:-1], [False]]) if is_short.size > 2 else np.zeros(1, dtype=bool)
    first, last = (np.flatnonzero(np.diff(inside.astype(int)) == step) + 1 for step in (1, -1))
    return [float(knots[a] + knots[b]) / 2 for a, b in zip(first, last, strict=True)]


def _per_jerk(answer: Answer, length: float) -> Array:
    """(n + 1,) at the knots, the share of the limits of jerk that one m/s^3 along the path uses."""
    inside = slice(PARTS, -PARTS, PARTS)
    slope = length * smoothstep(answer.motion.knots[1:-1])[1]
    found = answer.unit**3 * np.abs(answer.rows.jerk[inside, :, 0]).max(axis=1) / slope
    return np.concatenate([found[:1], found, found[-1:]])
