"""What block programs leave out and fuse changes no value but by rounding; sine and cosine against mpmath."""

from functools import partial

import casadi as ca
import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematics import GoughStewart, Heli4, Peppermill, Redundant3T1R
from kinematics.evaluation.block_graph import Block
from kinematics.evaluation.block_interpreter import bulk, evaluate
from kinematics.evaluation.program import Op, Program, run_through
from kinematics.evaluation.vector_sine import LIMIT
from kinematics.mathematics.symbolic_linear_algebra import adjugate, determinant

X, Y, Z, U = (ca.SX.sym(name) for name in "xyzu")
ALL = ca.vertcat(X, Y, Z, U)
FUSED = {
    Block.SCALE: -3.5 * X,
    Block.AFFINE: 2.0 - X / 3,
    Block.SUM: X / 7 - 0.3 * Y,
    Block.PRODUCT: 2 * X * (Y / -5),
    Block.PRODUCT_AFFINE: 0.7 - 3 * X * Y,
    Block.PRODUCT_SUM: X / 3 + (-Y) * Z / 9,
    Block.TWO_PRODUCTS: X * Y * 3 - Z * U / 7,
}
VANISHES = {
    "a - (a - b)": (X - (X - Y), 0),
    "(a + b) - b": ((X + 2 * Y) - 2 * Y, 0),
    "a / l over b / l": ((X / 1.7) / (Y / 1.7), 1),
    "-(-3 a) / 3": (-3.0 * X / -3.0, 0),
    "a b - b a": (X * Y + 3.0 - Y * X, 2),
}


def run(expression, table):
    return evaluate(bulk(ca.Function("f", [ALL], [expression])), table)[0][:, 0]


def plainly(expression, table):
    """Each operation of CasADi's own instructions in numpy, none left out."""
    program = Program.of(ca.Function("f", [ALL], [expression]))
    return np.asarray(run_through(program, list(table.T))[0])


@pytest.mark.parametrize("block", Block, ids=lambda b: b.name)
def test_every_fused_operation_is_what_it_was_fused_from(block):
    program = bulk(ca.Function("f", [ALL], [FUSED[block]]))
    assert program.code[:, 0].tolist() == [block, Op.OUTPUT]
    table = np.random.default_rng(int(block)).normal(size=(300, 4))
    terms = np.abs(table).max(axis=1) ** 2 + 3.0
    assert np.abs((run(FUSED[block], table) - plainly(FUSED[block], table)) / terms).max() < 2e-15


@pytest.mark.parametrize("what", VANISHES)
def test_what_real_numbers_make_superfluous_is_not_computed(what):
    expression, operations = VANISHES[what]
    program = bulk(ca.Function("f", [ALL], [expression]))
    assert (program.code[:, 0] != Op.OUTPUT).sum() <= operations
    table = np.random.default_rng(1).normal(size=(300, 4))
    np.testing.assert_allclose(run(expression, table), plainly(expression, table), rtol=1e-12, atol=1e-12)


NUMBERS = st.sampled_from([0.0, 1.0, -1.0, 0.5, -2.0, 3.0, 0.1, 1e-17, 1e40])
LEAVES = st.sampled_from([X, Y, Z, U]) | NUMBERS.map(ca.SX)


def _grown(children):
    two = st.tuples(st.sampled_from(["+", "-", "*", "/", "min", "max"]), children, children)
    one = st.tuples(st.sampled_from(["neg", "abs", "sqrt", "sq", "twice"]), children)
    return two.map(lambda t: _BINARY[t[0]](t[1], t[2])) | one.map(lambda t: _UNARY[t[0]](t[1]))


_BINARY = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / (1 + b * b),
    "min": ca.fmin,
    "max": ca.fmax,
}
_UNARY = {
    "neg": lambda a: -a,
    "abs": ca.fabs,
    "sqrt": lambda a: ca.sqrt(ca.fabs(a)),
    "sq": lambda a: a * a,
    "twice": lambda a: 2 * a,
}


@given(st.recursive(LEAVES, _grown, max_leaves=25))
@settings(max_examples=150, deadline=None)
def test_any_expression_keeps_its_value_but_for_rounding(expression):
    """Within a running error bound of the plain instructions, in which every operation errs by a few units."""
    table = np.random.default_rng(5).uniform(0.5, 2.0, (64, 4)) * [1, -1, 1, 1]
    program = Program.of(ca.Function("f", [ALL], [expression]))
    operations = {op: partial(_with_error, op) for op in _NUMPY}
    with np.errstate(all="ignore"):
        value, error = _pair(run_through(program, [(column, 0.0 * column) for column in table.T], operations)[0])
        found = run(expression, table)
        usable = np.isfinite(value) & np.isfinite(error)
        assert (np.abs(found - value) <= error)[usable].all()


UNIT = 16 * np.finfo(float).eps


def _pair(value):
    return value if isinstance(value, tuple) else (np.full(64, float(value)), np.zeros(64))


def _with_error(op, a, b):
    (x, e), (y, f) = _pair(a), _pair(b)
    value = _NUMPY[op](x, y)
    if op is Op.MUL:
        error = np.abs(x) * f + np.abs(y) * e + e * f
    elif op is Op.SQ:
        error = 2 * np.abs(x) * e + e * e
    elif op is Op.DIV:
        error = np.where(np.abs(y) > f, (e + np.abs(value) * f) / (np.abs(y) - f), np.inf)
    elif op is Op.INV:
        error = np.where(np.abs(x) > e, e / np.abs(x) / (np.abs(x) - e), np.inf)
    elif op is Op.SQRT:
        error = np.where(e > 0, np.fmin(np.sqrt(e), e / value), 0.0)
    elif op is Op.TWICE:
        error = 2 * e
    else:
        error = e + (f if op in (Op.ADD, Op.SUB, Op.FMIN, Op.FMAX) else 0.0)
    return value, error + UNIT * np.abs(value)


_NUMPY = {
    Op.ASSIGN: lambda a, _: a,
    Op.ADD: np.add,
    Op.SUB: np.subtract,
    Op.MUL: np.multiply,
    Op.DIV: np.divide,
    Op.NEG: lambda a, _: -a,
    Op.SQRT: lambda a, _: np.sqrt(a),
    Op.SQ: lambda a, _: a * a,
    Op.TWICE: lambda a, _: 2 * a,
    Op.INV: lambda a, _: 1 / a,
    Op.FABS: lambda a, _: np.abs(a),
    Op.FMIN: np.minimum,
    Op.FMAX: np.maximum,
}


@pytest.mark.parametrize(
    "robot", [Heli4(), Redundant3T1R(), Peppermill(), GoughStewart()], ids=lambda r: type(r).__name__
)
def test_no_instruction_writes_where_it_reads(robot):
    program = robot.margin_program("fvi")
    code = program.code[program.code[:, 0] != Op.OUTPUT]
    reads = {Op.CONST: 0, Op.SQRT: 1, Op.INV: 1, Op.SIN: 1, Op.COS: 1, Op.FABS: 1, Block.SCALE: 1, Block.AFFINE: 1}
    reads |= {Block.PRODUCT_SUM: 3, Block.TWO_PRODUCTS: 4}
    assert all(row[5] not in row[1 : 1 + reads.get(row[0], 2)] for row in code)


@pytest.mark.parametrize("far", [1e-9, 0.5, 4.0, 1e3, LIMIT, 1e9, 1e300])
def test_sine_and_cosine_are_good_to_two_units_in_the_last_place(far):
    rng = np.random.default_rng(7)
    x = np.concatenate([rng.uniform(-far, far, 1000), [far, -far, 0.0, -0.0]])
    if 1.0 < far <= LIMIT:  # next to the zeros, where a careless reduction has no digits left
        x = np.concatenate([x, np.round(rng.uniform(-far, far, 500) / np.pi) * np.pi, x[:500].round() * np.pi / 2])
    found = evaluate(bulk(ca.Function("f", [X], [ca.sin(X), ca.cos(X)])), x[:, None])
    with mpmath.workprec(1200 if far > 1e9 else 150):
        for ours, exact in zip(found, (mpmath.sin, mpmath.cos), strict=True):
            true = [exact(mpmath.mpf(float(v))) for v in x]
            errors = [
                abs(mpmath.mpf(float(o)) - t) / np.spacing(abs(float(t))) for o, t in zip(ours[:, 0], true, strict=True)
            ]
            assert max(errors) <= 2


def test_sine_of_what_is_no_angle_is_nan():
    found = evaluate(bulk(ca.Function("f", [X], [ca.sin(X), ca.cos(X)])), np.array([[np.nan], [np.inf], [-np.inf]]))
    assert np.isnan(found).all()


def test_where_blanked_one_lost_output_loses_the_pose_and_no_other():
    program = bulk(ca.Function("f", [ca.vertcat(X, Y)], [ca.sqrt(X), ca.SX(2, 2), X * X]))
    table = np.array([[4.0, 0.0], [-1.0, 0.0], [1.0, np.nan], [1.0, np.inf], [9.0, 5.0]])
    root, zeros, square = evaluate(program, table, blank=True)
    lost = [False, True, True, True, False]
    assert np.isnan(root[:, 0]).tolist() == np.isnan(square[:, 0]).tolist() == lost
    assert np.isnan(zeros).all(axis=(1, 2)).tolist() == lost
    assert not zeros[[0, 4]].any()
    np.testing.assert_array_equal(evaluate(program, table)[2][:, 0], [16, 1, 1, 1, 81])


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 6])
@pytest.mark.parametrize("symmetric", [False, True])
def test_determinants_and_adjugates_are_numpys(n, symmetric):
    matrix, rng = ca.SX.sym("a", n, n), np.random.default_rng(n)
    adjugate_, det = adjugate(matrix, symmetric)
    f = ca.Function("f", [matrix], [adjugate_, det, determinant(matrix)])
    for _ in range(5):
        a = rng.normal(size=(n, n))
        a = a + a.T if symmetric else a
        adj, d, d_again = (np.array(v) for v in f(a))
        np.testing.assert_allclose(a @ adj, np.linalg.det(a) * np.eye(n), atol=1e-12 * np.abs(a).max() ** n * 100)
        np.testing.assert_allclose([d.item(), d_again.item()], np.linalg.det(a), rtol=1e-10)
