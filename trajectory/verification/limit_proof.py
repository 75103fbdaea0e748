"""Proof that a motion keeps its limits at every instant: upper bounds of its use of them, over parts that cover it.

The use in a part is at most that in its middle plus the slack of `enclosure`. Parts whose bound is well above the
highest use seen anywhere are cut again, until each bound is close to the real use.
"""

from __future__ import annotations

import numpy as np

from kinematics import Array, Mechanism
from trajectory.limits import InstantLimit, Limit, Limits, Use, mean_squares, uses
from trajectory.motions import TimedMotion, motion_of
from trajectory.verification.enclosure import slack

_PARTS = 4000  # of the whole motion at first, about
_CLOSE = 2e-5  # relative: by how much a bound may exceed the highest use seen
_LITTLE = 1e-6  # of a limit: no bound need be closer to what stands still
_CUTS = 4  # of a part that is cut
_ROUNDS = 6  # of cutting; what is still open then keeps its bound
_SLACK = 1e-11  # relative: more than what evaluation in double arithmetic is off by


def proved_use(robot: Mechanism, timed: TimedMotion, limits: Limits, payload: float) -> dict[str, float]:
    """Upper bounds over the whole motion of each limited quantity over its limit; infinite if none was found.

    The bounds do not include the jerk exactly between two intervals, where the acceleration may jump.

    Args:
        robot, timed, limits, payload: as for `verify`.
    """
    low, high = _parts(timed)
    seen: dict[Limit, float] = {}
    bounds: dict[Limit, float] = {}
    means = [limit for limit in mean_squares() if limit.is_set(limits)]
    squares = {limit: np.zeros(len(robot.actuator_names)) for limit in means}
    for round_ in range(_ROUNDS + 1):
        motion = motion_of(robot, timed.at(0.5 * low + 0.5 * high), payload)
        away = slack(robot, timed, payload, low, high)
        least, most = _ratios(uses(robot, motion, limits)), _ratios(uses(robot, motion, limits, away.motion))
        open_ = np.zeros(low.size, dtype=bool)
        for limit, ratio in least.items():
            seen[limit] = max(seen.get(limit, 0.0), float(np.nan_to_num(ratio, nan=0.0).max()))
            if round_ < _ROUNDS:
                open_ |= ~(most[limit] <= max(seen[limit] * (1.0 + _CLOSE), _LITTLE)).all(axis=-1)
        closed = ~open_
        for limit, ratio in most.items():
            highest = float(np.nan_to_num(ratio[closed], nan=np.inf).max(initial=0.0)) * (1.0 + _SLACK)
            bounds[limit] = max(bounds.get(limit, 0.0), highest)
        for mean in means:
            size, excess = np.abs(mean.quantity(motion)), mean.excess(away.motion, away.mean_torque)
            squares[mean] += _squares(*(part[closed] for part in (high - low, size, *excess)))
        if closed.all():
            break
        low, high = _cut(low[open_], high[open_])
    for mean, square in squares.items():
        bounds[mean] = float((np.sqrt(square / timed.duration) / mean.most(limits, square.size)).max())
    return {limit.name: bound for limit, bound in bounds.items()}


def _ratios(used: dict[InstantLimit, Use]) -> dict[InstantLimit, Array]:
    """Of what is limited."""
    return {limit: use.ratio for limit, use in used.items() if use.ratio is not None}


def _parts(timed: TimedMotion) -> tuple[Array, Array]:
    """(k,) starts and ends, none of which crosses a knot; at least one an interval."""
    lengths = np.diff(timed.times)
    shares = np.maximum(lengths / timed.duration, np.diff(timed.progress))
    counts = np.ceil(shares * _PARTS).astype(int)
    interval = np.repeat(np.arange(counts.size), counts)
    place = np.arange(interval.size) - np.repeat(np.cumsum(counts) - counts, counts)
    step = lengths[interval] / counts[interval]
    low = timed.times[interval] + place * step
    last = place + 1 == counts[interval]
    return low, np.where(last, timed.times[interval + 1], low + step)


def _cut(low: Array, high: Array) -> tuple[Array, Array]:
    edges = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, _CUTS + 1)
    edges[:, -1] = high
    return edges[:, :-1].ravel(), edges[:, 1:].ravel()


def _squares(lengths: Array, size: Array, most: Array, mean: Array) -> Array:
    """(m,) upper bounds of the integral of a square, from the quantity's size in the middle of each part.

    With e what is on top of that, the square's mean is size^2 + 2 size (mean of e) + the mean of e^2.
    """
    found: Array = lengths @ (size**2 + 2.0 * size * mean + most**2)
    return found
