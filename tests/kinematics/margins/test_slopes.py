"""What the optimisation needs: each margin has slopes by pose and geometry wherever it has a value."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from kinematics import MECHANISMS, Measure
from tests.sizes import later


@pytest.mark.parametrize("name", [n if n in ("Delta", "Peppermill") else later(n) for n in MECHANISMS])
def test_every_component_of_every_margin_has_slopes_where_it_has_a_value(name: str) -> None:
    """At home, where limbs are alike and much is exactly 0, and near it."""
    robot, rng = MECHANISMS[name](), np.random.default_rng(6)
    model, measure = robot.model(), Measure(robot.fvi_bounds, robot.characteristic_length)
    places = rng.uniform(-0.03, 0.03, (3, len(robot.pose_names)))
    for margin in robot.margins.values():
        parts = margin.components(robot, measure)
        slopes = ca.densify(ca.jacobian(parts, ca.vertcat(model.geometry, model.pose)))
        at = ca.Function("at", [model.pose, model.geometry], [parts, slopes])
        for pose in (robot.home, *(robot.home + places)):
            value, slope = (np.array(v) for v in at(pose, robot.geometry.vector()))
            lost = np.isfinite(value[:, 0]) & ~np.isfinite(slope).all(axis=1)
            assert not lost.any(), f"{margin.name} at {pose}, seed 6"
