"""One law in one case: its time, its solver's, what the verifier finds, and its time within all limits."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from kinematics import LinkwrightError
from tests.bench.timing.cases import Case
from trajectory import LIMITS, Limits, LimitsExceeded, TimedMotion, Verification, repair, verify
from trajectory.cycles.least_stretch import REPAIRABLE

REPEATS = 3
LONG = 5.0  # seconds: what takes longer is repeated once
_POWERS = {limit.name: limit.pace_power for limit in LIMITS}  # about, for the torque
_JUST_BELOW = 0.999  # how far the pace is taken past the guess, so that the repair finds the exact one
_NEAR = 0.999  # a motion that uses its limits so far is left as it is
_ROUNDS = 20


@dataclass(frozen=True)
class Row:
    """Of the table; SI. What did not work is NaN, and `reason` says why."""

    law: str
    jerk: bool
    duration: float = math.nan
    solve: float = math.nan
    worst: float = math.nan
    quantity: str = ""
    held: float = math.nan
    worst_held: float = math.nan
    reason: str = ""


def measured(case: Case, law: str, jerk: bool, solve: Callable[[], TimedMotion]) -> Row:
    """Solve once to warm up and then again, verify, and bring to the limits.

    Args:
        case: the problem.
        law: its name in the table.
        jerk: whether the law keeps the jerk limit; the others are measured without it.
        solve: the law.
    """
    limits = case.limits if jerk else case.without_jerk
    try:
        first, motion = _timed(solve)
        seconds = statistics.median(_timed(solve)[0] for _ in range(1 if first > LONG else REPEATS))
        found = verify(case.robot, motion, limits, case.payload)
        quantity, worst = max(found.peak_over_limit.items(), key=lambda item: item[1])
        row = Row(law, jerk, motion.duration, seconds, worst, quantity)
    except (LinkwrightError, ValueError, RuntimeError) as error:
        return Row(law, jerk, reason=f"{type(error).__name__}: {error}".split("\n")[0])
    try:
        held, after = at_the_limit(case, motion, limits)
    except LimitsExceeded as error:
        return replace(row, reason=f"no scaling of time mends {', '.join(error.failures)}")
    return replace(row, held=held.duration, worst_held=max(after.peak_over_limit.values()))


def at_the_limit(case: Case, motion: TimedMotion, limits: Limits) -> tuple[TimedMotion, Verification]:
    """The motion at the pace at which every limit holds and one is reached, faster or slower than it was.

    Raises:
        LimitsExceeded: there is none.
    """
    for _ in range(_ROUNDS):
        found = verify(case.robot, motion, limits, case.payload)
        peaks = found.peak_over_limit
        worst = max(peaks.values())
        if found.ok and worst >= _NEAR:
            return motion, found
        if 1.0 <= worst <= REPAIRABLE or not math.isfinite(worst):
            mended = repair(case.robot, motion, limits, case.payload)
            return mended.motion, mended.verification
        motion = motion.stretched(_JUST_BELOW * max(ratio ** (1 / _POWERS[name]) for name, ratio in peaks.items()))
    raise LimitsExceeded(found.failures, 1.0)


def _timed(solve: Callable[[], TimedMotion]) -> tuple[float, TimedMotion]:
    start = time.perf_counter()
    motion = solve()
    return time.perf_counter() - start, motion
