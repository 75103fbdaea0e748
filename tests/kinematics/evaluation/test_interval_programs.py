"""Whole programs over boxes: they enclose the exact function of the exact geometry, and its gradient."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from kinematics import GoughStewart, Heli4, InvalidValue, Mechanism, Peppermill, Redundant3T1R
from kinematics.evaluation.box_program import BoxProgram
from kinematics.evaluation.interval_interpreter import enclose
from kinematics.evaluation.program import Program, run_through
from tests.arb import OPERATIONS, arb

ROBOTS = [Heli4(), Redundant3T1R(), Peppermill(), GoughStewart()]
NAMES = [type(robot).__name__ for robot in ROBOTS]


def program_of(robot: Mechanism, margin: str) -> Program:
    model = robot.model()
    components = robot.margin_components(margin, robot.fvi_bounds, robot.characteristic_length)
    outputs = ca.cse([ca.densify(components), ca.densify(ca.jacobian(components, model.pose))])
    return Program.of(ca.Function(margin, [model.pose, model.geometry], outputs))


@pytest.mark.parametrize("robot", ROBOTS, ids=NAMES)
@pytest.mark.parametrize("margin", ["det_J_x", "J_q"])
def test_a_program_encloses_arbitrary_precision_at_points_of_random_boxes(robot: Mechanism, margin: str) -> None:
    program, rng = program_of(robot, margin), np.random.default_rng(11)
    boxes = BoxProgram.of(program, robot.geometry.vector())
    middle = np.array(robot.home) + 0.03 * rng.standard_normal((12, len(robot.home)))
    half = 0.02 * rng.random(middle.shape) ** 4
    low, high = enclose(boxes, middle - half, middle + half)
    for k in range(len(middle)):
        point = np.clip(
            middle[k] + half[k] * rng.uniform(-1, 1, middle.shape[1]), *(middle[k] + s * half[k] for s in (-1, 1))
        )
        inputs = [arb(float(v)) for v in (*point, *robot.geometry.vector())]
        for column, value in enumerate(run_through(program, inputs, OPERATIONS)):
            assert not (arb(value) < arb(low[k, column])), f"seed 11, box {k}, output {column}"
            assert not (arb(value) > arb(high[k, column])), f"seed 11, box {k}, output {column}"


@pytest.mark.parametrize("robot", ROBOTS, ids=NAMES)
def test_at_a_point_the_bounds_close_on_the_margin(robot: Mechanism) -> None:
    boxes = BoxProgram.of(program_of(robot, "fvi"), robot.geometry.vector())
    poses = np.array(robot.home) + 0.01 * np.random.default_rng(5).standard_normal((500, len(robot.home)))
    low, high = enclose(boxes, poses, poses)
    count = robot.margin_components("fvi", robot.fvi_bounds, robot.characteristic_length).numel()
    value = robot.margin("fvi", poses)
    assert (low[:, :count].min(axis=1) <= value * (1 + 1e-12)).all()
    assert (high[:, :count].min(axis=1) >= value * (1 - 1e-12)).all()
    assert (high - low)[:, :count].max() < 1e-9 * value.max()


def test_bounds_of_a_wider_box_hold_those_of_a_narrower_one() -> None:
    boxes = BoxProgram.of(program_of(ROBOTS[0], "det_J_x"), ROBOTS[0].geometry.vector())
    home, rng = np.array(ROBOTS[0].home), np.random.default_rng(2)
    inner = np.sort(home + 0.02 * rng.standard_normal((2, 300, 4)), axis=0)
    outer = inner + 0.01 * rng.random((2, 300, 4)) * np.array([-1.0, 1.0])[:, None, None]
    low, high = enclose(boxes, *inner)
    least, most = enclose(boxes, *outer)
    assert (least <= low).all()
    assert (most >= high).all()


def test_out_of_reach_nothing_is_bounded() -> None:
    robot = Heli4()
    boxes = BoxProgram.of(program_of(robot, "det_J_x"), robot.geometry.vector())
    low, high = enclose(boxes, np.array([[0.0, 0.0, -2.0, 0.0]]), np.array([[0.01, 0.01, -0.7, 0.01]]))
    assert np.isinf(low).all()
    assert np.isinf(high).all()


def test_constants_that_follow_from_the_geometry_are_intervals_around_the_exact_number() -> None:
    x, g = ca.SX.sym("x"), ca.SX.sym("g", 2)
    program = BoxProgram.of(Program.of(ca.Function("f", [x, g], [x * (g[0] / g[1])])), [1.0, 3.0])
    low, high = enclose(program, np.ones((1, 1)), np.ones((1, 1)))
    assert arb(low[0, 0]) < arb(1) / 3 < arb(high[0, 0])
    assert high[0, 0] - low[0, 0] < 1e-15


def test_a_product_with_zero_hides_no_undefined_factor() -> None:
    x, g = ca.SX.sym("x"), ca.SX.sym("g")
    program = BoxProgram.of(Program.of(ca.Function("f", [x, g], [g * ca.sqrt(x)])), [0.0])
    low, high = enclose(program, np.array([[-1.0]]), np.array([[1.0]]))
    assert np.isinf([low, high]).all()


def test_no_instruction_writes_where_it_reads() -> None:
    program = BoxProgram.of(program_of(ROBOTS[3], "det_J_x"), ROBOTS[3].geometry.vector())
    binary = (program.op > 3) & (program.op < 27)
    assert not (binary & ((program.target == program.left) | (program.target == program.right))).any()


def test_too_many_fixed_inputs_or_nan_are_refused() -> None:
    x = ca.SX.sym("x")
    program = Program.of(ca.Function("f", [x], [x]))
    for fixed in ([1.0, 2.0], [np.nan]):
        with pytest.raises(InvalidValue):
            BoxProgram.of(program, fixed)
