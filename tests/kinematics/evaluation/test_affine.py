"""Affine bounds are below the exact function everywhere on a box, and lose only what is of second order in its size."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from kinematics import Array, GoughStewart, Heli4, Hexa, InvalidValue, Mechanism, Peppermill, Planar3RRR
from kinematics.evaluation import BoxProgram, Program, bound_below, enclose, run_through
from tests.arb import OPERATIONS, arb
from tests.sizes import few_or_many

T = ca.SX.sym("t", 3)
UNARY = {
    "square": lambda x, _: x * x,
    "inverse": lambda x, _: 1 / x,
    "root": lambda x, _: ca.sqrt(x),
    "sine": lambda x, _: ca.sin(x),
    "cosine": lambda x, _: ca.cos(x),
    "modulus": lambda x, _: ca.fabs(x),
    "opposite": lambda x, _: -x,
    "double": lambda x, _: 2 * x,
}
BINARY = {
    "sum": lambda x, y: x + y,
    "difference": lambda x, y: x - y,
    "product": lambda x, y: x * y,
    "quotient": lambda x, y: x / y,
    "arctangent": lambda x, y: ca.atan2(x, y),
    "minimum": lambda x, y: ca.fmin(x, y),
    "maximum": lambda x, y: ca.fmax(x, y),
    "branch": lambda x, y: ca.if_else(x < y, x, 0),
}
OPERATION = UNARY | BINARY


def program_of(expression: ca.SX) -> Program:
    return Program.of(ca.Function("f", [T], [ca.densify(expression)]))


def below(program: Program, low: Array, high: Array) -> Array:
    """(k,) lower bounds of the smallest output, all three coordinates moving."""
    return bound_below(BoxProgram.of(program), low, high, np.arange(3))[0]


def exact(program: Program, point: Array) -> list[arb]:
    return [arb(v) for v in run_through(program, [arb(float(v)) for v in point], OPERATIONS)]


def points_of(low: Array, high: Array, rng: np.random.Generator) -> list[Array]:
    """Corners, edges and inner points of one box."""
    parts = np.vstack([rng.integers(0, 2, (4, 3)), rng.integers(0, 3, (3, 3)) / 2, rng.random((3, 3))])
    return [np.clip(low + p * (high - low), low, high) for p in parts]


def boxes_of(rng: np.random.Generator, count: int) -> tuple[Array, Array]:
    """Boxes of sizes from 0 to 2, some with sides of length 0."""
    middle = rng.uniform(-2, 2, (count, 3))
    half = 10.0 ** rng.uniform(-14, 0, (count, 3)) * (rng.random((count, 3)) > 0.1)
    return middle - half, middle + half


@pytest.mark.parametrize("name", OPERATION)
@few_or_many(150, 5000)
def test_no_bound_of_an_operation_is_above_the_exact_value(name: str, count: int) -> None:
    """A plane is taken off, so that the bound shows the form and not only the interval."""
    rng = np.random.default_rng(3)
    low, high = boxes_of(rng, count)
    for k in range(count):
        p, q = (rng.normal(size=4) * 10.0 ** rng.uniform(-3, 1) for _ in range(2))
        x, y = (c[0] + ca.dot(ca.SX(ca.DM(c[1:])), T) for c in (p, q))
        value = OPERATION[name](x, y)
        slopes = np.array(ca.Function("s", [T], [ca.gradient(value, T)])(0.5 * (low[k] + high[k])))[:, 0]
        rest = value - ca.dot(ca.SX(ca.DM(np.nan_to_num(slopes, posinf=0.0, neginf=0.0))), T)
        for program in (program_of(rest), program_of(-rest)):
            bound = below(program, low[k : k + 1], high[k : k + 1])[0]
            for point in points_of(low[k], high[k], rng):
                found = exact(program, point)[0]
                assert not (found < arb(bound)), f"seed 3, box {k} at {point.tolist()}"
                assert found.is_finite() or bound == -np.inf or name == "branch", f"seed 3, box {k}"


@few_or_many(60, 3000)
def test_no_bound_of_a_random_program_is_above_the_exact_value(count: int) -> None:
    rng = np.random.default_rng(8)
    for k in range(count):
        values = [T[0], T[1], T[2], ca.SX(float(rng.normal()))]
        for _ in range(25):
            left, right = (values[int(rng.integers(len(values)))] for _ in range(2))
            values.append(OPERATION[str(rng.choice([*BINARY, *BINARY, *UNARY]))](left, right))
        program = program_of(ca.vertcat(*values[-6:]))
        low, high = boxes_of(rng, 8)
        bounds = below(program, low, high)
        for box in range(8):
            for point in points_of(low[box], high[box], rng):
                for found in exact(program, point):
                    assert not (found < arb(bounds[box])), f"seed 8, program {k}, box {box} at {point.tolist()}"


@pytest.mark.parametrize(
    "robot", [Heli4(), Peppermill(), Planar3RRR(), Hexa(), GoughStewart()], ids=lambda r: type(r).__name__
)
@pytest.mark.parametrize("margin", ["det_J_x", "J_q", "fvi", "reach"])
def test_no_bound_of_a_margin_is_above_a_dense_sample(robot: Mechanism, margin: str) -> None:
    model, rng = robot.model(), np.random.default_rng(21)
    components = robot.margin_components(margin, robot.fvi_bounds, robot.characteristic_length)
    program = BoxProgram.of(
        Program.of(ca.Function("margin", [model.pose, model.geometry], [ca.cse(ca.densify(components))])),
        robot.geometry.vector(),
    )
    n = len(robot.home)
    middle = np.array(robot.home) + 0.03 * rng.standard_normal((200, n))
    half = 0.05 * rng.random((200, n)) ** 4
    bounds, _ = bound_below(program, middle - half, middle + half, np.arange(n))
    poses = middle[:, None] + half[:, None] * np.sin(8 * rng.standard_normal((200, 100, n)))
    least = robot.margin(margin, poses).min(axis=1)
    assert (bounds <= least * (1 + 1e-12) + 1e-15)[~np.isnan(least)].all()
    tight = np.isfinite(bounds) & (half.max(axis=1) < 1e-4)
    assert (bounds >= least - 0.01 * np.abs(least))[tight].all()


@pytest.mark.parametrize("name", ["product", "quotient", "arctangent", "root", "sine", "inverse", "square"])
def test_half_the_box_loses_a_quarter(name: str) -> None:
    """Of f(t) - f's tangent, whose least value is of second order, the bound is too, however often t occurs."""
    value = OPERATION[name](1.3 + T[0] * T[1] - T[2], 0.9 + T[2] + ca.sin(T[0]))
    program = program_of(value - ca.dot(ca.substitute(ca.gradient(value, T), T, ca.DM.zeros(3)), T))
    at_zero = float(exact(program, np.zeros(3))[0].mid())
    sizes = 2.0 ** -np.arange(4, 12)[:, None] * np.ones((1, 3))
    loss = at_zero - below(program, -sizes, sizes)
    assert (loss > 0.0).all()
    assert (np.abs(loss[1:] / loss[:-1] - 0.25) < 0.06).all()


def test_what_two_values_have_in_common_cancels() -> None:
    low, high = np.array([[0.5, -1.0, 2.0]]), np.array([[1.5, 3.0, 2.5]])
    program = program_of(3 * (T[0] + T[1] - T[2]) - 3 * (T[1] - T[2]))
    assert below(program, low, high)[0] == pytest.approx(1.5, abs=1e-12)
    assert enclose(BoxProgram.of(program), low, high)[0][0, 0] < -5.0


def test_a_box_that_is_not_defined_everywhere_has_no_bound() -> None:
    low, high = np.array([[-1.0, 1.0, 1.0]]), np.array([[1.0, 2.0, 2.0]])
    for expression in (ca.sqrt(T[0]), T[1] / T[0], 1 / T[0], ca.atan2(T[0], -T[1]), 1 / (1 + ca.sqrt(T[0]) ** 2)):
        assert below(program_of(expression), low, high)[0] == -np.inf
        assert below(program_of(ca.vertcat(T[1], expression)), low, high)[0] == -np.inf


def test_only_what_may_be_negative_says_what_to_cut() -> None:
    low, high = np.array([[-1.0, 1.0, 1.0]]), np.array([[1.0, 2.0, 3.0]])
    program = BoxProgram.of(program_of(ca.vertcat(T[0] + 0.1 * T[2], T[1], T[2] ** 2)))
    least, moves = bound_below(program, low, high, np.arange(3))
    assert least[0] == pytest.approx(-0.9)
    np.testing.assert_allclose(moves[0], [1.0, 0.0, 0.1], atol=1e-12)


def test_a_column_without_a_slope_is_unknown_within_its_bounds() -> None:
    low, high = np.array([[-1.0, 1.0, 1.0]]), np.array([[1.0, 2.0, 3.0]])
    program = BoxProgram.of(program_of(3 * (T[1] + 1) - 3 * T[1] + T[0] ** 2 - T[2]))
    assert bound_below(program, low, high, np.arange(3))[0][0] == pytest.approx(0.0, abs=1e-12)
    least, moves = bound_below(program, low, high, np.array([0]))
    assert least[0] == pytest.approx(-3.0)
    assert moves.shape == (1, 1)


def test_boxes_with_nan_or_crossed_bounds_are_refused() -> None:
    program, good = BoxProgram.of(program_of(T[0] * T[1])), np.ones((1, 3))
    for low, high in ((np.nan * good, good), (good, np.nan * good), (2 * good, good), (good[:, :2], good[:, :2])):
        with pytest.raises(InvalidValue):
            bound_below(program, low, high, np.arange(3))
