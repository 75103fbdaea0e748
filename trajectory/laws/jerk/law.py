"""The fastest law on a fixed path that keeps all limits, jerk among them: s''' piecewise linear, s'' continuous."""

from __future__ import annotations

import numpy as np

from kinematics import Array, InvalidValue, Mechanism
from trajectory.laws.at_rest import require_possible
from trajectory.laws.jerk.limit_rows import PARTS, smoothstep
from trajectory.laws.jerk.motion import law_in_time
from trajectory.laws.jerk.refinement import Answer, Problem, fastest
from trajectory.laws.jerk.refusal import refuse
from trajectory.limits import Limits
from trajectory.motions import TimedPath
from trajectory.paths import Path, require_poses_of, require_smooth

INTERVALS = 200
LEAST_INTERVALS = 20
_CHECKED = 2000  # intervals of arc length between which the joints' positions are looked at


def jerk_limited(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int = INTERVALS) -> TimedPath:
    """The fastest law from rest to rest, with zero s'' at both ends.

    Args:
        robot: any mechanism with the path's kind of pose.
        path: smooth to its third derivative, without a cusp.
        limits: of joints and tool; all are kept but the position, which the path alone decides.
        payload: mass at the tool [kg].
        intervals: to start with, at least 20; the law takes as many as its time needs to stand.

    Raises:
        InvalidValue: too few intervals, no jerk limit, an impossible payload, or another kind of pose.
        RoughPath, UnreachablePose: as `time_optimal`.
        PathBeyondLimit: a position beyond its range, or a weight beyond the torque at an end or, where no motion was
            found that passes at speed, in between.
        TimingFailed: no law was found within the limits.
    """
    if intervals < LEAST_INTERVALS:
        raise InvalidValue("intervals of the jerk law", intervals, f"at least {LEAST_INTERVALS}")
    if limits.jerk is None:
        raise InvalidValue("Limits jerk for the jerk law", None, "a limit; without one the toppra law is the fastest")
    require_poses_of(robot, path)
    require_smooth(path)
    require_possible(robot, path, limits, payload, np.linspace(0.0, path.length, _CHECKED + 1))
    problem = Problem(robot, path, limits, payload)
    answer = fastest(problem, intervals)
    slower = max(1.0, answer.use) ** 0.5  # by the little that it is over a limit
    law = law_in_time(answer.motion, path.length, answer.unit * slower, _per_jerk(answer, path.length))
    if law is None:
        refuse(*problem, answer.sizes.size)
    return TimedPath(path, law)


def _per_jerk(answer: Answer, length: float) -> Array:
    """(n + 1,) at the knots, the share of the limits of jerk that one m/s^3 along the path uses."""
    inside = slice(PARTS, -PARTS, PARTS)
    slope = length * smoothstep(answer.motion.knots[1:-1])[1]
    found = answer.unit**3 * np.abs(answer.rows.jerk[inside, :, 0]).max(axis=1) / slope
    return np.concatenate([found[:1], found, found[-1:]])
