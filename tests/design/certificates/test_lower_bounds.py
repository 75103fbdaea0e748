"""The bound of a box is never above the claims of a pose in it: what is false by little is proved on no box."""

from __future__ import annotations

import numpy as np
import pytest

from design import Box
from design.certificates import LowerBounds
from design.claims import Statement
from kinematics import MECHANISMS, Mechanism
from tests.sizes import every_mechanism, few_or_many

FALSE_BY = 1e-9


def around_home(robot: Mechanism) -> Box:
    sides = [0.3 if k in robot.rotations else 0.05 for k in range(len(robot.home))]
    return Box(**{n: (h - s, h + s) for n, h, s in zip(robot.pose_names, robot.home.tolist(), sides, strict=True)})


@pytest.mark.parametrize("name", every_mechanism(MECHANISMS))
@few_or_many(300, 20_000)
def test_no_box_is_proved_that_holds_a_pose_where_the_claim_is_false_by_a_billionth(name: str, count: int) -> None:
    robot, rng = MECHANISMS[name](), np.random.default_rng(31)
    region = around_home(robot)
    n, extent = len(robot.home), region.extent(robot.pose_names)
    for margin in ("det_J_x", "det_J_q", "J_q", "fvi", "v_w", "f_w", "reach", "joint_travel"):
        poses = region.from_unit(rng.random((count, n)), robot.pose_names)
        values = robot.margin(margin, poses)
        value = float(np.nanmedian(values))
        bound = robot.margins[margin].bound(value + FALSE_BY * abs(value))
        bounds = LowerBounds(Statement.of(robot, margin, bound), region)
        false = poses[values <= value]
        nearest = false[np.argsort(value - robot.margin(margin, false))][:100]
        boxes = np.concatenate([nearest] * 3)
        low, high = (boxes + s * rng.random(boxes.shape) * extent * 10.0 ** rng.uniform(-12, 0) for s in (-1, 1))
        lowest, _ = bounds.lowest(np.minimum(low, boxes), np.maximum(high, boxes))
        assert len(lowest) > 0
        assert (lowest < 0.0).all(), f"{margin}, seed 31"


@pytest.mark.parametrize("name", every_mechanism(MECHANISMS))
def test_a_pose_where_the_claim_holds_by_a_billionth_is_proved(name: str) -> None:
    robot, rng = MECHANISMS[name](), np.random.default_rng(32)
    region = around_home(robot)
    for margin in ("det_J_x", "J_q", "fvi"):
        poses = region.from_unit(rng.random((200, len(robot.home))), robot.pose_names)
        values = robot.margin(margin, poses)
        value = float(np.nanmedian(values))
        bounds = LowerBounds(Statement.of(robot, margin, robot.margins[margin].bound(value)), region)
        true = poses[values > value * (1 + FALSE_BY)]
        assert (bounds.lowest(true, true)[0] >= 0.0).all(), f"{margin}, seed 32"
