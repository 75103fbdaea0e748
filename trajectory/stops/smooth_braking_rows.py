"""What the limits, jerk among them, leave to the pace of a stop: rows linear in its square and slope.

With x = tau'^2, b = -tau'', c = -b' and v = sqrt(x) by the motion's own time tau, a dash for the derivative by it:

    joint acceleration   -q' b + q'' x
    torque               -i b + k x + d v + a constant,  its parts by the rate (`torque_terms`)
    speed-torque line    +- the torque over its stall, and |q'| v over the no-load speed
    tool acceleration    |-p' b + p'' x|, a disc: its chords, in the cone where x, b >= 0 can be
    joint jerk           v (q' c - 3 q'' b + q''' x)

What is not linear is bounded by what is, from the side of the limit, as in Debrouwere et al., "Time-optimal path
following for robots with convex-concave constraints using sequential convex programming", IEEE T-RO 2013. The jerk is
divided by v: its limit over sqrt(x) is convex, and never below its tangent at any x. v is concave, and never above its
tangent; where it helps it counts as x, which it is not below. Where the tangents are those at x = 1, the motion
itself, x = 1 and b = 0, keeps the rows if it keeps the limits.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Array, Mechanism
from trajectory.limits import Along, Disc, Limits, Linear, Sloped, Third
from trajectory.motions import PoseMotion
from trajectory.stops.braking import along_itself

_CHORDS = 16  # of at most half a circle: they cut off less than 0.5 % of the cap
_STEEPEST = 0.1  # margin by 1 - x
_ROOM = 1e-4  # of a limit, where the motion leaves so much, for what is between the knots
_ROUNDING = 1e-9  # of a limit, and of the largest acceleration


class Rows(NamedTuple):
    """by_x x + by_b b + by_v v <= most at instants of the motion, (..., rows) each."""

    by_x: Array
    by_b: Array
    by_v: Array
    most: Array


class JerkRows(NamedTuple):
    """v |first c - 3 second b + third x| <= 1 with a third anywhere from low to high, (..., m) each."""

    first: Array
    second: Array
    low: Array
    high: Array


class LinearRows(NamedTuple):
    """by_x x + by_b b + by_c c <= most, (..., rows) each."""

    by_x: Array
    by_b: Array
    by_c: Array
    most: Array


def braking_rows(robot: Mechanism, tool: PoseMotion, limits: Limits, payload: float) -> tuple[Rows, JerkRows]:
    """The rows at (n, j) instants of the motion to be stopped, j from end to end of each of its n intervals."""
    along = along_itself(robot, tool, payload)
    rows = _rows(limits, along)
    used = rows.by_x + rows.by_v + 1.0 - rows.most
    rows = rows._replace(by_x=rows.by_x + _highest_around(used) - used)
    jerks = limits.constraints(Third, along)
    first, second, third = (
        np.concatenate(part, axis=-1) for part in zip(*((j.by_z, j.by_u / 3.0, j.by_x) for j in jerks), strict=True)
    )
    return rows, JerkRows(first, second, -_highest_around(-third), _highest_around(third))


def _highest_around(used: Array) -> Array:
    """(n, j, rows) what the motion uses of a limit at most between the instants before and after each of the j."""
    around = np.concatenate([used[:, :1], used, used[:, -1:]], axis=1)
    highest = np.maximum(np.maximum(around[:, :-2], around[:, 2:]), used)
    bend = np.abs(used[:, :-2] - 2.0 * used[:, 1:-1] + used[:, 2:])
    between = highest + np.concatenate([bend[:, :1], bend, bend[:, -1:]], axis=1) / 8.0  # of a parabola
    result: Array = np.maximum(np.minimum(between + _ROOM, 1.0), used)
    return result


def tangent_rows(rows: Rows, jerk: JerkRows, near: Array, middle: Array, margin: float) -> LinearRows:
    """What keeps these rows keeps those of `braking_rows`.

    Args:
        rows, jerk: at (n, j) instants.
        near: (n, j) x at which the tangents are.
        middle: (n,) pace in each interval, at which c makes the jerk.
        margin: share of each limit to keep in hand, all of it where x is well below 1, none where it is 1.
    """
    near, middle = near[..., None], middle[:, None, None]
    v, adds = np.sqrt(near), np.maximum(rows.by_v, 0.0)
    less = np.minimum(margin / np.maximum(1.0 - near, _ROUNDING), _STEEPEST)  # of 1 - x
    by_x = [rows.by_x + adds / (2.0 * v) + np.minimum(rows.by_v, 0.0) - less]
    by_b, by_c, most = (
        [rows.by_b + margin * np.abs(rows.by_b)],
        [np.zeros_like(rows.by_b)],
        [rows.most - adds * v / 2.0 - less],
    )
    for sign, third in ((1.0, jerk.high), (-1.0, -jerk.low)):  # the jerk's rows times v at the tangent
        by_x.append(v * third + 1.0 / (2.0 * near) - less)
        by_b.append(-3.0 * sign * v * jerk.second)
        by_c.append(sign * (1.0 + margin) * middle * jerk.first)
        most.append(np.broadcast_to(1.5 - less, jerk.first.shape))
    return LinearRows(*(np.concatenate(part, axis=-1) for part in (by_x, by_b, by_c, most)))


def _rows(limits: Limits, along: Along) -> Rows:
    speed = along.joints.first
    none, one = np.zeros_like(speed), np.ones_like(speed)
    groups = [Rows(*np.zeros((4, *speed.shape[:-1], 0)))]
    linear = limits.constraints(Linear, along)
    for sign in (1.0, -1.0):
        for row in linear:
            slope = row.slope if isinstance(row, Sloped) else none
            groups.append(
                Rows(sign * row.by_x, -sign * row.by_u, sign * row.by_rate + slope, one - sign * row.constant)
            )
    groups += [_chords(disc.by_u, disc.by_x) for disc in limits.constraints(Disc, along)]
    return Rows(*(np.concatenate(part, axis=-1) for part in zip(*groups, strict=True)))


def _chords(first: Array, second: Array) -> Rows:
    """|-first b + second x| <= 1 between the directions of second and -first; (..., 3) each."""
    along, across = (np.linalg.norm(v, axis=-1)[..., None] for v in (first, second))
    dot, size = -(first * second).sum(axis=-1, keepdims=True), along * across
    angle = np.arccos(np.clip(np.divide(dot, size, out=np.ones_like(dot), where=size > 0.0), -1.0, 1.0))
    towards = (np.arange(_CHORDS) + 0.5) / _CHORDS * angle
    most = np.broadcast_to(np.cos(angle / (2 * _CHORDS)), towards.shape)
    return Rows(across * np.cos(towards), along * np.cos(angle - towards), np.zeros_like(towards), most)
