"""The pace of a stop on a motion's own way that also keeps the jerk limit.

The motion p(tau) has a pace tau' that never rises, from 1 to 0, with zero tau'' at both ends and tau''' constant in
each interval. The pace makes the mean of x = tau'^2 over the way small: this is the energy of motion if the robot hits
something. Without a jerk limit the pace of `braking` has the least mean, as it has the least x everywhere.

With tangents instead of curves, the limits are linear in x and tau'' (`smooth_braking_rows`). A linear programme finds
the pace. New tangents at its answer give the next programme, until x stops falling (`smooth_pace`). A motion within its
limits keeps the rows of the first programme, so that programme has an answer from any instant. Then the knots are
placed where this pace needs them, closer together near the rest, and all is repeated until the place of the rest no
longer changes. Convergence is not guaranteed, and the limits may fail between the knots. The answer is a local optimum.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics import Array, Mechanism
from trajectory.errors import LimitsExceeded, TimingFailed
from trajectory.limits import Limits, uses
from trajectory.motions import SAME, TimedMotion, TimeLaw, motion_of
from trajectory.stops.braking import steps_of, with_knots
from trajectory.stops.smooth_braking_rows import braking_rows
from trajectory.stops.smooth_pace import INSTANTS, Pace, least_pace

COARSE = 50  # steps of the rest of the motion, to see about where braking ends
STEPS = 100  # of the braking, at least
_BEYOND = 0.25  # of them as many again, towards the end of the motion
_LATER = 10  # steps from there to the end of the motion
_ROUNDS = 12
_SLOW = 0.05  # pace from which a constant jerk leads to rest
_SETTLED = 0.03  # of the way, by which it may differ from what the knots were made for
_ROUNDING = 1e-9  # of the way, a limit or the largest acceleration
_FIRST = 1e-3  # of the first step: a knot of the motion that is closer to the start would be too much for a programme
_HIGHER = 0.001  # a guess on new knots over the answer on the old ones: a tangent at too low an x forbids more


def smooth_braking(
    robot: Mechanism, timed: TimedMotion, start: float, limits: Limits, payload: float, margin: float
) -> TimeLaw:
    """The motion's time as a law of the time since `start`.

    Args:
        robot, timed, start, limits, payload: as for `emergency_stop`, with a jerk limit.
        margin: share of the limits that is left unused when the pace is well below 1.

    Raises:
        LimitsExceeded: the motion breaks a limit after `start`.
        TimingFailed: no pace was found.
    """
    _require_kept(robot, timed, start, limits, payload)
    asked = {**limits.as_dict(), "payload": payload, "start": start}
    coarse = np.linspace(start, timed.duration, COARSE + 1)
    before = _least(robot, timed, Pace(coarse, np.ones_like(coarse), np.zeros_like(coarse)), limits, payload, margin)
    for _ in range(_ROUNDS):
        law = None if before is None else _law(timed, before)
        if before is None or law is None:
            break
        knots, last = _knots(timed, start, law.position[-1])
        guess = np.minimum(np.interp(knots, before.tau, before.x) + _HIGHER, 1.0)
        pace = _least(robot, timed, Pace(knots, guess, np.interp(knots, before.tau, before.b)), limits, payload, margin)
        found = None if pace is None else _law(timed, pace)
        way = law.position[-1] - start
        rest = math.inf if found is None else found.position[-1]
        if found is not None and rest <= last and abs(rest - law.position[-1]) <= _SETTLED * way:
            return found
        before = pace
    raise TimingFailed(
        "emergency stop", asked, "no pace leads to rest" if before is None else "the search for the pace did not settle"
    )


def _least(
    robot: Mechanism, timed: TimedMotion, near: Pace, limits: Limits, payload: float, margin: float
) -> Pace | None:
    """The pace on the knots of a guess."""
    rows = braking_rows(robot, steps_of(timed, near.tau, INSTANTS), limits, payload)
    return least_pace(*rows, near, margin)


def _require_kept(robot: Mechanism, timed: TimedMotion, start: float, limits: Limits, payload: float) -> None:
    """Raise LimitsExceeded where the motion is over a limit, or its acceleration jumps, at a knot after the start."""
    motion = motion_of(robot, timed.within(np.array([0.0, 1.0]))[1], payload)
    later = timed.times[1:] > start
    used = uses(robot, motion, limits)
    peaks = {limit.name: float(use.ratio[later].max()) for limit, use in used.items() if use.ratio is not None}
    acceleration = motion.joints.second
    jump = np.abs(acceleration[1:, 0] - acceleration[:-1, -1])[later[:-1]].max(initial=0.0)
    if jump > _ROUNDING * np.abs(acceleration).max():
        peaks |= {limit.name: math.inf for limit, use in used.items() if limit.jumps and use.ratio is not None}
    over = {f"{name} of the motion to be stopped": peak for name, peak in peaks.items() if not peak <= 1.0 + _ROUNDING}
    if over:
        raise LimitsExceeded(over, 1.0)


def _knots(timed: TimedMotion, start: float, rest: float) -> tuple[Array, float]:
    """From the start to the end of the motion, close to the rest closest; and up to where they have its own knots."""
    to_go = np.linspace(1.0, 0.0, STEPS + 1)
    beyond = to_go[to_go <= _BEYOND][-2::-1]
    even = rest + (rest - start) * np.concatenate([-(to_go**2), beyond**2])
    even = even[even <= timed.duration]
    even[0], last = start, even[-1]  # not to rounding alone
    knots = with_knots(timed, even, 0.2 * np.append(np.diff(even), last - even[-2]))
    knots = knots[(knots == start) | (knots > start + _FIRST * (even[1] - start)) & (knots <= last)]
    later = np.linspace(last, timed.duration, _LATER + 1)[1:] if last < timed.duration else even[:0]
    return np.append(knots, later), float(last)


def _law(timed: TimedMotion, pace: Pace) -> TimeLaw | None:
    """The law with these tau'' at its knots, down to the pace from which a constant jerk leads to rest."""
    tau, second = _with_first_knots(timed, pace)
    times, speeds = [0.0], [1.0]
    for k, step in enumerate(np.diff(tau)):
        v, mean = speeds[k], (2.0 * second[k] + second[k + 1]) / 3.0
        root = v**2 + 2.0 * mean * step  # of step = v h + mean h^2 / 2
        h = 2.0 * step / (v + math.sqrt(max(root, 0.0)))
        after = v + 0.5 * (second[k] + second[k + 1]) * h
        if root <= 0.0 or after < _SLOW:
            to_go = -v / second[k] * v * 2.0 / 3.0 if second[k] < 0.0 else math.inf
            if tau[k] + to_go <= tau[-1]:
                return _to_rest(tau, second[: k + 1], np.array(times), np.array(speeds), to_go)
            if root <= 0.0 or after < 0.0:
                return None
        times.append(times[-1] + h)
        speeds.append(after)
    return _joined(np.array(times), tau, np.array(speeds), second)


def _with_first_knots(timed: TimedMotion, pace: Pace) -> tuple[Array, Array]:
    """Knots and tau'' there, with the motion's own in the first step too: tau'' grows from 0 at one rate in time."""
    start, first = pace.tau[:2]
    missed = timed.times[(timed.times > start + SAME * timed.duration) & (timed.times < first)]
    share = (missed - start) / (first - start) * 0.5 * (1.0 + math.sqrt(pace.x[1]))  # of the step's time
    return np.insert(pace.tau, 1, missed), -np.insert(pace.b, 1, share * pace.b[1])


def _to_rest(tau: Array, second: Array, times: Array, speeds: Array, to_go: float) -> TimeLaw:
    """The law up to its last knot so far, and from there to rest at a constant jerk, with a knot at each tau."""
    k = times.size - 1
    rest, jerk, last = tau[k] + to_go, 0.5 * second[k] ** 2 / speeds[k], -2.0 * speeds[k] / second[k]
    between = tau[k + 1 :][tau[k + 1 :] < rest * (1.0 - SAME)]
    left = np.append(np.cbrt(6.0 * (rest - between) / jerk), 0.0)  # time
    return _joined(
        np.append(times, times[k] + last - left),
        np.concatenate([tau[: k + 1], between, [rest]]),
        np.append(speeds, 0.5 * jerk * left**2),
        np.append(second, -jerk * left),
    )


def _joined(times: Array, tau: Array, speeds: Array, second: Array) -> TimeLaw:
    jerk = np.diff(second) / np.diff(times)
    return TimeLaw("emergency stop", times, tau, speeds, second[:-1], jerk, np.zeros_like(jerk))
