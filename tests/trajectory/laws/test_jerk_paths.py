"""Paths of many pieces, small corners and short steps under a limit of the jerk: each is timed, and well."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematics import Delta, DriveTrain, GoughStewart, Heli4, Mechanism, inverse_dynamics
from tests.sizes import later
from trajectory import (
    Limits,
    Part,
    PathBeyondLimit,
    Repaired,
    RoundedPath,
    jerk_limited,
    pieces,
    repair,
    time_optimal,
    verify,
)

HELI4 = Limits(speed=20.0, torque=127.0, jerk=1e5)
DELTA = Limits(speed=20.0, acceleration=400.0, torque=127.0, jerk=1e5)
LEGS = Limits(speed=1.0, acceleration=30.0, torque=2000.0, jerk=3000.0)


def through(robot: Mechanism, poses: object, blends: object = ()) -> RoundedPath:
    rows = tuple(tuple(pose) for pose in np.array(poses, dtype=object).tolist())
    return RoundedPath(robot.pose_names, rows, tuple(np.array(blends, dtype=float).tolist()))


def timed(robot: Mechanism, path: RoundedPath, limits: Limits, payload: float) -> list[Repaired]:
    """Its pieces, within their limits; raises where anything fails."""
    return [repair(robot, jerk_limited(robot, part, limits, payload), limits, payload) for part in pieces(path)]


def duration(parts: list[Repaired]) -> float:
    return sum(part.motion.duration for part in parts)


def random_corners(seed: int, count: int, share: float) -> RoundedPath:
    """Through random places in a box in front of Heli4, each corner with a share of its shorter leg."""
    rng = np.random.default_rng(seed)
    places = rng.uniform((-0.25, -0.25, -0.85), (0.25, 0.25, -0.65), (count, 3))
    legs = np.linalg.norm(np.diff(places, axis=0), axis=1)
    poses = [[*place, None] for place in places.tolist()]
    poses[0][3], poses[-1][3] = 0.0, 1.0
    return through(Heli4(), poses, share * np.minimum(legs[1:], legs[:-1]))


def test_a_meander_with_small_corners_beats_a_smoothed_time_optimal_law() -> None:
    """That law, smoothed and stretched, takes 0.667 s on it."""
    robot, rows = Heli4(), np.linspace(-0.2, 0.2, 4)
    corners = [(x, y, -0.8, None) for k, y in enumerate(rows) for x in ((-0.2, 0.2) if k % 2 == 0 else (0.2, -0.2))]
    corners[0], corners[-1] = (*corners[0][:3], 0.0), (*corners[-1][:3], 0.0)
    path = through(robot, corners, [0.01] * 6)
    parts = timed(robot, path, HELI4, 1.0)
    bound = time_optimal(robot, path, replace(HELI4, jerk=None), 1.0).duration
    assert bound < duration(parts) < 0.58


@pytest.mark.parametrize(("seed", "share"), [later(1, 0.25), later(2, 0.1), (3, 0.02)])
def test_twelve_random_corners_are_timed_little_above_the_law_without_jerk(seed: int, share: float) -> None:
    path = random_corners(seed, 12, share)
    parts = timed(Heli4(), path, HELI4, 1.0)
    assert parts[0].factor < 1.002
    bound = time_optimal(Heli4(), path, replace(HELI4, jerk=None), 1.0).duration
    assert bound < duration(parts) < (1.5 if share > 0.05 else 2.0) * bound


@pytest.mark.parametrize("blend", [1e-3, 1e-5])
def test_a_small_corner_is_passed_sooner_than_with_a_rest_in_its_middle(blend: float) -> None:
    robot = Delta()
    path = through(robot, [(0.0, 0.0, -0.75), (0.1, 0.0, -0.75), (0.1, 0.1, -0.75)], [blend])
    (passed,) = timed(robot, path, DELTA, 0.5)
    halves = [Part(path, 0.0, path.length / 2), Part(path, path.length / 2, path.length)]
    rested = sum(jerk_limited(robot, half, DELTA, 0.5).duration for half in halves)
    assert passed.motion.duration < rested
    assert passed.factor < 1.001


def test_a_corner_of_two_millimetres_is_passed_sooner_than_one_that_stops() -> None:
    robot, corner = Delta(), [(0.0, 0.0, -0.75), (0.1, 0.0, -0.75), (0.1, 0.1, -0.75)]
    times = [duration(timed(robot, through(robot, corner, [blend]), DELTA, 0.5)) for blend in (2e-3, 1.5e-3, 0.0)]
    assert times[0] < times[1] < times[2]


def test_a_step_of_ten_nanometres_takes_what_its_jerk_asks() -> None:
    """Joints that go a little way d under the jerk J alone take 4 (d / (2 J))^(1/3)."""
    robot = Delta()
    ends = np.array([(0.05, 0.0, -0.75), (0.05, 1e-8, -0.75)])
    (part,) = timed(robot, through(robot, ends), DELTA, 0.5)
    way = np.abs(np.einsum("mn,n->m", robot.inverse_jacobian(ends[0]), ends[1] - ends[0])).max()
    assert part.motion.duration == pytest.approx(4.0 * (way / 2e5) ** (1 / 3), rel=2e-3)


def test_a_hexapod_rolls_in_place_as_fast_as_its_jerk_lets_it() -> None:
    robot, start = GoughStewart(), (0.0, 0.0, 0.62, 0.0, 0.0, 0.0)
    path = through(robot, [start, (0.0, 0.0, 0.62, math.radians(10.0), 0.0, 0.0)])
    without = time_optimal(robot, path, replace(LEGS, jerk=None), 0.5).duration
    rough, smooth = (duration(timed(robot, path, replace(LEGS, jerk=jerk), 0.5)) for jerk in (1e6, 3000.0))
    assert without < rough < 1.02 * without < smooth


def test_a_curve_of_many_waypoints_keeps_friction_line_and_mean_torque() -> None:
    """Sixty points of a wave, corners of a third of a millimetre and more, and every limit that a drive may state."""
    train = DriveTrain(gear_ratio=8.0, motor_inertia=1.3e-4, coulomb=0.5, viscous=0.02)
    robot = Delta(Delta().geometry, replace(Delta().inertia, drive_train=train))
    angle = np.linspace(0.0, 2.0 * math.pi, 60)
    wave = np.stack([-0.15 + 0.3 * angle / angle[-1], 0.05 * np.sin(angle), -0.8 + 0.02 * np.sin(2 * angle)], axis=-1)
    blends = 0.1 * np.linalg.norm(np.diff(wave, axis=0), axis=1)[1:]
    limits = Limits(
        speed=26.0, acceleration=600.0, torque=40.0, jerk=8e4, stall_torque=50.0, no_load_speed=39.0, rms_torque=10.0
    )
    (part,) = timed(robot, through(robot, wave, blends), limits, 1.5)
    used = part.verification.peak_over_limit
    assert part.factor < 1.003
    assert used["joint jerk"] > 0.99
    assert max(used["rms torque"], used["torque at speed"], used["torque"]) > 0.9


def test_where_drives_cannot_hold_the_weight_a_path_is_passed_at_speed() -> None:
    """The torque that it needs at rest is missing by half a per cent, somewhere between its ends."""
    robot = Heli4()
    poses = [(0.04, -0.15, -0.67, 0.0), (0.27, -0.2, -0.82, None), (0.03, -0.23, -0.73, None), (0.08, 0.28, -0.67, 0.0)]
    path = through(robot, poses, [0.1, 0.1])
    (way,) = path.evaluate(np.linspace(0.0, path.length, 2001), 0)
    weights = np.abs(inverse_dynamics(robot, 1.0, way, 0 * way, 0 * way)).max(axis=1)
    limits = Limits(speed=20.0, torque=0.995 * float(weights.max()), jerk=1e5)
    assert max(weights[0], weights[-1]) < limits.torque < weights.max()
    without = time_optimal(robot, path, replace(limits, jerk=None), 1.0).duration
    found = jerk_limited(robot, path, limits, 1.0)
    assert 0.995 * without < found.duration < 1.01 * without
    assert verify(robot, found, limits, 1.0).ok
    with pytest.raises(PathBeyondLimit, match="holding the weight"):
        jerk_limited(robot, path, replace(limits, torque=1.001 * float(max(weights[0], weights[-1]))), 1.0)
