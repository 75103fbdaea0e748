"""What the limits allow along a path, bounded over intervals of the arc length.

With u = s'' and x = s'^2 each limit of torque, joint acceleration or tool acceleration is |a u + b x + c| <= 1, where
a, b and c are functions of s. The rate w = b - a' / 2, a dash for the derivative by s, is what remains of b when a row
is averaged over an interval: a u = a x' / 2 = (a x)' / 2 - a' x / 2.

Over an interval with middle m and half length r, a coefficient f is within f(m) +- r max |f'|. Interval arithmetic,
rounded outward, bounds f' from bounds of the path's derivatives.
"""

from __future__ import annotations

import math
from functools import lru_cache

import casadi as ca
import numpy as np

from kinematics import (
    Array,
    BlockProgram,
    BoxProgram,
    Mechanism,
    Program,
    bulk,
    derivatives_along,
    enclose,
    evaluate,
    torques,
)
from trajectory.limits import IntervalRows, Limits, OverIntervals, SlopesOverIntervals
from trajectory.paths import Path, places

_DIRECTIONS = 16  # directions over half a turn in which the tool's acceleration is bounded
_MOVING = 0.5  # the length of a tangent is 1, or 0 where the tool turns in place
_SLACK = 1e-12  # relative and absolute: far more than the error of evaluation in double arithmetic


def interval_rows(
    robot: Mechanism, path: Path, limits: Limits, payload: float, edges: Array
) -> tuple[IntervalRows, Array]:
    """The rows, and the largest x that the limits of speed allow (k,) [m^2/s^2], between neighbouring edges (k + 1,).

    Args:
        robot, path, limits, payload: as for `lower_bound`.
        edges: increasing arc lengths from 0 to the path's length [m], the path's knots among them.
    """
    count, half = len(robot.joint_names), np.diff(edges)[:, None] / 2
    middle, low, high = _path_boxes(path, edges)
    values, slopes = _programs(robot)
    (found,) = evaluate(values, *middle, np.full((len(half), 1), payload))
    (ends,) = evaluate(values, *path.evaluate(edges, 2), np.full((edges.size, 1), payload))
    steepest = np.abs(enclose(slopes, *(np.insert(v, v.shape[1], payload, axis=1) for v in (low, high)))).max(axis=0)
    radius = np.nan_to_num(steepest * half, nan=np.inf) + _SLACK * (1.0 + np.abs(found))

    def ball(part: int) -> tuple[Array, Array]:
        columns = slice(part * count, (part + 1) * count)
        return found[:, columns], radius[:, columns]

    def at_ends(part: int) -> tuple[Array, Array]:
        columns = slice(part * count, (part + 1) * count)
        return ends[:-1, columns], ends[1:, columns]

    first, second, none = ball(4), ball(5), np.zeros_like(ball(0)[0])
    moving = np.linalg.norm(middle[1][:, : places(path.pose_names)], axis=-1) > _MOVING
    least = SlopesOverIntervals(np.maximum(np.abs(first[0]) - first[1], 0.0), moving)
    bounds = [limit.highest_over_intervals(least, limits) for limit in limits]
    highest = np.min([most for most in bounds if most is not None], axis=0)

    def torque() -> IntervalRows:
        constant = _with_friction(robot, ball(2), first, highest)
        return IntervalRows(*at_ends(0), *ball(0), *ball(1), *constant, *ball(3))

    acceleration = IntervalRows(*at_ends(4), *first, *second, none, none, *(v / 2 for v in second))
    over = OverIntervals(acceleration, torque, lambda: _tool_rows(path, edges, middle, low, high))
    given = [limit.rows_over_intervals(over, limits) for limit in limits]
    rows = [IntervalRows(*[none[:, :0]] * len(IntervalRows._fields)), *(row for row in given if row is not None)]
    return IntervalRows(*(np.concatenate(part, axis=-1) for part in zip(*rows, strict=True))), highest


def _with_friction(
    robot: Mechanism, constant: tuple[Array, Array], first: tuple[Array, Array], highest: Array
) -> tuple[Array, Array]:
    """The constant part of the torque and its radius, with any friction between rest and the highest speed."""
    drives, count = robot.inertia.drive_train, first[0].shape[1]
    coulomb, viscous = (drives.of_actuators(name, count) for name in ("coulomb", "viscous"))
    if not (coulomb.any() or viscous.any()):
        return constant
    (value, radius), most = constant, viscous * (np.abs(first[0]) + first[1]) * np.sqrt(highest)[:, None]
    turns = np.abs(first[0]) <= first[1]  # the joint may turn back inside the interval
    towards = np.where(turns, 0.0, np.sign(first[0]))
    return value + towards * (coulomb + most / 2), radius + np.where(turns, coulomb + most, most / 2)


def _path_boxes(path: Path, edges: Array) -> tuple[list[Array], Array, Array]:
    """The pose and its first two derivatives in the middle of each interval; bounds of them and of the third."""
    middle = 0.5 * edges[1:] + 0.5 * edges[:-1]
    half = np.maximum(edges[1:] - middle, middle - edges[:-1])[:, None]
    derivatives = path.evaluate(middle, 3)
    steepest, bounds = path.steepest(middle, 4), list[tuple[Array, Array]]()
    for value in derivatives[::-1]:
        away = half * steepest * (1.0 + _SLACK) + _SLACK * (np.abs(value).max() + np.abs(value))
        bounds.insert(0, (value - away, value + away))
        steepest = np.abs(value) + away
    low, high = (np.hstack([bound[side] for bound in bounds]) for side in (0, 1))
    return list(derivatives[:3]), low, high


@lru_cache(maxsize=16)
def _programs(robot: Mechanism) -> tuple[BlockProgram, BoxProgram]:
    """Torque's a, b, c and w and the actuators' first two derivatives by s, (m,) each side by side; their slopes.

    Of the pose, its derivatives by s and the payload.
    """
    model, payload = robot.model(), ca.SX.sym("payload")
    first, second, third = (ca.SX.sym(name, model.pose.shape[0]) for name in ("first", "second", "third"))
    velocity, acceleration = (ca.SX.sym(name, model.pose.shape[0]) for name in ("velocity", "acceleration"))
    tau = torques(robot, payload, velocity, acceleration)
    rates = ca.vertcat(velocity, acceleration)

    def at_rest(expression: ca.SX) -> ca.SX:
        return ca.substitute(expression, rates, ca.SX.zeros(rates.shape[0]))

    state, following = ca.vertcat(model.pose, first, second), ca.vertcat(first, second, third)
    a = at_rest(ca.jtimes(tau, acceleration, first))
    quadratic = ca.jtimes(ca.jtimes(tau, velocity, first), velocity, first) / 2
    b = at_rest(ca.jtimes(tau, acceleration, second) + quadratic)
    w = b - ca.jtimes(a, state, following) / 2
    joints = derivatives_along(model.drives @ model.inverse, model.pose, [first, second])
    values = ca.vertcat(a, b, at_rest(tau), w, *joints[1:])
    slopes = ca.jtimes(values, state, following)
    fixed, inputs = robot.geometry.vector().tolist(), [model.pose, first, second]
    in_numbers = ca.substitute(values, model.geometry, ca.SX(fixed))
    slope = ca.Function("slopes", [*inputs, third, payload, model.geometry], [ca.cse(ca.densify(slopes))])
    return bulk(ca.Function("values", [*inputs, payload], [ca.densify(in_numbers)])), BoxProgram.of(
        Program.of(slope), fixed
    )


def _tool_rows(path: Path, edges: Array, middle: list[Array], low: Array, high: Array) -> IntervalRows:
    """The tool's acceleration along fixed directions of the plane in which the path bends."""
    count, n = places(path.pose_names), len(path.pose_names)
    tangent, bend = (v[:, :count] for v in middle[1:])
    across = bend - (bend * tangent).sum(axis=-1, keepdims=True) * tangent
    across /= np.maximum(np.linalg.norm(across, axis=-1, keepdims=True), 1e-9)  # none where the path is straight
    angles = np.arange(_DIRECTIONS)[:, None] * math.pi / _DIRECTIONS
    towards = np.cos(angles) * tangent[:, None] + np.sin(angles) * across[:, None]
    half = (high - low)[:, None, n:] / 2

    def along(vectors: Array) -> Array:
        result: Array = np.einsum("krp,kp->kr", towards, vectors)
        return result

    def radius(order: int) -> Array:
        part = slice((order - 1) * n, (order - 1) * n + count)
        result: Array = (np.abs(towards) * half[..., part]).sum(axis=-1)
        return result

    (_, ends) = path.evaluate(edges, 1)
    a, b = along(tangent), along(bend)
    none = np.zeros_like(a)
    starts, stops = along(ends[:-1, :count]), along(ends[1:, :count])
    return IntervalRows(starts, stops, a, radius(1), b, radius(2), none, none, b / 2, radius(2) / 2)
