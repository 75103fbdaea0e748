"""The shapes at a pose, and the box that they sweep."""

import numpy as np
import pytest

from kinematics import Heli4, placed_shapes, swept_box
from kinematics.robots.registry import MECHANISMS


def test_the_tubes_of_an_arm_run_where_its_line_is_drawn():
    robot = Heli4()
    pose = robot.home + np.array([0.05, -0.03, 0.02, 0.4])
    lines = robot.polylines(pose)
    arms = [shape for shape in placed_shapes(robot, pose) if shape.member.startswith("arm") and shape.around > 0.02]
    assert [shape.kind for shape in arms] == ["arm"] * 4
    for k, shape in enumerate(arms):
        np.testing.assert_allclose(shape.corners, lines[f"arm {k + 1}"], atol=1e-14)


@pytest.mark.parametrize("kind", list(MECHANISMS.values()), ids=list(MECHANISMS))
def test_the_swept_box_is_the_smallest_around_all_that_moves_at_the_poses(kind):
    robot, rng = kind(), np.random.default_rng(2)
    poses = robot.home + 0.03 * rng.uniform(-1, 1, (5, len(robot.pose_names)))
    placed = [placed_shapes(robot, pose) for pose in poses]
    moving = {a.member for a, b in zip(*placed[:2], strict=True) if not np.array_equal(a.corners, b.corners)}
    members = [shape for own in placed for shape in own if shape.member in moving]
    low = np.min([shape.corners.min(axis=0) - shape.around for shape in members], axis=0)
    high = np.max([shape.corners.max(axis=0) + shape.around for shape in members], axis=0)
    np.testing.assert_allclose(swept_box(robot, poses), [low, high], atol=1e-12)
