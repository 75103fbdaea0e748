"""ruckig on the arc length s: one speed, acceleration and jerk for the whole path, so small that each limit holds.

With |s'| <= V, |s''| <= A and |s'''| <= J, for every s and every sign,

    |q'| V <= speed,  |q''| V^2 + |q'| A <= acceleration,  |a| A + |b| V^2 + |c| <= torque,
    |q'''| V^3 + 3 |q''| V A + |q'| J <= jerk.

The best of these triples is looked for on a grid of V and A; J is then the largest.
"""

from __future__ import annotations

import numpy as np
from ruckig import InputParameter, Result, Ruckig, Trajectory

from kinematics.arrays import Array
from tests.bench.timing.cases import Case
from tests.bench.timing.samples import sampled
from trajectory import TimedPath, TimeLaw, TimingFailed

STATIONS = 1001
_GRID = 40


def ruckig(case: Case) -> TimedPath:
    """From rest to rest."""
    plans = [_plan(case.path.length, *triple) for triple in zip(*_triples(case), strict=True)]
    best = min(plans, key=lambda plan: plan.duration)
    profile = best.profiles[0][0]
    steps = np.array(profile.t)
    kept = steps > 0.0
    position, speed, acceleration, jerk = (np.array(v) for v in (profile.p, profile.v, profile.a, profile.j))
    times = np.concatenate([[0.0], np.cumsum(steps[kept])])
    at = np.append(np.flatnonzero(kept), len(steps))
    speed = np.maximum(speed[at], 0.0)
    acceleration, jerk = acceleration[at[:-1]], jerk[at[:-1]]
    return TimedPath(case.path, TimeLaw("ruckig", times, position[at], speed, acceleration, jerk, np.zeros_like(jerk)))


def _triples(case: Case) -> tuple[Array, Array, Array]:
    """(k,) V, A and J."""
    at = sampled(case, np.linspace(0.0, case.path.length, STATIONS))
    _, first, second, third = (np.abs(d)[:, None, :] for d in at.joints)
    a, b, c = (np.abs(v)[:, None, :] for v in (at.a, at.b, at.c))
    speed, acceleration, torque, jerk = (case.limit(name) for name in ("speed", "acceleration", "torque", "jerk"))
    shares = np.linspace(0.0, 1.0, _GRID + 1)[1:]
    v = shares * _least(speed, first)
    square = v[:, None] ** 2
    most = np.full(v.size, np.inf)
    if acceleration is not None:
        most = np.minimum(most, _least(acceleration - second * square, first))
    if torque is not None:
        most = np.minimum(most, _least(torque - c - b * square, a))
    v, most = v[most > 0.0], most[most > 0.0]
    v, most = np.repeat(v, _GRID), (most[:, None] * shares).ravel()
    j = _least(jerk - third * v[:, None] ** 3 - 3 * second * (v * most)[:, None], first)
    return v[j > 0.0], most[j > 0.0], j[j > 0.0]


def _least(room: Array, by: Array) -> Array:
    """The most that a factor of `by` may be everywhere."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.nan_to_num(room / by, nan=np.inf, posinf=np.inf).min(axis=(0, -1))


def _plan(length: float, speed: float, acceleration: float, jerk: float) -> Trajectory:
    given = InputParameter(1)
    given.current_position, given.target_position = [0.0], [length]
    given.max_velocity, given.max_acceleration, given.max_jerk = [speed], [acceleration], [jerk]
    plan = Trajectory(1)
    result = Ruckig(1).calculate(given, plan)
    if result != Result.Working:
        raise TimingFailed("ruckig", {"speed": speed, "acceleration": acceleration, "jerk": jerk}, str(result))
    return plan
