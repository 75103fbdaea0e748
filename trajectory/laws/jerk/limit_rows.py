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
from trajectory.limits import Limits
from trajectory.motions import AlongPath, torque_along
from trajectory.paths import Path, places

_FINEST = 2.0**-60  # of u, as it is found by bisection
PARTS = 3  # of each interval: the limits stand at its stations, both ends among them
FORCE = ("by w", "by x", "by rate", "constant", "by rate, either way", "either way")  # columns of `Rows.force`


class Rows(NamedTuple):
    """Coefficients over the limits, at stations (g,) of u.

    Attributes:
        force: (g, f, 6) |a w + b x + d sqrt(x) + c| + e sqrt(x) + k <= 1, columns a, b, d, c, e, k.
        jerk: (g, m, 3) sqrt(x) |a z + b w + c x| <= 1.
        most: (g,) of x.
        tool: (g, 1 or 0, 3) a w^2 + b w x + c x^2 <= 1.
        mean: (g, m or 0, 4) a w + b x + d sqrt(x) + c, whose mean square over the time is at most 1.
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
        return self.force.shape[1] + self.jerk.shape[1] + 1 + self.tool.shape[1]


def smoothstep(u: Array) -> tuple[Array, Array, Array, Array]:
    """S5 and its first three derivatives."""
    rest = u * (1.0 - u)
    return u**3 * (10.0 + u * (6.0 * u - 15.0)), 30.0 * rest**2, 60.0 * rest * (1.0 - 2.0 * u), 60.0 - 360.0 * rest


def progress_at(share: Array) -> Array:
    """u (k,) where S5 is so much, by bisection."""
    return bisected(lambda u: smoothstep(u)[0] < share, np.zeros_like(share), np.ones_like(share), _FINEST)[1]


def stations(knots: Array) -> Array:
    """(PARTS n + 1,) of n intervals."""
    inside = knots[:-1, None] + np.diff(knots)[:, None] * (np.arange(PARTS) / PARTS)
    return np.append(inside.ravel(), knots[-1])


def rows_of(robot: Mechanism, path: Path, limits: Limits, payload: float, knots: Array) -> Rows:
    """The rows in SI units, at the stations of intervals between knots (n + 1,) of u.

    Raises:
        UnreachablePose: a limb cannot reach a station.
    """
    u = stations(knots)
    share, *slopes = smoothstep(u)
    along = tuple(path.length * v for v in slopes)
    derivatives = path.evaluate(np.clip(path.length * share, 0.0, path.length), 3)
    joints = actuator_motion(robot, *derivatives)
    if not np.isfinite(joints.third).all():
        robot.require_reachable(derivatives[0])
    count = joints.first.shape[-1]
    torque = _torque(robot, payload, derivatives, along, joints, limits)
    force = [] if (row := _acceleration(joints, along, limits)) is None else [row]
    mean = np.empty((u.size, 0, 4))
    if torque is not None:
        both = _turning(joints.first)
        force += _torque_rows(robot, limits, torque, joints, along, both)
        if (rms := limits.of_joints("rms_torque", count)) is not None:
            mean = torque / rms[:, None]
    tangent, bend = (d[:, : places(path.pose_names)] for d in derivatives[1:3])
    return Rows(
        np.concatenate(force, axis=1) if force else np.empty((u.size, 0, len(FORCE))),
        _jerk(joints, along, _of_joints(limits, "jerk", joints)),
        _most(joints, along, tangent, limits),
        _tool(tangent, bend, along, limits.tool_acceleration),
        mean,
    )


def _columns(*parts: Array | float) -> Array:
    return np.stack(np.broadcast_arrays(*parts), axis=-1)


def _of_joints(limits: Limits, name: str, joints: JointMotion) -> Array:
    """(m,) a limit that is set."""
    limit = limits.of_joints(name, joints.first.shape[-1])
    assert limit is not None
    return limit


def _acceleration(joints: JointMotion, along: tuple[Array, ...], limits: Limits) -> Array | None:
    if (limit := limits.of_joints("acceleration", joints.first.shape[-1])) is None:
        return None
    first, second = (v[:, None] for v in along[:2])
    none = np.zeros_like(joints.first)
    parts = (joints.first * first / limit, (joints.first * second + joints.second * first**2) / limit)
    return _columns(*parts, none, none, none, none)


def _jerk(joints: JointMotion, along: tuple[Array, ...], limit: Array) -> Array:
    first, second, third = (v[:, None] for v in along)
    by_w = 3.0 * (joints.first * second + joints.second * first**2)
    by_x = joints.first * third + 3.0 * joints.second * first * second + joints.third * first**3
    return _columns(joints.first * first, by_w, by_x) / limit[:, None]


def _most(joints: JointMotion, along: tuple[Array, ...], tangent: Array, limits: Limits) -> Array:
    """(g,) of x; without bound where nothing moves, at both ends."""
    used = np.abs(joints.first) / _of_joints(limits, "speed", joints)
    fastest = used.max(axis=-1)
    if limits.tool_speed is not None:
        fastest = np.maximum(fastest, np.linalg.norm(tangent, axis=-1) / limits.tool_speed)
    with np.errstate(divide="ignore"):
        return (fastest * along[0]) ** -2.0


def _tool(tangent: Array, bend: Array, along: tuple[Array, ...], cap: float | None) -> Array:
    if cap is None:
        return np.empty((tangent.shape[0], 0, 3))
    by_w = tangent * along[0][:, None] / cap
    by_x = (tangent * along[1][:, None] + bend * along[0][:, None] ** 2) / cap
    return _columns((by_w**2).sum(axis=-1), 2.0 * (by_w * by_x).sum(axis=-1), (by_x**2).sum(axis=-1))[:, None]


def _torque(
    robot: Mechanism,
    payload: float,
    derivatives: tuple[Array, ...],
    along: tuple[Array, ...],
    joints: JointMotion,
    limits: Limits,
) -> Array | None:
    """(g, m, 4): by w, by x, by the rate and constant; None where nothing limits it."""
    if limits.torque is None and limits.stall_torque is None and limits.rms_torque is None:
        return None
    rate = _usual_rate(joints, along, limits)
    first, second = (v[:, None] for v in along[:2])
    size = float(np.abs(first).max()), float(np.abs(second).max())
    parts: AlongPath = torque_along(robot, payload, derivatives, size[0] * rate, size[1] * rate**2)
    by_x = parts.inertia * second + parts.centrifugal * first**2
    return _columns(parts.inertia * first, by_x, parts.viscous * first, parts.constant)


def _usual_rate(joints: JointMotion, along: tuple[Array, ...], limits: Limits) -> float:
    """About the rate of a motion that keeps speed and jerk [1/s]."""
    used = np.abs(joints.first) * along[0][:, None] / _of_joints(limits, "speed", joints)
    jerk = np.abs(_jerk(joints, along, _of_joints(limits, "jerk", joints))[..., 2])
    return min(1.0 / float(used.max()), float(jerk.max()) ** (-1 / 3))


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


def _torque_rows(
    robot: Mechanism, limits: Limits, torque: Array, joints: JointMotion, along: tuple[Array, ...], both: Array
) -> list[Array]:
    """(g, m, 6) for the peak torque, for the speed-torque line, or both."""
    count = joints.first.shape[-1]
    friction = robot.inertia.drive_train.of_actuators("coulomb", count)
    known = robot.inertia.drive_train.friction(joints.first)[0]
    *rates, constant = (torque[..., k] for k in range(4))
    constant = np.where(both, constant - known, constant)
    either = np.where(both, friction, 0.0)
    peak, stall, fastest = (limits.of_joints(name, count) for name in ("torque", "stall_torque", "no_load_speed"))
    rows = []
    for limit, line in ((peak, 0.0), (stall, 0.0 if fastest is None else 1.0 / fastest)):
        if limit is not None:
            slope = np.abs(joints.first) * along[0][:, None] * line
            rows.append(_columns(*(v / limit for v in (*rates, constant)), slope, either / limit))
    return rows


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
    return min(least, float(jerk) ** (-1 / 3), math.inf if tool == 0.0 else float(tool) ** -0.25)
