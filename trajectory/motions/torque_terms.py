"""Torque along a path, split by how it depends on the path's speed and acceleration, by numbers only.

The equations of motion are quadratic in the rates. Friction adds a constant and a linear part, as long as no joint
turns back. So the same motion r times as fast, r > 0, needs the torque constant + linear r + quadratic r^2. Three
speeds give the three parts exactly.
"""

from __future__ import annotations

from typing import NamedTuple

from kinematics import Array, Mechanism, inverse_dynamics


class ByRate(NamedTuple):
    """tau = constant + linear r + quadratic r^2, (..., m) each."""

    constant: Array
    linear: Array
    quadratic: Array


class AlongPath(NamedTuple):
    """tau = inertia s'' + centrifugal s'^2 + viscous s' + constant for s' > 0, (k, m) each."""

    inertia: Array
    centrifugal: Array
    viscous: Array
    constant: Array


def torque_by_rate(robot: Mechanism, payload: float, pose: Array, velocity: Array, acceleration: Array) -> ByRate:
    """The torque of the same way travelled r times as fast.

    Args:
        robot, payload, pose, velocity, acceleration: as for `inverse_dynamics`, at r = 1.
    """
    full, half, quarter = (
        inverse_dynamics(robot, payload, pose, velocity * r, acceleration * r**2) for r in (1.0, 0.5, 0.25)
    )
    quadratic = (8.0 / 3.0) * ((full - half) - 2.0 * (half - quarter))
    linear = 2.0 * (full - half) - 1.5 * quadratic
    return ByRate(full - linear - quadratic, linear, quadratic)


def torque_along(
    robot: Mechanism, payload: float, derivatives: tuple[Array, ...], speed: float, acceleration: float
) -> AlongPath:
    """The torque's parts at points of a path.

    Args:
        robot, payload: as for `inverse_dynamics`.
        derivatives: (k, n) pose, first and second derivative by arc length.
        speed, acceleration: of about the size that will be used, so that rounding stays small [m/s, m/s^2].
    """
    pose, first, second = derivatives[:3]
    steady = torque_by_rate(robot, payload, pose, first * speed, second * speed**2)
    faster = inverse_dynamics(robot, payload, pose, first * speed, second * speed**2 + first * acceleration)
    inertia = (faster - sum(steady)) / acceleration
    return AlongPath(inertia, steady.quadratic / speed**2, steady.linear / speed, steady.constant)
