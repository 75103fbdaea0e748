"""Corners from a tenth of a leg down to far below what a machine can make: each is timed, and well."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics import Heli4, inverse_dynamics
from tests.sizes import later
from trajectory import Limits, Part, RoundedPath, TimedPath, jerk_limited, pieces, repair, time_optimal
from trajectory.laws.jerk import refinement

LIMITS = Limits(speed=5.0, acceleration=200.0, jerk=1e4, torque=300.0)
POSES = ((-0.1, 0.0, -0.75, 0.0), (0.05, 0.02, -0.7, 0.4), (0.1, -0.03, -0.8, -0.2))


def cornered(robot: Heli4, *blends: float, poses: tuple[tuple[float | None, ...], ...] = POSES) -> RoundedPath:
    return RoundedPath(robot.pose_names, poses, blends)


def with_a_rest(robot: Heli4, path: RoundedPath) -> float:
    """Duration on a path of one corner with a rest in its middle."""
    (middle,) = path.knots[2:-2]
    halves = Part(path, 0.0, middle), Part(path, middle, path.length)
    return sum(jerk_limited(robot, half, LIMITS, 0.5).duration for half in halves)


@pytest.mark.parametrize("blend", [later(1e-9), 4e-8, later(1e-6)])
def test_a_tiny_corner_is_passed_within_every_limit_sooner_than_with_a_rest_in_it(robot: Heli4, blend: float) -> None:
    path = cornered(robot, blend)
    found = repair(robot, jerk_limited(robot, path, LIMITS, 0.5), LIMITS, 0.5)
    assert found.factor < 1.001
    assert found.motion.duration < with_a_rest(robot, path)


def test_a_corner_too_short_for_the_arc_length_to_tell_is_a_stop(robot: Heli4) -> None:
    stop, tiny = cornered(robot, 0.0), cornered(robot, 1e-11)
    assert tiny.stops == stop.stops
    assert [part.length for part in pieces(tiny)] == [part.length for part in pieces(stop)]


def test_where_a_search_does_not_converge_a_motion_rests_in_a_tiny_corner(
    robot: Heli4, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, parts = cornered(robot, 1e-7), []

    def on_halves_alone(task: refinement.TimingTask, intervals: int) -> refinement.Answer:
        parts.append(task.path)
        if task.path is path:
            refinement.refuse(*task, intervals)
        return refinement.fastest(task, intervals)

    monkeypatch.setattr("trajectory.laws.jerk.law.fastest", on_halves_alone)
    found = jerk_limited(robot, path, LIMITS, 0.5)
    assert len(parts) == 3
    assert isinstance(found, TimedPath)
    assert repair(robot, found, LIMITS, 0.5).factor < 1.001
    middle = np.argmin(np.abs(found.law.position - parts[1].length))
    assert found.law.speed[middle] == 0.0


def test_where_nothing_else_is_found_a_motion_rests_in_the_middle(
    robot: Heli4, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = cornered(robot, 0.02)

    def on_halves_alone(task: refinement.TimingTask, intervals: int) -> refinement.Answer:
        if task.path is path:
            refinement.refuse(*task, intervals)
        return refinement.fastest(task, intervals)

    sooner = jerk_limited(robot, path, LIMITS, 0.5)
    monkeypatch.setattr("trajectory.laws.jerk.law.fastest", on_halves_alone)
    found = jerk_limited(robot, path, LIMITS, 0.5)
    assert repair(robot, found, LIMITS, 0.5).factor < 1.001
    assert found.law.speed[np.argmin(np.abs(found.law.position - path.length / 2))] == 0.0
    assert sooner.duration < found.duration < 2.0 * sooner.duration


@pytest.mark.parametrize("count", [later(4), later(6)])
def test_both_laws_time_corners_of_nanometres_beside_wide_ones(robot: Heli4, count: int) -> None:
    rng = np.random.default_rng(23)
    places = rng.uniform((-0.2, -0.2, -0.85), (0.2, 0.2, -0.65), (6, 3)).tolist()
    poses = tuple((*place, angle) for place, angle in zip(places, (0.0, None, 0.3, None, None, 0.5), strict=True))
    blends = (2e-8, 1e-2, 3e-6, 5e-8)[: count - 2]
    path = cornered(robot, *blends, poses=(*poses[: count - 1], poses[-1]))
    without = Limits(speed=5.0, acceleration=200.0, torque=300.0)
    (way,) = path.evaluate(np.linspace(0.0, path.length, 200), 0)
    assert np.abs(inverse_dynamics(robot, 0.5, way, 0 * way, 0 * way)).max() < 300.0
    bound = repair(robot, time_optimal(robot, path, without, 0.5), without, 0.5)
    smooth = repair(robot, jerk_limited(robot, path, LIMITS, 0.5), LIMITS, 0.5)
    assert bound.factor < 1.001
    assert smooth.factor < 1.001
    assert bound.motion.duration < smooth.motion.duration < 2.0 * bound.motion.duration
