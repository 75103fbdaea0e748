"""Which interval of increasing knots a number is in, of time or of arc length."""

from __future__ import annotations

from typing import Literal

import numpy as np

from kinematics import Array, InvalidValue

_ROUNDING = 1e-9  # of the duration


def interval_of(knots: Array, at: Array, side: Literal["left", "right"] = "right") -> Array:
    """(...,) the interval of each number, from 0; at a knot the one on that side, beyond the ends the nearest one."""
    return np.clip(np.searchsorted(knots, at, side=side) - 1, 0, knots.size - 2)


def located(times: Array, t: Array) -> tuple[Array, Array]:
    """The interval of each time (...,), and how long after its start it is.

    Args:
        times: (k + 1,) knots, the first at 0 [s].
        t: right of a knot where it is one, but for the last one [s].

    Raises:
        InvalidValue: a time outside the knots by more than rounding, or not a number.
    """
    t, duration = np.asarray(t, dtype=float), float(times[-1])
    outside = ~((t >= -_ROUNDING * duration) & (t <= duration * (1 + _ROUNDING)))
    if outside.any():
        raise InvalidValue("time", float(t[outside].flat[0]), f"a number in [0, {duration:.9g}] s")
    interval = interval_of(times, t)
    return interval, np.clip(t, 0.0, duration) - times[interval]


def throughout(times: Array, fractions: Array) -> tuple[Array, Array]:
    """As `located`, (k, j) each, for fractions (j,) of every interval; 1 stays in the interval that it ends."""
    since = np.diff(times)[:, None] * np.asarray(fractions, dtype=float)
    return np.broadcast_to(np.arange(times.size - 1)[:, None], since.shape), since
