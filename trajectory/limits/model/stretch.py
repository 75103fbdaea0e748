"""The stretch of time that each sample of a motion needs to keep a limit."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from kinematics import Array, JointMotion, Mechanism, actuator_motion
from trajectory.errors import LimitsExceeded
from trajectory.motions import ByRate, PoseMotion, torque_by_rate

_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class Sampled:
    """A motion at samples that cover it.

    Attributes:
        robot: the robot that moves.
        tool: (k, j, n) the pose and its time derivatives.
        payload: mass at the tool [kg].
        mean: function that gives the mean over time of values (k, j, ...) at the samples.
    """

    robot: Mechanism
    tool: PoseMotion
    payload: float
    mean: Callable[[Array], Array]

    @cached_property
    def torque(self) -> ByRate:
        """The torque as a function of the rate of the same motion."""
        return torque_by_rate(self.robot, self.payload, self.tool.pose, self.tool.velocity, self.tool.acceleration)

    @cached_property
    def joints(self) -> JointMotion:
        """Of the actuators."""
        return actuator_motion(self.robot, *self.tool)


def stretch_of_sum(name: str, torque: ByRate, limit: Array, slope: Array | float) -> float:
    """The least factor f of time with |torque| + slope / f <= limit at each sample, the torque that at r = 1 / f.

    Raises:
        LimitsExceeded: the torque at rest is already above the limit.
    """
    sign = np.sign(sum(torque))
    rest = limit - sign * torque.constant
    if not rest.min() > 0.0:
        raise LimitsExceeded({f"{name} at rest": float((1.0 - rest / limit).max())}, 1.0)
    linear, quadratic = sign * torque.linear + slope, sign * torque.quadratic
    over = linear + quadratic > rest
    c, b, a = rest[over], linear[over], quadratic[over]
    # The first root, free of cancellation; it is real, as the limit is kept at r = 0 and broken at r = 1.
    return 1.0 / float(np.min(2 * c / (b + np.sqrt(b**2 + 4 * a * c)), initial=1.0))


def stretch_of_mean_square(name: str, torque: ByRate, limit: float, mean: Callable[[Array], Array]) -> float:
    """The least factor of time with which the mean square of one drive's torque (k, j), a quartic in r, keeps a limit.

    Raises:
        LimitsExceeded: the torque at rest is already above the limit.
    """
    c, b, a = (x[..., None] for x in torque)
    quartic = mean(np.concatenate([a * a, 2 * a * b, b * b + 2 * a * c, 2 * b * c, c * c], axis=-1))
    quartic[-1] -= limit**2
    if not quartic[-1] < 0.0:
        raise LimitsExceeded({f"{name} at rest": math.sqrt(quartic[-1] + limit**2) / limit}, 1.0)
    if quartic.sum() <= 0.0:
        return 1.0
    roots = np.roots(quartic)
    real = roots.real[np.abs(roots.imag) < _ROUNDING]
    return 1.0 / float(real[(real > 0.0) & (real <= 1.0)].max())
