"""The symbolic problem of the jerk-limited law: built once for its size and its limits, solved for any numbers.

The knots stand at given arc lengths, and how long each interval takes is free. So all that depends on the path and
the robot is a number at each knot, exact, and what remains is polynomial. With speed v and acceleration a at the knots,
jerk j and duration h of each interval (all over powers of the start's duration T and the path's length):

    minimise sum h
    v h + a h^2 / 2 + j h^3 / 6 = ds,    v + a h + j h^2 / 2 = v+,    a + j h = a+
    joint acceleration   q' a + q'' v^2
    torque               A a + B v^2 + D v + C
    speed-torque line    +- torque + |q'| v / no-load speed
    joint jerk           q' j + 3 q'' v a + q''' v^3, at both ends of each interval
    tool acceleration    |p'|^2 a^2 + 2 p'.p'' a v^2 + |p''|^2 v^4
    RMS torque           sum h (tau^2 + tau tau+ + tau+^2) / 3 - (its limit)^2 sum h
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
    "print_time": False,
    "error_on_fail": False,
    "show_eval_warnings": False,  # a singular pose has no finite numbers; the status says so
    "ipopt": {
        "print_level": 0,
        "sb": "yes",
        "max_iter": 300,
        "tol": 1e-10,
        "constr_viol_tol": 1e-11,
        "acceptable_iter": 0,  # no answer that is almost one
        "bound_relax_factor": 0.0,
        "mu_init": 1e-3,  # the start is close to the answer
    },
}


@dataclass(frozen=True)
class Shape:
    """What the problem's expressions depend on.

    Attributes:
        intervals, joints: how many.
        kept: names of the limited quantities, as `usage.uses` calls them; speeds are bounds and need no row.
    """

    intervals: int
    joints: int
    kept: frozenset[str]


class Row(NamedTuple):
    """A limited expression: its quantity, and where its entries stand: knots, start, end or whole."""

    quantity: str
    place: str
    joint: int
    expression: ca.SX


class Variables(NamedTuple):
    """The variables: v and a (n + 1,), j and h (n,)."""

    speed: Any
    acceleration: Any
    jerk: Any
    step: Any

    @classmethod
    def split(cls, values: Array) -> Variables:
        """From the vector of all."""
        n = (values.size - 2) // 4
        return cls(*np.split(values, [n + 1, 2 * n + 2, 3 * n + 2]))


class Solver(NamedTuple):
    """The solver, its parameters' names in order, and the rows that follow the 3 n equations."""

    function: ca.Function
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
    rows = tuple(_rows(shape, symbols, x))
    v, a, j, h = x.speed[:-1], x.acceleration[:-1], x.jerk, x.step
    equations = [
        n * (v * h + a * h**2 / 2 + j * h**3 / 6 - symbols("ds", n, 1)),
        v + a * h + j * h**2 / 2 - x.speed[1:],
        a + j * h - x.acceleration[1:],
    ]
    nlp = {
        "x": ca.vertcat(*x),
        "p": ca.veccat(*symbols.made.values()),
        "f": ca.sum1(h),
        "g": ca.vertcat(*equations, *(row.expression for row in rows)),
    }
    return Solver(ca.nlpsol("jerk_law", "ipopt", nlp, _OPTIONS), tuple(symbols.made), rows)


class _Symbols:
    """The parameters by name, made at first use."""

    def __init__(self, shape: Shape) -> None:
        self.knots, self.joints = shape.intervals + 1, shape.joints
        self.made: dict[str, ca.SX] = {}

    def __call__(self, name: str, rows: int | None = None, columns: int | None = None) -> ca.SX:
        size = (self.knots if rows is None else rows, self.joints if columns is None else columns)
        return self.made.setdefault(name, ca.SX.sym(name, *size))


def _rows(shape: Shape, at: _Symbols, x: Variables) -> list[Row]:
    v, a, j = x.speed, x.acceleration, x.jerk
    rows = []
    if "tool acceleration" in shape.kept:
        square = at("tool_aa", None, 1) * a**2 + at("tool_av", None, 1) * a * v**2 + at("tool_vv", None, 1) * v**4
        rows.append(Row("tool acceleration", "knots", 0, square))
    for k in range(shape.joints):
        if "joint acceleration" in shape.kept:
            rows.append(
                Row(
                    "joint acceleration", "knots", k, at("acceleration_a")[:, k] * a + at("acceleration_v")[:, k] * v**2
                )
            )
        if "joint jerk" in shape.kept:
            by_j, by_va, by_vvv = (at(f"jerk_{name}")[:, k] for name in ("j", "va", "vvv"))
            smooth = by_va * v * a + by_vvv * v**3
            rows.append(Row("joint jerk", "start", k, smooth[:-1] + by_j[:-1] * j))
            rows.append(Row("joint jerk", "end", k, smooth[1:] + by_j[1:] * j))
        if shape.kept & {"torque", "torque at speed", "rms torque"}:
            rows += _torque_rows(shape, at, x, k)
    return rows


def _torque_rows(shape: Shape, at: _Symbols, x: Variables, k: int) -> list[Row]:
    v, a, h = x.speed, x.acceleration, x.step
    by_a, by_vv, by_v, constant = (at(f"torque_{name}")[:, k] for name in ("a", "vv", "v", "rest"))
    torque = by_a * a + by_vv * v**2 + by_v * v + constant
    rows = []
    if "torque" in shape.kept:
        rows.append(Row("torque", "knots", k, torque))
    if "torque at speed" in shape.kept:
        line, speed = at("line")[:, k] * torque, at("line_speed")[:, k] * v
        rows += [Row("torque at speed", "knots", k, side) for side in (speed + line, speed - line)]
    if "rms torque" in shape.kept:
        here, following = torque[:-1], torque[1:]
        square = ca.sum1(h * (here**2 + here * following + following**2)) / 3
        rows.append(Row("rms torque", "whole", k, at("rms", 1, None)[k] * square - ca.sum1(h)))
    return rows
