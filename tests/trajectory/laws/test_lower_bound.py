"""The lower bound is below every motion, and close to the best one."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from kinematics import DriveTrain, Heli4, Mechanism, Peppermill, Redundant3T1R, actuator_motion, inverse_dynamics
from trajectory import AdeptCycle, Limits, TimingFailed, lower_bound, time_optimal
from trajectory.laws.bounds.interval_rows import interval_rows
from trajectory.laws.bounds.least_time import _largest_x

ROBOTS: list[tuple[Mechanism, AdeptCycle, Limits]] = [
    (Heli4(), AdeptCycle(), Limits(speed=20.0, torque=127.0)),
    (Heli4(), AdeptCycle(blend=0.01, turn=-1.0, heading=0.7), Limits(speed=20.0, torque=90.0, acceleration=400.0)),
    (Heli4(), AdeptCycle(), Limits(speed=20.0, torque=127.0, tool_acceleration=80.0, tool_speed=3.0)),
    (Peppermill(), AdeptCycle(pick=(-0.1525, 0.0, 0.0)), Limits(speed=300.0, acceleration=20_000.0)),
    (Redundant3T1R(), AdeptCycle(pick=(0.0, -0.1525, 0.0), heading=math.pi / 2), Limits(speed=5.0, torque=300.0)),
]


@pytest.mark.parametrize(("robot", "path", "limits"), ROBOTS)
def test_the_time_optimal_law_is_within_one_percent_above_the_bound(
    robot: Mechanism, path: AdeptCycle, limits: Limits
) -> None:
    bound = lower_bound(robot, path, limits, 1.0)
    assert 1.0 < time_optimal(robot, path, limits, 1.0, 4000).duration / bound < 1.01


@pytest.mark.parametrize("intervals", [500, 1000, 4000])
def test_a_finer_grid_comes_closer_and_none_goes_beyond(
    robot: Heli4, path: AdeptCycle, limits: Limits, intervals: int
) -> None:
    best = time_optimal(robot, path, limits, 1.0, 8000).duration
    gap = best / lower_bound(robot, path, limits, 1.0, intervals) - 1
    assert 0 < gap < 6.0 / intervals


def test_rows_hold_the_exact_coefficients_everywhere_inside_their_intervals(robot: Heli4, path: AdeptCycle) -> None:
    limits = Limits(speed=20.0, torque=127.0, acceleration=450.0)
    edges = np.union1d(np.linspace(0.0, path.length, 301), path.knots)
    rows, highest = interval_rows(robot, path, limits, 1.0, edges)
    rng = np.random.default_rng(17)
    for share in (0.0, 1.0, *rng.uniform(size=20)):
        s = np.clip(edges[:-1] + share * np.diff(edges), edges[:-1], np.nextafter(edges[1:], 0.0))
        pose, first, second, third = path.evaluate(s, 3)
        none = np.zeros_like(pose)
        c = inverse_dynamics(robot, 1.0, pose, none, none)
        a = inverse_dynamics(robot, 1.0, pose, none, first) - c
        b = inverse_dynamics(robot, 1.0, pose, first, second) - c
        joints = actuator_motion(robot, pose, first, second, third)
        for found, radius, exact in (
            (rows.a, rows.a_radius, np.hstack([joints.first / 450.0, a / 127.0])),
            (rows.b, rows.b_radius, np.hstack([joints.second / 450.0, b / 127.0])),
            (rows.c, rows.c_radius, np.hstack([0 * c, c / 127.0])),
        ):
            assert (np.abs(exact - found) <= radius + 1e-11).all()
        assert (highest >= ((20.0 / np.abs(joints.first)) ** 2).min(axis=-1) * (1 - 1e-12)).all()


def test_a_rate_is_what_averaging_leaves_of_its_row(robot: Heli4, path: AdeptCycle, limits: Limits) -> None:
    """The integral of a u + b x is that of (a x)' / 2 + w x, for any x: here x = s^2."""
    edges = np.union1d(np.linspace(0.0, path.length, 20_001), path.knots)
    rows, _ = interval_rows(robot, path, limits, 1.0, edges)
    d, s, x = np.diff(edges), (edges[1:] + edges[:-1]) / 2, edges**2
    plain = (rows.a * s[:, None] + rows.b * s[:, None] ** 2) * d[:, None]
    by_parts = (rows.a_end * x[1:, None] - rows.a_start * x[:-1, None]) / 2 + rows.w * s[:, None] ** 2 * d[:, None]
    assert np.abs(plain.sum(axis=0) - by_parts.sum(axis=0)).max() < 1e-6 * np.abs(plain).sum(axis=0).max()


def test_each_small_program_has_the_answer_of_a_general_solver() -> None:
    rng = np.random.default_rng(0)
    for _ in range(300):
        g, h = rng.normal(size=(2, 8))
        r, most = rng.uniform(-0.05, 1.0, 8), 10.0 ** rng.uniform(-1, [5, 2])
        exact = linprog([-1, 0], A_ub=np.stack([g, h], axis=1), b_ub=r, bounds=[(0, most[0]), (0, most[1])])
        found = _largest_x(g, h, r, most[0], most[1])
        assert found == pytest.approx(-exact.fun if exact.success else -1.0, rel=1e-6, abs=1e-9)


def test_less_torque_or_more_payload_raise_the_bound(robot: Heli4, path: AdeptCycle, limits: Limits) -> None:
    bound = lower_bound(robot, path, limits, 1.0)
    assert lower_bound(robot, path, replace(limits, torque=100.0), 1.0) > 1.02 * bound
    assert lower_bound(robot, path, limits, 2.0) > 1.02 * bound


def test_a_load_beyond_the_drives_is_refused_with_the_place(robot: Heli4, path: AdeptCycle, limits: Limits) -> None:
    with pytest.raises(TimingFailed, match="no motion within the limits passes s = "):
        lower_bound(robot, path, limits, 200.0)


def test_the_way_back_has_the_bound_of_the_way_there(robot: Heli4, path: AdeptCycle, limits: Limits) -> None:
    there, back = (lower_bound(robot, way, limits, 1.0) for way in (path, path.reversed()))
    assert there == pytest.approx(back, rel=1e-6)


def test_with_a_speed_limit_alone_the_bound_is_the_length_over_the_speed(robot: Heli4, path: AdeptCycle) -> None:
    bound = lower_bound(robot, path, Limits(speed=1e3, tool_speed=2.0), 1.0)
    assert bound == pytest.approx(path.length / 2.0, rel=1e-3)
    assert bound <= path.length / 2.0


def test_friction_keeps_the_bound_below_the_law_and_viscous_friction_lowers_no_bound_wrongly(
    path: AdeptCycle, limits: Limits
) -> None:
    """Coulomb friction that always brakes may quicken a motion as well as slow it: the bound must follow the law."""
    rubbing = Heli4(inertia=Heli4.Inertia(drive_train=DriveTrain(coulomb=6.0)))
    bound, law = lower_bound(rubbing, path, limits, 1.0), time_optimal(rubbing, path, limits, 1.0, 4000).duration
    assert 1.0 < law / bound < 1.01
    oiled = Heli4(inertia=Heli4.Inertia(drive_train=DriveTrain(coulomb=6.0, viscous=0.5)))
    assert 0.9 * bound < lower_bound(oiled, path, limits, 1.0) < bound
