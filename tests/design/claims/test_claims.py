"""The lemmas: the claims hold exactly where the margin reaches the bound, whatever the scaling."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from design.claims import Statement, to_show
from kinematics import MECHANISMS, Bound, ClaimSymbols, Mechanism, Redundant3T1R
from kinematics.evaluation.block_interpreter import bulk, evaluate
from tests.sizes import few_of

ROBOTS = [mechanism() for mechanism in MECHANISMS.values()]
# Whose scaling must be nearly exact: the sum of the moduli beside a diagonal is compared with it.
CLOSE = (
    "inverse_condition_number",
    "stiffness",
    "rotational_stiffness",
    "internal_stiffness",
    "natural_frequency",
    "strength",
)
CASES = [(robot, margin) for robot in ROBOTS for margin in robot.margins]


@pytest.mark.parametrize(
    ("robot", "margin"),
    few_of(CASES, lambda robot, margin: isinstance(robot, Redundant3T1R) or margin in ("J_q", "det_J_x")),
    ids=[f"{type(robot).__name__}-{margin}" for robot, margin in CASES],
)
def test_the_claims_hold_exactly_where_the_margin_reaches_the_bound(robot: Mechanism, margin: str) -> None:
    rng, model, claim = np.random.default_rng(31), robot.model(), ClaimSymbols.fresh()
    home = np.array(robot.home)
    poses = home + 0.06 * rng.standard_normal((400, len(home)))
    values = robot.margin(margin, poses)
    values, poses = values[np.isfinite(values)], poses[np.isfinite(values)]
    assert len(poses) > 100
    bound = max(float(np.median(values)), 1e-6)
    asked = Bound(bound, robot.margins[margin].sense)
    statement = Statement.of(robot, margin, asked)
    claims = to_show(statement, claim, home)
    symbols = [model.pose, ca.vec(claims.scaling), model.geometry, claim.vector]
    function = bulk(ca.Function("claims", symbols, [claims.expressions]))
    tail = statement.numbers
    scaling = np.empty((len(poses), *claims.scaling.shape))
    if claims.matrix is not None:
        at = ca.Function("matrix", [model.pose, model.geometry, claim.vector], [claims.matrix])
        scaling = claims.chosen(np.stack([np.array(at(pose, robot.geometry.vector(), tail)) for pose in poses]))
        n = scaling.shape[-1]  # where the way between segments is one of n columns, only its length is free
        wild = 0.1 * rng.standard_normal((len(poses), n, n))
        if margin == "clearance":
            scaling = scaling @ (np.eye(n) * (1 + wild))
        elif margin not in CLOSE:
            scaling = scaling @ (np.eye(n) + wild)
    columns = [np.broadcast_to(v, (len(poses), len(v))) for v in (robot.geometry.vector(), np.array(tail))]
    (found,) = evaluate(function, poses, np.swapaxes(scaling, 1, 2).reshape(len(poses), -1), *columns)
    clear = np.abs(values - bound) > 1e-9 * max(1.0, bound)
    assert (((found >= 0.0).all(axis=1) == (asked.room(values) >= 0.0)) | ~clear).all(), "seed 31"


@pytest.mark.parametrize("robot", ROBOTS, ids=[type(r).__name__ for r in ROBOTS])
def test_cleared_rows_over_their_divisors_are_the_jacobian(robot: Mechanism) -> None:
    model = robot.model()
    matrix, divisors = robot.cleared_j_x()
    poses = np.array(robot.home) + 0.02 * np.random.default_rng(4).standard_normal((50, len(robot.home)))
    function = bulk(ca.Function("cleared", [model.pose, model.geometry], [matrix, divisors]))
    fixed = np.broadcast_to(robot.geometry.vector(), (50, model.geometry.numel()))
    rows, found = evaluate(function, poses, fixed)
    assert (found > 0.0).all()
    np.testing.assert_allclose(rows / found[..., None], robot.jacobians(poses)[1], rtol=0, atol=1e-13)
