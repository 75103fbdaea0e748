"""Margins that are made of singular values or of many components: against numpy, and proved over regions."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from design import Box, certify, worst_poses
from kinematics import MECHANISMS, Heli4, Mechanism
from kinematics.mathematics import singular_values
from tests.sizes import few_of

ROBOTS = [mechanism() for mechanism in MECHANISMS.values()]
IDS = [type(robot).__name__ for robot in ROBOTS]
NEW = ("v_w", "f_w", "force_capability", "inverse_condition_number")
CASES = [(robot, margin) for robot in ROBOTS for margin in NEW]


@pytest.mark.parametrize("shape", [(2, 2), (4, 4), (6, 4), (6, 6)])
def test_singular_values_are_numpys_however_far_apart_or_equal_they_are(shape: tuple[int, int]) -> None:
    rng, symbols = np.random.default_rng(17), ca.SX.sym("a", *shape)
    function = ca.Function("singular", [symbols], [singular_values(symbols)])
    spread = np.diag(10.0 ** -np.arange(shape[1]))
    turn = np.linalg.qr(rng.standard_normal(shape))[0]
    for matrix in (rng.standard_normal(shape), turn @ spread, turn, np.zeros(shape), np.ones(shape)):
        found = np.sort(np.array(function(matrix)).ravel())[::-1]
        expected = np.linalg.svd(matrix, compute_uv=False)
        np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-15 * max(expected[0], 1.0), err_msg="seed 17")


@pytest.mark.parametrize("robot", ROBOTS, ids=IDS)
def test_the_inverse_condition_number_is_one_over_numpys(robot: Mechanism) -> None:
    poses = robot.home + 0.05 * np.random.default_rng(18).standard_normal((300, len(robot.pose_names)))
    found, expected = robot.margin("inverse_condition_number", poses), 1.0 / robot.condition_number(poses)
    np.testing.assert_allclose(found, expected, rtol=1e-9, err_msg="seed 18")


@pytest.mark.parametrize(
    ("robot", "margin"),
    few_of(CASES, lambda robot, margin: isinstance(robot, Heli4) or margin == "v_w"),
    ids=[f"{type(robot).__name__}-{margin}" for robot, margin in CASES],
)
def test_it_is_proved_up_to_its_worst_value_and_refuted_beyond(robot: Mechanism, margin: str) -> None:
    home = robot.home + 1e-3 * np.arange(1, len(robot.home) + 1)
    region = Box(**{n: (float(v) - 5e-3, float(v) + 5e-3) for n, v in zip(robot.pose_names, home, strict=True)})
    worst = worst_poses(robot, region, margin, about=300, descents=8).value
    assert certify(robot, region, margin, at_least=0.95 * worst).status == "proved"
    assert certify(robot, region, margin, at_least=1.001 * worst).status == "refuted"
