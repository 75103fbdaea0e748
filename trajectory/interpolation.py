"""What a drive makes of set-points: its own interpolation between them, measured against the exact motion.

    linear   cyclic synchronous position at the bus period
    cubic    position and velocity at both ends (PVT)
    quintic  position, velocity and acceleration at both ends

Linear set-points give steps of speed: their acceleration is an impulse and is left out. Where the law's acceleration
steps between two set-points, cubics and quintics swing beyond it: that peak is no fault of the file, and a jerk-limited
law is what takes it away. Extremes are sampled, `PARTS` a period, both ends of each period from inside.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PPoly

from trajectory.limits import Limits
from trajectory.path import Array

PARTS = 10


def interpolants(time: Array, joints: Array, speed: Array, acceleration: Array) -> dict[str, PPoly]:
    """The curves through set-points by the drive's interpolation.

    Args:
        time: (k,) [s].
        joints, speed, acceleration: (k, m) of the actuators.
    """
    h = np.diff(time)[:, None]
    p, v, a = joints[:-1], speed[:-1], acceleration[:-1]
    # what the parabola from each start leaves to be done, in position, speed and acceleration
    d, dv, da = joints[1:] - p - h * (v + h * a / 2), h * (speed[1:] - v - h * a), h**2 * (acceleration[1:] - a)
    quintic = [(6 * d - 3 * dv + da / 2) / h**5, (7 * dv - 15 * d - da) / h**4, (10 * d - 4 * dv + da / 2) / h**3]
    return {
        "linear": PPoly(np.stack([np.diff(joints, axis=0) / h, p]), time),
        "cubic": CubicHermiteSpline(time, joints, speed),
        "quintic": PPoly(np.stack([*quintic, a / 2, v, p]), time),
    }


def between_setpoints(
    curves: dict[str, PPoly], exact: list[Array], units: tuple[str, ...], limits: Limits
) -> dict[str, dict[str, float]]:
    """How far each interpolation is from the exact motion, and its peaks over the exact ones and over the limits.

    Args:
        curves: by `interpolants`.
        exact: joints, speed, acceleration (n, PARTS + 1, m) in each of the n periods.
        units: (m,) rad or m.
        limits: of the joints' speed and acceleration.

    Returns:
        Plain data by the interpolation's name.
    """
    return {name: _measured(curve, exact, units, limits) for name, curve in curves.items()}


def _measured(curve: PPoly, exact: list[Array], units: tuple[str, ...], limits: Limits) -> dict[str, float]:
    error = np.abs(_sampled(curve) - exact[0]).max(axis=(0, 1))
    names = np.array(units)
    found = {f"position error [{unit}]": float(error[names == unit].max()) for unit in sorted(set(units))}
    for order, name in ((1, "speed"), (2, "acceleration")):
        if curve.c.shape[0] - 1 < order:
            continue
        peak, true = (np.abs(v).max(axis=(0, 1)) for v in (_sampled(curve.derivative(order)), exact[order]))
        found[f"peak {name} over exact"] = float((peak[true > 0] / true[true > 0]).max(initial=0.0))
        limit = limits.of_joints(name, len(units))
        if limit is not None:
            found[f"peak {name} over limit"] = float((peak / limit).max())
    return found


def _sampled(curve: PPoly) -> Array:
    """(n, PARTS + 1, m) each interval from inside."""
    since = np.diff(curve.x)[:, None, None] * np.linspace(0.0, 1.0, PARTS + 1)[:, None]
    value = np.zeros(1)
    for coefficient in curve.c:
        value = value * since + coefficient[:, None, :]
    return value
