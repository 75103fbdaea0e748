"""How a drive interpolates between set-points, compared with the exact motion.

    linear   cyclic synchronous position at the bus period
    cubic    position and velocity at both ends (PVT)
    quintic  position, velocity and acceleration at both ends

Linear interpolation makes the speed jump, so its acceleration is an impulse and is left out. If the law's acceleration
steps between two set-points, cubics and quintics exceed it. That peak is not an error of the file; a jerk-limited law
avoids it. Extremes are sampled at `PARTS` parts of each period, both ends of each period from inside.
"""

from __future__ import annotations

import numpy as np

from kinematics import Array
from trajectory.limits import Limits

PARTS = 10
_STILL = 1e-6  # of the largest peak of all joints: a joint below it moves by rounding only


def interpolants(time: Array, joints: Array, speed: Array, acceleration: Array) -> dict[str, Array]:
    """The polynomials between set-points by the drive's interpolation.

    Args:
        time: (k,) [s].
        joints, speed, acceleration: (k, m) of the actuators.

    Returns:
        By name, the coefficients (degree + 1, k - 1, m) of the time since each set-point, the highest power last.
    """
    h = np.diff(time)[:, None]
    p, v, a = joints[:-1], speed[:-1], acceleration[:-1]
    gone, faster = np.diff(joints, axis=0), np.diff(speed, axis=0)
    d = gone - h * v  # what the tangent at each start leaves to be done
    cubic = [3 * d / h**2 - faster / h, faster / h**2 - 2 * d / h**3]
    d, dv, da = d - h**2 * a / 2, h * (faster - h * a), h**2 * np.diff(acceleration, axis=0)  # what the parabola leaves
    quintic = [(10 * d - 4 * dv + da / 2) / h**3, (7 * dv - 15 * d - da) / h**4, (6 * d - 3 * dv + da / 2) / h**5]
    return {
        "linear": np.stack([p, gone / h]),
        "cubic": np.stack([p, v, *cubic]),
        "quintic": np.stack([p, v, a / 2, *quintic]),
    }


def between_setpoints(
    setpoints: tuple[Array, Array, Array, Array], exact: list[Array], units: tuple[str, ...], limits: Limits
) -> dict[str, dict[str, float]]:
    """How far each interpolation is from the exact motion, and its peaks over the exact ones and over the limits.

    Args:
        setpoints: time (k,); joints, speed, acceleration (k, m).
        exact: joints, speed, acceleration (k - 1, PARTS + 1, m) in each period.
        units: (m,) rad or m.
        limits: of the joints' speed and acceleration.

    Returns:
        Plain data by the interpolation's name.
    """
    h = np.diff(setpoints[0])
    return {name: _measured(c, h, exact, units, limits) for name, c in interpolants(*setpoints).items()}


def _measured(
    coefficients: Array, h: Array, exact: list[Array], units: tuple[str, ...], limits: Limits
) -> dict[str, float]:
    error = np.abs(_sampled(coefficients, h) - exact[0]).max(axis=(0, 1))
    names = np.array(units)
    found = {f"position error [{unit}]": float(error[names == unit].max()) for unit in sorted(set(units))}
    for order, name in ((1, "speed"), (2, "acceleration")):
        coefficients = _derivative(coefficients)
        if len(coefficients) == 0:
            continue
        peak, true = (np.abs(v).max(axis=(0, 1)) for v in (_sampled(coefficients, h), exact[order]))
        moving = true > _STILL * true.max()
        found[f"peak {name} over exact"] = float((peak[moving] / true[moving]).max(initial=0.0))
        limit = limits.of_joints(name, len(units))
        if limit is not None:
            found[f"peak {name} over limit"] = float((peak / limit).max())
    return found


def _derivative(coefficients: Array) -> Array:
    return coefficients[1:] * np.arange(1, len(coefficients))[:, None, None]


def _sampled(coefficients: Array, h: Array) -> Array:
    """(k - 1, PARTS + 1, m) each interval from inside."""
    since = h[:, None, None] * np.linspace(0.0, 1.0, PARTS + 1)[:, None]
    value = np.zeros(1)
    for c in coefficients[::-1]:
        value = value * since + c[:, None, :]
    return value
