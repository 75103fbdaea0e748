"""The block interpreter against numpy and against CasADi itself, however the poses are cut into blocks and threads."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest

from kinematics import Heli4, InvalidValue
from kinematics.evaluation import block_interpreter, threads
from kinematics.evaluation.block_interpreter import BLOCK, bulk, evaluate
from kinematics.evaluation.program import Op, Program, UnknownOperation, run_through
from tests.kinematics.by_hand import cylinder

X, Y = ca.SX.sym("x"), ca.SX.sym("y")
SPECIAL = [0.0, -0.0, 1.0, -1.0, 0.5, 2.0, np.inf, -np.inf, np.nan, 1e-300, 1e300, 5e-324]
OPERATIONS = {
    Op.ADD: (X + Y, np.add),
    Op.SUB: (X - Y, np.subtract),
    Op.MUL: (X * Y, np.multiply),
    Op.DIV: (X / Y, np.divide),
    Op.NEG: (-X, lambda x, _: -x),
    Op.SQRT: (ca.sqrt(X), lambda x, _: np.sqrt(x)),
    Op.SQ: (X * X, lambda x, _: x * x),
    Op.TWICE: (2 * X, lambda x, _: 2 * x),
    Op.INV: (1 / X, lambda x, _: 1 / x),
    Op.SIN: (ca.sin(X), lambda x, _: np.sin(x)),
    Op.COS: (ca.cos(X), lambda x, _: np.cos(x)),
    Op.ATAN2: (ca.atan2(X, Y), np.arctan2),
    Op.FABS: (ca.fabs(X), lambda x, _: np.abs(x)),
    Op.FMIN: (ca.fmin(X, Y), np.minimum),
    Op.FMAX: (ca.fmax(X, Y), np.maximum),
    Op.ATAN: (ca.atan(X), lambda x, _: np.arctan(x)),
    Op.ACOS: (ca.acos(X), lambda x, _: np.arccos(x)),
    Op.ASIN: (ca.asin(X), lambda x, _: np.arcsin(x)),
    Op.TAN: (ca.tan(X), lambda x, _: np.tan(x)),
    Op.EXP: (ca.exp(X), lambda x, _: np.exp(x)),
    Op.LOG: (ca.log(X), lambda x, _: np.log(x)),
    Op.POW: (X**Y, np.power),
    Op.SIGN: (ca.sign(X), lambda x, _: np.sign(x)),
    Op.LT: (X < Y, lambda x, y: (x < y) * 1.0),
    Op.LE: (X <= Y, lambda x, y: (x <= y) * 1.0),
    Op.NOT: (ca.logic_not(X), lambda x, _: (x == 0) * 1.0),
    Op.IF_ELSE_ZERO: (ca.if_else(X, Y, 0), lambda x, y: np.where(x != 0, y, 0.0)),
}


def test_every_operation_is_tested():
    assert set(OPERATIONS) == set(Op) - {Op.CONST, Op.INPUT, Op.OUTPUT, Op.ASSIGN}


@pytest.mark.parametrize("op", OPERATIONS, ids=lambda op: op.name)
def test_operation_is_numpys_nan_and_infinity_included(op):
    expression, function = OPERATIONS[op]
    rng = np.random.default_rng(int(op))
    pairs = np.array([(a, b) for a in SPECIAL for b in SPECIAL] + [*rng.normal(0, 2, (1000, 2))])
    f = ca.Function("f", [ca.vertcat(X, Y)], [expression])
    program = bulk(f)
    assert op in Program.of(f).op
    with np.errstate(all="ignore"):
        expected = function(*pairs.T)
    found = evaluate(program, pairs)[0][:, 0]
    np.testing.assert_allclose(found, expected, rtol=1e-15, atol=0.0)


def test_constants_copies_and_outputs_that_are_zero_by_structure():
    program = bulk(
        ca.Function("f", [ca.vertcat(X, Y)], [ca.vertcat(X, 3.5, X), ca.SX(2, 2), ca.diag(ca.vertcat(X, Y))])
    )
    found = evaluate(program, np.array([[1.0, 2.0], [np.nan, 5.0]]))
    np.testing.assert_array_equal(found[0], [[1.0, 3.5, 1.0], [np.nan, 3.5, np.nan]])
    np.testing.assert_array_equal(found[1], np.zeros((2, 2, 2)))
    np.testing.assert_array_equal(found[2], [[[1, 0], [0, 2]], [[np.nan, 0], [0, 5]]])


def test_a_whole_model_is_what_casadi_computes():
    robot, poses = Heli4(), cylinder(500, seed=1)
    model = robot.model()
    outputs = [model.inverse, model.inverse_jacobian, robot.internal_determinant_symbolic()]
    function = ca.Function("f", [model.pose, model.geometry], outputs)
    found = robot.inverse(poses), robot.inverse_jacobian(poses), robot.internal_determinant(poses)
    for k, pose in enumerate(poses):
        for ours, theirs in zip(found, function(pose, robot.geometry.vector()), strict=True):
            np.testing.assert_allclose(ours[k], np.squeeze(theirs.full()), rtol=1e-11, atol=1e-13)


def test_replay_over_symbols_gives_the_function_back():
    expressions = [ca.vertcat(ca.sin(X) / Y, ca.fmin(X, Y) - 2 * X, ca.sqrt(ca.fabs(Y))), ca.horzcat(X, X * Y)]
    function = ca.Function("f", [ca.vertcat(X, Y)], expressions)
    program = Program.of(function)
    again = ca.Function("g", [ca.vertcat(X, Y)], [ca.vertcat(*run_through(program, [X, Y]))])
    at = np.array([0.7, -1.3])
    expected = np.concatenate([part.reshape(-1) for part in evaluate(bulk(function), at)])
    np.testing.assert_allclose(again(at).full()[:, 0], expected, rtol=1e-15)


def test_an_unknown_operation_is_refused_by_name():
    with pytest.raises(UnknownOperation, match="function f: CasADi operation"):
        bulk(ca.Function("f", [X], [ca.erf(X)]))


def program():
    """One that uses vector loops and library calls."""
    z = ca.vertcat(X, Y)
    return bulk(ca.Function("f", [z], [ca.vertcat(ca.sin(X) * Y + ca.sqrt(X), ca.atan2(X, Y) / Y, ca.fmax(X * X, Y))]))


TABLE = np.random.default_rng(2).uniform(0.1, 3.0, (5 * BLOCK + 7, 2))


@pytest.mark.parametrize("count", [1, 2, 7, 8, 9, 63, 64, BLOCK - 1, BLOCK, BLOCK + 1, 3 * BLOCK + 5])
def test_no_result_depends_on_where_a_block_ends(count):
    f, last = program(), len(TABLE)
    whole = evaluate(f, TABLE)[0]
    for first in (0, 13, last - count):
        assert np.array_equal(evaluate(f, TABLE[first : first + count])[0], whole[first : first + count])


@pytest.mark.parametrize("number", [1, 2, 3, 7])
def test_no_result_depends_on_the_number_of_threads(monkeypatch, number):
    robot, poses = Heli4(), cylinder(5_003, seed=3)
    expected = robot.fvi(poses), robot.forward(robot.inverse(poses))
    monkeypatch.setattr(threads, "CORES", number)
    monkeypatch.setattr(threads, "_LEAST_PER_THREAD", 10)
    found = robot.fvi(poses), robot.forward(robot.inverse(poses))
    assert all(np.array_equal(a, b) for a, b in zip(expected, found, strict=True))


@pytest.mark.parametrize("count", [0, 1, 5, 4095, 4096, 8192, 100_001])
def test_threads_cover_every_pose_once(monkeypatch, count):
    monkeypatch.setattr(threads, "CORES", 5)
    seen = np.zeros(count, dtype=int)

    def work(span):
        seen[span] += 1

    threads.over_spans(count, work)
    assert (seen == 1).all()


@pytest.mark.parametrize("lead", [(), (1,), (5,), (3, 4), (2, 3, 2), (0,), (2, 0)], ids=str)
def test_leading_shape_is_kept(lead):
    robot = Heli4()
    poses = cylinder(int(np.prod(lead, dtype=int)), seed=4).reshape(*lead, 4)
    joints = robot.inverse(poses)
    assert joints.shape == robot.forward(joints).shape == (*lead, 4)
    assert [j.shape for j in robot.jacobians(poses)] == [(*lead, 4, 4)] * 2
    assert robot.rod_system(poses)[1].shape == (*lead, 8, 8)
    scalars = (
        robot.fvi(poses),
        robot.internal_determinant(poses),
        robot.condition_number(poses),
        *robot.isotropic(poses),
    )
    assert {np.shape(v) for v in scalars} == {lead}
    assert robot.closure_residual(poses, joints).shape == (*lead, 4)


def test_poses_in_any_memory_order_and_as_a_list():
    robot, poses = Heli4(), cylinder(100, seed=5)
    expected = robot.inverse(poses)
    assert np.array_equal(robot.inverse(np.asfortranarray(poses)), expected)
    assert np.array_equal(robot.inverse(np.repeat(poses, 2, axis=0)[::2]), expected)
    assert np.array_equal(robot.inverse(poses.tolist()), expected)


def test_wrong_columns_are_refused_not_read_past_their_end():
    with pytest.raises(InvalidValue, match=r"found \(3,\)"):
        evaluate(program(), np.zeros((5, 3)))


def test_an_operation_that_has_no_loop_gives_nan():
    """`Program.of` lets none through; were one to slip in, it must not look like a number."""
    f = program()
    code = f.code.copy()
    code[code[:, 0] == Op.SIN, 0] = 99
    broken = replace(f, code=code)
    assert np.isnan(block_interpreter.evaluate(broken, TABLE[:3])[0][:, 0]).all()
