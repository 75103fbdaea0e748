"""Cycles and moves of robots that hang, stand or lie otherwise than usual: the same as those of their mirror images."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from kinematics import Delta, GoughStewart, Hexa, Mechanism, Planar3PRR, Planar3RPR, Planar3RRR, inverse_dynamics
from tests.sizes import later
from trajectory import Limits, RoundedPath, plan_move, repair, time_optimal

SIX = ("x", "y", "z", "roll", "pitch", "yaw")
KINEMATIC = Limits(speed=5.0, acceleration=100.0)


def cycle_time(robot: Mechanism, poses: list[list[float | None]], blends: list[float], limits: Limits) -> float:
    path = RoundedPath(robot.pose_names, tuple(map(tuple, poses)), tuple(blends))
    return repair(robot, time_optimal(robot, path, limits, 0.2), limits, 0.2).motion.duration


@pytest.mark.parametrize(("kind", "height"), [(Delta, 0.7), later(Hexa, 0.54)])
def test_a_cycle_above_the_drives_takes_as_long_as_its_mirror_image_below(kind: Any, height: float) -> None:
    """Without a torque limit gravity does not matter; elbows stay outward on both sides."""
    angles = [0.0] * (len(kind.pose_names) - 3)
    free: list[float | None] = [None] * len(angles)
    half_width = 0.05 if kind is Delta else 0.03
    times = []
    for side in (1.0, -1.0):
        robot = kind(home=[0.0, 0.0, side * height, *angles])
        poses = [
            [-half_width, 0.0, side * height, *angles],
            [-half_width, 0.0, side * (height + 0.05), *free],
            [half_width, 0.0, side * (height + 0.05), *angles],
        ]
        times.append(cycle_time(robot, poses, [0.02], KINEMATIC))
        limbs = robot.polylines(robot.home)
        for limb in range(1, len(robot.joint_names) + 1):
            foot, elbow = limbs[f"arm {limb}"]
            assert np.linalg.norm(elbow[:2]) > np.linalg.norm(foot[:2])
    assert times[0] == pytest.approx(times[1], rel=1e-9)


def test_a_hexapod_that_hangs_is_timed_as_one_that_stands_and_is_turned_over() -> None:
    """Half a turn about x makes the standing machine the hanging one, its legs in another order."""
    poses: list[list[float | None]] = [
        [-0.05, 0.0, -0.65, 0.0, 0.0, 0.0],
        [-0.05, 0.0, -0.60, None, None, None],
        [0.05, 0.0, -0.60, None, None, None],
        [0.05, 0.0, -0.65, math.radians(5.0), 0.0, math.radians(5.0)],
    ]
    over = [[v if v is None else v * sign for v, sign in zip(p, (1, -1, -1, 1, -1, -1), strict=True)] for p in poses]
    hanging, limits = GoughStewart(home=[0.0, 0.0, -0.65, 0.0, 0.0, 0.0]), Limits(speed=1.0, acceleration=30.0)
    own = cycle_time(hanging, poses, [0.02, 0.02], limits)
    assert own == pytest.approx(cycle_time(GoughStewart(), over, [0.02, 0.02], limits), rel=1e-9)
    assert own == pytest.approx(0.2320, abs=1e-4)


def test_a_move_of_a_hanging_hexapod_stays_below_and_bears_its_weight_upward() -> None:
    robot = GoughStewart(home=[0.0, 0.0, -0.6, 0.0, 0.0, 0.0])
    start, end = robot.home, np.array([0.05, 0.0, -0.65, 0.0, 0.1, 0.1])
    points = plan_move(
        robot, start, end, Limits(speed=0.3, acceleration=3.0, jerk=50.0), 0.0, 1e-3, ("m",) * 6
    ).setpoints
    assert points.pose[0] == pytest.approx(start, abs=1e-12)
    assert points.pose[:, 2].max() < -0.59
    rest = np.zeros(6)
    assert points.torque[0] == pytest.approx(inverse_dynamics(robot, 0.0, start, rest, rest), rel=1e-9)
    assert (points.torque[0] < 0.0).all()  # a leg that hangs is pulled
    above = inverse_dynamics(GoughStewart(), 0.0, np.array([0, 0, 0.6, 0, 0, 0.0]), rest, rest)
    assert points.torque[0] == pytest.approx(-above, rel=1e-9)


@pytest.mark.parametrize("kind", [Planar3RPR, Planar3PRR, Planar3RRR, GoughStewart])
@pytest.mark.parametrize("seed", range(4))
def test_a_move_starts_and_ends_in_the_poses_that_were_asked_for(kind: Any, seed: int) -> None:
    """Between random poses of one aspect, where a forward model from elsewhere may find another mode."""
    rng, usual = np.random.default_rng(seed), kind()
    spread = np.where(np.isin(np.arange(len(usual.pose_names)), usual.rotations), 0.5, 0.12)
    limits = Limits(speed=1.0, acceleration=10.0, jerk=500.0)
    robot = kind(ranges=kind.Ranges(joints=(-10.0, 10.0)))
    moved = 0
    for _ in range(6):
        ends = robot.home + rng.uniform(-1.0, 1.0, (2, len(spread))) * spread
        line = ends[0] + np.linspace(0.0, 1.0, 50)[:, None] * (ends[1] - ends[0])
        if not robot.margin("det_J_x", line).min() > 0.02 or not _passive(robot, line) > 0.02:
            continue
        points = plan_move(robot, *ends, limits, 0.5, 0.004, robot.actuator_units).setpoints
        assert points.pose[[0, -1]] == pytest.approx(ends, abs=1e-8)
        assert np.abs(np.diff(points.pose, axis=0)).max() < 0.1
        moved += 1
    assert moved > 0


def _passive(robot: Mechanism, line: np.ndarray) -> float:
    return float(robot.margin("passive_joint", line).min()) if "passive_joint" in robot.margins else 1.0
