"""Every interval operation encloses what arbitrary precision finds, and never bounds what is not defined."""

from __future__ import annotations

import math

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematics import InvalidValue
from kinematics.evaluation.box_program import BoxProgram
from kinematics.evaluation.interval_interpreter import enclose, operate
from kinematics.evaluation.program import Op, Program
from kinematics.evaluation.vector_arctangent import angle
from kinematics.evaluation.vector_sine import LIMIT, sine
from tests.arb import OPERATIONS, arb
from tests.sizes import few_or_many

ALL = (-math.inf, math.inf)
PI = math.pi
MAX, TINY = 1.7976931348623157e308, 5e-324
SPECIAL = [0.0, -0.0, 1.0, -1.0, TINY, -TINY, 2.3e-308, MAX, -MAX, PI / 2, PI, -PI, 3 * PI, 22.0, 1e6]
NUMBERS = st.one_of(
    st.sampled_from(SPECIAL),
    st.floats(-10.0, 10.0),
    st.floats(-1e-3, 1e-3),
    st.floats(allow_nan=False, allow_infinity=False),
)
PART = st.one_of(st.sampled_from([0.0, 0.5, 1.0]), st.floats(0.0, 1.0))
TRIGONOMETRIC = (Op.SIN, Op.COS, Op.ATAN2)
UNARY = (Op.ASSIGN, Op.NEG, Op.SQ, Op.TWICE, Op.SQRT, Op.INV, Op.SIN, Op.COS)
PLAIN = [op for op in OPERATIONS if op not in TRIGONOMETRIC]


@st.composite
def interval_and_point(draw: st.DrawFn, numbers: st.SearchStrategy[float] = NUMBERS) -> tuple[float, float, float]:
    low, high = sorted([draw(numbers), draw(numbers)])
    part = draw(PART)
    return low, high, min(max((1.0 - part) * low + part * high, low), high)


def defined(op: Op, x: float, y: float) -> bool:
    return not ((op is Op.SQRT and x < 0.0) or (op is Op.INV and x == 0.0) or (op is Op.DIV and y == 0.0))


def holds(op: Op, first: tuple[float, float, float], second: tuple[float, float, float]) -> None:
    (a, b, x), (c, d, y) = first, second
    low, high = operate(op, (a, b), (c, d))
    assert low <= high
    if not defined(op, x, y):
        assert (low, high) == ALL
        return
    if op is Op.ATAN2 and x == 0.0 and y <= 0.0:  # on the cut
        assert (low, high) == ALL
        return
    value = OPERATIONS[op](x, y)
    assert not (value < arb(low)), (op, first, second)
    assert not (value > arb(high)), (op, first, second)


@pytest.mark.parametrize("op", PLAIN, ids=lambda op: op.name)
@few_or_many(100, 2000)
def test_an_operation_encloses_the_exact_value(op: Op, count: int) -> None:
    @settings(max_examples=count)
    @given(interval_and_point(), interval_and_point())
    def encloses(first: tuple[float, float, float], second: tuple[float, float, float]) -> None:
        holds(op, first, second)

    encloses()


@pytest.mark.parametrize("op", TRIGONOMETRIC, ids=lambda op: op.name)
@few_or_many(200, 5000)
def test_sine_cosine_and_arctangent_enclose_too(op: Op, count: int) -> None:
    @settings(max_examples=count)
    @given(interval_and_point(), interval_and_point())
    def encloses(first: tuple[float, float, float], second: tuple[float, float, float]) -> None:
        if op is Op.ATAN2 or abs(first[2]) < 1e15:  # arbitrary precision itself loses larger angles
            holds(op, first, second)

    encloses()


@given(st.integers(-300_000, 300_000), st.floats(-1e-9, 1e-9), st.floats(-1e-9, 1e-9))
@settings(max_examples=500)
def test_cosine_near_a_multiple_of_pi_is_enclosed(turns: int, left: float, right: float) -> None:
    low, high = sorted([turns * PI + left, turns * PI + right])
    for point in (low, 0.5 * low + 0.5 * high, high):
        holds(Op.COS, (low, high, point), (0.0, 0.0, 0.0))
        holds(Op.SIN, (low + PI / 2, high + PI / 2, min(point + PI / 2, high + PI / 2)), (0.0, 0.0, 0.0))
    if arb(low) < arb.pi() * turns and arb.pi() * turns < arb(high):
        assert operate(Op.COS, (low, high), (0.0, 0.0))[turns % 2 == 0] == (1.0 if turns % 2 == 0 else -1.0)


@few_or_many(500, 10_000)
def test_the_polynomials_are_as_accurate_as_is_assumed(count: int) -> None:
    @settings(max_examples=count)
    @given(st.floats(-LIMIT, LIMIT), st.floats(-1e3, 1e3).map(lambda v: v + 0.0))
    def accurate(x: float, y: float) -> None:
        assert abs(arb(sine(x, 0.0)) - arb(x).sin()) < 2.0**-50
        assert abs(arb(sine(x, 1.0)) - arb(x).cos()) < 2.0**-50
        if x != 0.0 or y != 0.0:
            assert abs(arb(angle(y, x)) - arb.atan2(arb(y), arb(x))) < 2.0**-50

    accurate()


@given(interval_and_point(st.floats(-1e3, 1e3)))
def test_a_product_with_itself_is_a_square(first: tuple[float, float, float]) -> None:
    low, high, point = first
    least, most = operate(Op.MUL, (low, high), (low, high), same=True)
    assert 0.0 <= least <= point * point * (1 + 1e-15)
    assert most >= point * point * (1 - 1e-15)


@pytest.mark.parametrize(
    ("op", "first", "second"),
    [
        (Op.DIV, (1.0, 2.0), (-1.0, 1.0)),
        (Op.DIV, (1.0, 2.0), (0.0, 1.0)),
        (Op.DIV, (1.0, 2.0), (-1.0, -0.0)),
        (Op.DIV, (0.0, 0.0), (0.0, 0.0)),
        (Op.INV, (-1.0, 1.0), (0.0, 0.0)),
        (Op.SQRT, (-1.0, 4.0), (0.0, 0.0)),
        (Op.SQRT, (-TINY, 4.0), (0.0, 0.0)),
        (Op.MUL, ALL, (0.0, 0.0)),
        (Op.SUB, ALL, ALL),
        (Op.EXP, (0.0, 1.0), (0.0, 0.0)),
        (Op.ATAN2, (-1.0, 1.0), (-2.0, -1.0)),
        (Op.LT, ALL, (0.0, 0.0)),
        (Op.NOT, ALL, (0.0, 0.0)),
        (Op.IF_ELSE_ZERO, ALL, (1.0, 1.0)),
        (Op.IF_ELSE_ZERO, (0.0, 1.0), ALL),
    ],
)
def test_what_is_not_defined_or_not_known_has_no_bounds(op: Op, first: tuple, second: tuple) -> None:  # type: ignore[type-arg]
    assert operate(op, first, second) == ALL


@pytest.mark.parametrize(
    ("op", "first", "second", "found"),
    [
        (Op.LT, (0.0, 1.0), (1.0, 2.0), (0.0, 1.0)),
        (Op.LT, (0.0, 1.0), (1.5, 2.0), (1.0, 1.0)),
        (Op.LT, (1.0, 2.0), (0.0, 1.0), (0.0, 0.0)),
        (Op.LE, (0.0, 1.0), (1.0, 2.0), (1.0, 1.0)),
        (Op.LE, (1.0, 2.0), (0.0, 1.0), (0.0, 1.0)),
        (Op.NOT, (0.0, 0.0), (0.0, 0.0), (1.0, 1.0)),
        (Op.NOT, (-1.0, 1.0), (0.0, 0.0), (0.0, 1.0)),
        (Op.NOT, (0.5, 1.0), (0.0, 0.0), (0.0, 0.0)),
        (Op.IF_ELSE_ZERO, (1.0, 1.0), (2.0, 3.0), (2.0, 3.0)),
        (Op.IF_ELSE_ZERO, (0.0, 0.0), (2.0, 3.0), (0.0, 0.0)),
        (Op.IF_ELSE_ZERO, (0.0, 0.0), ALL, (0.0, 0.0)),
        (Op.IF_ELSE_ZERO, (0.0, 1.0), (2.0, 3.0), (0.0, 3.0)),
    ],
)
def test_a_condition_is_decided_by_its_bounds_or_left_open(
    op: Op, first: tuple[float, float], second: tuple[float, float], found: tuple[float, float]
) -> None:
    assert operate(op, first, second) == found


@pytest.mark.parametrize("op", list(OPERATIONS), ids=lambda op: op.name)
@pytest.mark.parametrize("bad", [ALL, (0.0, math.inf), (-math.inf, 0.0)])
def test_an_infinite_bound_never_disappears(op: Op, bad: tuple[float, float]) -> None:
    """Else 1 / (1 + sqrt(x)^2) would have finite bounds where sqrt(x) has no value."""
    for first, second in ((bad, (1.0, 2.0)), ((1.0, 2.0), bad)):
        if second is bad and op in UNARY:
            continue
        low, high = operate(op, first, second)
        assert math.isinf(low) or math.isinf(high)


@pytest.mark.parametrize("op", PLAIN, ids=lambda op: op.name)
def test_the_ends_of_the_range_of_floats_are_enclosed(op: Op) -> None:
    for x in (MAX, -MAX, TINY, -TINY, 2.3e-308):
        for y in (MAX, -MAX, TINY, -TINY, 2.3e-308, 3.0):
            holds(op, (x, x, x), (y, y, y))
            holds(op, (min(x, y), max(x, y), x), (y, y, y))


def test_overflow_gives_no_bound_and_underflow_a_sound_one() -> None:
    assert operate(Op.MUL, (MAX, MAX), (2.0, 2.0)) == ALL
    assert operate(Op.ADD, (MAX, MAX), (MAX, MAX))[1] == math.inf
    low, high = operate(Op.MUL, (TINY, TINY), (0.5, 0.5))
    assert low <= 0.0
    assert high > 0.0


def test_boxes_with_nan_or_crossed_bounds_are_refused() -> None:
    x = ca.SX.sym("x", 2)
    program = BoxProgram.of(Program.of(ca.Function("f", [x], [x[0] * x[1]])))
    good, bad = np.ones((1, 2)), np.array([[np.nan, 1.0]])
    for low, high in ((bad, good), (good, bad), (2 * good, good), (good[:, :1], good[:, :1])):
        with pytest.raises(InvalidValue):
            enclose(program, low, high)


@pytest.mark.parametrize("op", [Op.SIN, Op.COS], ids=lambda op: op.name)
def test_a_small_box_a_hundred_million_turns_away_is_still_bounded_rightly(op: Op) -> None:
    rng = np.random.default_rng(12)
    for _ in range(400):
        middle = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(5.0, 8.99))
        if rng.random() < 0.5:  # near an extreme or a root
            middle = round(middle / (PI / 2)) * (PI / 2)
        a, b = middle - float(rng.random()) * 0.1, middle + float(rng.random()) * 0.1
        low, high = operate(op, (a, b), (0.0, 0.0))
        assert high - low < 0.25 + 1e-5, "seed 12"
        for x in (a, middle, b, a + 0.3 * (b - a)):
            value = OPERATIONS[op](arb(x), arb(0.0))
            assert arb(low) <= value <= arb(high), "seed 12"
