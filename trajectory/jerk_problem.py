"""The symbolic problem of the jerk-limited law: built once for its size and its limits, solved for any numbers.

The knots stand at given arc lengths, and how long each interval takes is free. So all that depends on the path and
the robot is a number at each knot, exact, and what remains is polynomial. The jerk is linear in each interval, for arcs
on a limit to be followed closely: with speed v and acceleration a at the knots, jerk j where an interval starts and k
where it ends, and its duration h (all over powers of the start's duration T and the path's length):

    minimise sum h
    v h + a h^2 / 2 + j h^3 / 8 + k h^3 / 24 = ds,    v + a h + j h^2 / 3 + k h^2 / 6 = v+,    a + (j + k) h / 2 = a+
    joint acceleration   q' a + q'' v^2
    torque               A a + B v^2 + D v + C
    speed-torque line    +- torque + |q'| v / no-load speed
    tool acceleration    |p'|^2 a^2 + 2 p'.p'' a v^2 + |p''|^2 v^4
    joint jerk           q' j + 3 q'' v a + q''' v^3, at both ends of each interval
    RMS torque           sum of each interval's integral of tau^2, a parabola there, - (its limit)^2 sum h

All but the jerk is limited in the middle of each interval's time too: between the knots alone, the acceleration would
bulge. Where on the path a middle is, the start says; solving again from the answer makes that exact. Jumps of the jerk
from one interval to the next cost a trifle: under a limit of the RMS torque alone the time hardly depends on them, and
the search would not end.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from trajectory.path import Array

_OPTIONS: dict[str, Any] = {
    "print_level": 0,
    "sb": "yes",
    "max_iter": 150,
    "tol": 1e-9,
    "constr_viol_tol": 1e-11,
    "acceptable_iter": 0,  # no answer that is almost one
    "bound_relax_factor": 0.0,
}
_CLOSE: dict[str, Any] = {"mu_init": 1e-4, "bound_push": 1e-3}  # a start that is close to the answer
_JUMPS = 1e-6  # of the duration, about: what jumps of the jerk cost, where no limit says what it is
_PUSHES = ("bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac", "mult_bound_push")
_WARM: dict[str, Any] = {  # the answer of almost the same problem, with its multipliers
    "mu_init": 1e-8,
    "warm_start_init_point": "yes",
    **{f"warm_start_{push}": 1e-9 for push in _PUSHES},
}


@dataclass(frozen=True)
class Shape:
    """What the problem's expressions depend on.

    Attributes:
        intervals, joints: how many.
        kept: names of the limited quantities, as `usage.uses` calls them; speeds need no name.
    """

    intervals: int
    joints: int
    kept: frozenset[str]


class Row(NamedTuple):
    """A limited expression: its quantity, and where its entries stand: stations, middles, start, end or whole."""

    quantity: str
    place: str
    joint: int
    expression: ca.SX


class Variables(NamedTuple):
    """The variables: v and a (n + 1,); j, k and h (n,)."""

    speed: Any
    acceleration: Any
    jerk: Any
    last_jerk: Any
    step: Any

    @classmethod
    def split(cls, values: Array) -> Variables:
        """From the vector of all."""
        n = (values.size - 2) // 5
        return cls(*np.split(values, [n + 1, 2 * n + 2, 3 * n + 2, 4 * n + 2]))


class Solver(NamedTuple):
    """The solver from a start, the one from an answer, their parameters in order, and the rows that follow the 3 n
    equations."""

    from_start: ca.Function
    from_answer: ca.Function
    parameters: tuple[str, ...]
    rows: tuple[Row, ...]

    def parameter(self, numbers: Mapping[str, Array]) -> Array:
        """The vector of all parameters, column by column."""
        return np.concatenate([np.asarray(numbers[name]).ravel(order="F") for name in self.parameters])


@lru_cache(maxsize=16)
def solver_of(shape: Shape) -> Solver:
    """The solver for a shape; the second time at once."""
    n, symbols = shape.intervals, _Symbols(shape)
    x = Variables(*(ca.SX.sym(name, n + (k < 2)) for k, name in enumerate(Variables._fields)))
    v, a, j, k, h = x.speed[:-1], x.acceleration[:-1], x.jerk, x.last_jerk, x.step
    middle_speed = v + h * (a / 2 + h * (5 * j + k) / 48)
    middle_acceleration = a + h * (3 * j + k) / 8
    rows = [Row("speed", "middles", 0, middle_speed)]
    rows += _rows(shape, symbols, x, _stations(x.speed, middle_speed), _stations(x.acceleration, middle_acceleration))
    equations = [
        n * (v * h + a * h**2 / 2 + (3 * j + k) * h**3 / 24 - symbols("ds", n, 1)),
        v + a * h + (2 * j + k) * h**2 / 6 - x.speed[1:],
        a + (j + k) * h / 2 - x.acceleration[1:],
    ]
    nlp = {
        "x": ca.vertcat(*x),
        "p": ca.veccat(*symbols.made.values()),
        "f": ca.sum1(h) + _JUMPS * ca.dot(h[1:], ((j[1:] - k[:-1]) * h[1:]) ** 2),
        "g": ca.vertcat(*equations, *(row.expression for row in rows)),
    }
    first = _ipopt(nlp, _CLOSE)
    derivatives = {name: first.get_function(f"nlp_{name}") for name in ("grad_f", "jac_g", "hess_l")}
    derivatives["hess_lag"] = derivatives.pop("hess_l")
    return Solver(first, _ipopt(nlp, _WARM, **derivatives), tuple(symbols.made), tuple(rows))


def _ipopt(nlp: dict[str, ca.SX], start: dict[str, Any], **more: Any) -> ca.Function:
    options: dict[str, Any] = {
        "print_time": False,
        "error_on_fail": False,
        "show_eval_warnings": False,  # a singular pose has no finite numbers; the status says so
        "ipopt": _OPTIONS | start,
        **more,
    }
    return ca.nlpsol("jerk_law", "ipopt", nlp, options)


def _stations(knots: ca.SX, middles: ca.SX) -> ca.SX:
    """(2 n + 1,) in order of time."""
    return ca.vertcat(ca.vec(ca.horzcat(knots[:-1], middles).T), knots[-1])


class _Symbols:
    """The parameters by name, made at first use."""

    def __init__(self, shape: Shape) -> None:
        self.stations, self.joints = 2 * shape.intervals + 1, shape.joints
        self.made: dict[str, ca.SX] = {}

    def __call__(self, name: str, rows: int | None = None, columns: int | None = None) -> ca.SX:
        size = (self.stations if rows is None else rows, self.joints if columns is None else columns)
        return self.made.setdefault(name, ca.SX.sym(name, *size))


def _rows(shape: Shape, at: _Symbols, x: Variables, v: ca.SX, a: ca.SX) -> list[Row]:
    """With speed and acceleration (2 n + 1,) at the stations."""
    rows = []
    if "tool acceleration" in shape.kept:
        square = at("tool_aa", None, 1) * a**2 + at("tool_av", None, 1) * a * v**2 + at("tool_vv", None, 1) * v**4
        rows.append(Row("tool acceleration", "stations", 0, square))
    for k in range(shape.joints):
        if "joint acceleration" in shape.kept:
            own = at("acceleration_a")[:, k] * a + at("acceleration_v")[:, k] * v**2
            rows.append(Row("joint acceleration", "stations", k, own))
        if "joint jerk" in shape.kept:
            by_j, by_va, by_vvv = (at(f"jerk_{name}", shape.intervals + 1)[:, k] for name in ("j", "va", "vvv"))
            smooth = by_va * x.speed * x.acceleration + by_vvv * x.speed**3
            rows.append(Row("joint jerk", "start", k, smooth[:-1] + by_j[:-1] * x.jerk))
            rows.append(Row("joint jerk", "end", k, smooth[1:] + by_j[1:] * x.last_jerk))
        if shape.kept & {"torque", "torque at speed", "rms torque"}:
            rows += _torque_rows(shape, at, x.step, v, a, k)
    return rows


def _torque_rows(shape: Shape, at: _Symbols, step: ca.SX, v: ca.SX, a: ca.SX, k: int) -> list[Row]:
    by_a, by_vv, by_v, constant = (at(f"torque_{name}")[:, k] for name in ("a", "vv", "v", "rest"))
    torque = by_a * a + by_vv * v**2 + by_v * v + constant
    rows = []
    if "torque" in shape.kept:
        rows.append(Row("torque", "stations", k, torque))
    if "torque at speed" in shape.kept:
        line, speed = at("line")[:, k] * torque, at("line_speed")[:, k] * v
        rows += [Row("torque at speed", "stations", k, side) for side in (speed + line, speed - line)]
    if "rms torque" in shape.kept:
        here, middle, following = torque[: 2 * shape.intervals : 2], torque[1::2], torque[2::2]
        ends = 4 * here**2 - 2 * here * following + 4 * following**2
        square = ca.dot(step, ends + 4 * (here + following) * middle + 16 * middle**2) / 30
        rows.append(Row("rms torque", "whole", k, at("rms", 1, None)[k] * square - ca.sum1(step)))
    return rows
