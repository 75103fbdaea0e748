"""The limits along a path as rows in the squared rate x = u'^2 of a progress u, w = u'' = x' / 2 and z = x'' / 2.

The arc length is s = L S5(u), L the length and S5 the quintic smoothstep, so that s grows with u^3 where the motion
starts or ends at rest: there x stays above 0, the rest needs no condition of its own, and nothing is singular. With
the derivatives of the joints q by s, a dash for time and u''' = z sqrt(x):

    q'' and torque   a w + b x + d sqrt(x) + c
    q'''             sqrt(x) (e z + f w + g x)
    q', tool speed   x <= most
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics import Array, JointMotion, Mechanism, actuator_motion, bisected
from trajectory.limits import Along, Cap, Disc, Limits, Linear, Sloped, Squared, Third, TorqueAlong
from trajectory.motions import torque_along
from trajectory.paths import Path, places

_FINEST = 2.0**-60  # of u, as it is found by bisection
PARTS = 3  # of each interval: the limits stand at its stations, both ends among them
FORCE = ("by w", "by x", "by rate", "constant", "by rate, either way", "either way")  # columns of `Rows.force`


class Rows(NamedTuple):
    """Coefficients over the limits, at stations (g,) of u.

    Attributes:
        force: (g, f, 6) |a w + b x + d sqrt(x) + c| + e sqrt(x) + k <= 1, columns a, b, d, c, e, k.
        jerk: (g, j, 3) sqrt(x) |a z + b w + c x| <= 1.
        most: (g,) of x.
        tool: (g, t, 3) a w^2 + b w x + c x^2 <= 1.
        mean: (g, m, 4) a w + b x + d sqrt(x) + c, whose mean square over the time is at most 1.
    """

    force: Array
    jerk: Array
    most: Array
    tool: Array
    mean: Array

    def in_unit(self, time: float) -> Rows:
        """With the time counted in a unit [s]."""
        rate = 1.0 / time
        of_force = np.array([rate**2, rate**2, rate, 1.0, rate, 1.0])
        return Rows(
            self.force * of_force,
            self.jerk * rate**3,
            self.most / rate**2,
            self.tool * rate**4,
            self.mean * of_force[:4],
        )

    @property
    def tight_count(self) -> int:
        """How many numbers tighten the rows of an interval: one for each force, jerk, x and tool."""
        result: int = self.force.shape[1] + self.jerk.shape[1] + 1 + self.tool.shape[1]
        return result


def smoothstep(u: Array) -> tuple[Array, Array, Array, Array]:
    """S5 and its first three derivatives."""
    rest = u * (1.0 - u)
    return u**3 * (10.0 + u * (6.0 * u - 15.0)), 30.0 * rest**2, 60.0 * rest * (1.0 - 2.0 * u), 60.0 - 360.0 * rest


def progress_at(share: Array) -> Array:
    """u (k,) where S5 is so much, by bisection."""
    low, high = bisected(lambda u: smoothstep(u)[0] < share, np.zeros_like(share), np.ones_like(share), _FINEST)
    result: Array = 0.5 * (low + high)
    return result


def stations(knots: Array) -> Array:
    """(PARTS n + 1,) of n intervals."""
    inside = knots[:-1, None] + np.diff(knots)[:, None] * (np.arange(PARTS) / PARTS)
    return np.append(inside.ravel(), knots[-1])


def rows_of(robot: Mechanism, path: Path, limits: Limits, payload: float, knots: Array) -> Rows:
    """The rows in SI units, at the stations of intervals between knots (n + 1,) of u.

    Raises:
        UnreachablePose: a limb cannot reach a station.
    """
    along = _along(robot, path, limits, payload, stations(knots))
    count = along.joints.first.shape[0]
    force = [
        _columns(row.by_u, row.by_x, row.by_rate, row.constant, *_either(row))
        for row in limits.constraints(Linear, along)
    ]
    tool = [_square(disc) for disc in limits.constraints(Disc, along)]
    mean = [_columns(row.by_u, row.by_x, row.by_rate, row.constant) for row in limits.constraints(Squared, along)]
    return Rows(
        np.concatenate([np.empty((count, 0, len(FORCE))), *force], axis=1),
        _third(limits, along),
        np.min([cap.most for cap in limits.constraints(Cap, along)], axis=0),
        np.concatenate([np.empty((count, 0, 3)), *tool], axis=1),
        np.concatenate([np.empty((count, 0, 4)), *mean], axis=1),
    )


def _columns(*parts: Array | float) -> Array:
    return np.stack(np.broadcast_arrays(*parts), axis=-1)


def _either(row: Linear) -> tuple[Array | float, Array]:
    """What is there with either sign: by the rate, and constant."""
    return row.slope if isinstance(row, Sloped) else 0.0, row.friction


def _third(limits: Limits, along: Along) -> Array:
    rows = limits.constraints(Third, along)
    return np.concatenate([_columns(row.by_z, row.by_u, row.by_x) for row in rows], axis=1)


def _square(disc: Disc) -> Array:
    by_w, by_x = disc.by_u, disc.by_x
    return _columns((by_w**2).sum(axis=-1), 2.0 * (by_w * by_x).sum(axis=-1), (by_x**2).sum(axis=-1))[:, None]


def _along(robot: Mechanism, path: Path, limits: Limits, payload: float, u: Array) -> Along:
    """The way by u, at stations (g,)."""
    share, *slopes = smoothstep(u)
    derivatives = path.evaluate(np.clip(path.length * share, 0.0, path.length), 3)
    joints = actuator_motion(robot, *derivatives)
    if not np.isfinite(joints.third).all():
        robot.require_reachable(derivatives[0])
    first, second, third = (path.length * v[:, None] for v in slopes)
    by_u = JointMotion(
        joints.position,
        joints.first * first,
        joints.first * second + joints.second * first**2,
        joints.first * third + 3.0 * joints.second * first * second + joints.third * first**3,
    )
    tangent, bend = (d[:, : places(path.pose_names)] for d in derivatives[1:3])

    def split() -> TorqueAlong:
        rate, size = _usual_rate(limits, along), [float(np.abs(v).max()) for v in (first, second)]
        parts = torque_along(robot, payload, derivatives, size[0] * rate, size[1] * rate**2)
        constant, friction = _friction(robot, parts.constant, joints.first)
        by_x = parts.inertia * second + parts.centrifugal * first**2
        return TorqueAlong(parts.inertia * first, by_x, parts.viscous * first, constant, friction, parts.constant)

    along = Along(by_u, (tangent * first, tangent * second + bend * first**2), split)
    return along


def _usual_rate(limits: Limits, along: Along) -> float:
    """About the rate of a motion that keeps the limits of speed and jerk [1/s]."""
    most = min(float(cap.most.min()) for cap in limits.constraints(Cap, along))
    jerk = np.abs(_third(limits, along)[..., 2])
    result: float = min(most**0.5, float(jerk.max()) ** (-1 / 3))
    return result


def _friction(robot: Mechanism, constant: Array, first: Array) -> tuple[Array, Array]:
    """(g, m) the torque's constant, and what friction is kept apart from it: where it may have either sign."""
    drives, both = robot.inertia.drive_train, _turning(first)
    known = drives.friction(first)[0]
    coulomb = drives.of_actuators("coulomb", first.shape[-1])
    return np.where(both, constant - known, constant), np.where(both, coulomb, 0.0)


def _turning(first: Array) -> Array:
    """(g, m) whether the joint turns back in an interval of the station: its Coulomb friction may be either."""
    sign = np.sign(first)
    starts = sign[:-1:PARTS]
    apart = np.zeros(starts.shape, dtype=bool)
    for k in range(1, PARTS + 1):
        apart |= sign[k::PARTS] != starts
    turning = np.zeros(first.shape, dtype=bool)
    for k in range(PARTS + 1):
        turning[k : first.shape[0] - PARTS + k : PARTS] |= apart
    return turning


def weight_use(rows: Rows) -> float:
    """The most that weight and Coulomb friction use of a force; 0 without such a limit."""
    return float((np.abs(rows.force[..., 3]) + rows.force[..., 5]).max(initial=0.0))


def uniform_rate(rows: Rows, most: float = 1.0) -> float:
    """The largest constant rate at which every row but the means is kept, the forces to `most` instead of 1."""
    _, by_x, by_rate, constant, line, either = np.moveaxis(rows.force, -1, 0)
    least = float(rows.most.min()) ** 0.5
    for sign in (1.0, -1.0):
        room, linear, square = most - either - sign * constant, line + sign * by_rate, sign * by_x
        root = linear**2 + 4.0 * square * room
        denominator = linear + np.sqrt(np.maximum(root, 0.0))
        reached = (root >= 0.0) & (denominator > 0.0)
        least = min(least, float(np.min(2.0 * room[reached] / denominator[reached], initial=math.inf)))
    jerk, tool = np.abs(rows.jerk[..., 2]).max(), rows.tool[..., 2].max(initial=0.0)
    result: float = min(least, float(jerk) ** (-1 / 3), math.inf if tool == 0.0 else float(tool) ** -0.25)
    return result
