"""What refutes an isotropic bound: rows at least 0 for any witness where it is kept; below 0 for the best one."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from kinematics import MECHANISMS, ClaimSymbols
from tests.sizes import every_mechanism

CLOSE = 1e-8


@pytest.mark.parametrize("margin", ["fvi", "f_w", "v_w"])
@pytest.mark.parametrize("name", every_mechanism(MECHANISMS))
def test_the_best_witness_tells_a_bound_a_hundred_millionth_too_high_and_no_witness_tells_a_true_one(
    name: str, margin: str
) -> None:
    robot, rng, claim = MECHANISMS[name](), np.random.default_rng(4), ClaimSymbols.fresh()
    model, shown = robot.model(), robot.margins[margin].to_refute(robot, claim)
    poses = robot.home + 0.05 * robot.pose_units() * rng.uniform(-1, 1, (30, len(robot.home)))
    poses = poses[np.isfinite(robot.inverse(poses)).all(axis=1)]
    geometry, values = robot.geometry.vector(), robot.margin(margin, poses)
    given = [model.pose, model.geometry, claim.vector]
    rows = ca.Function("rows", [ca.vec(shown.scaling), *given], [shown.expressions])
    matrix = None if shown.matrix is None else ca.Function("matrix", given, [shown.matrix])
    assert len(poses) > 10
    for pose, value in zip(poses, values, strict=True):
        for bound, kept in ((value * (1 - CLOSE), True), (value * (1 + CLOSE), False)):
            at = pose, geometry, ClaimSymbols.values(bound, robot.fvi_bounds, robot.characteristic_length)
            best = np.zeros(0) if matrix is None else shown.chosen(np.array(matrix(*at))[None])[0].T.ravel()
            assert bool(np.array(rows(best, *at)).min() >= 0.0) is kept, "seed 4"
            if kept:
                assert np.array(rows(rng.normal(size=len(best)), *at)).min() >= 0.0, "seed 4"
