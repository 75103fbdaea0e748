"""Drives with friction: the time-optimal law knows it exactly, the repair stretches by it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematics import DriveTrain, Heli4, InvalidValue, inverse_dynamics
from kinematics.dynamics.drive_torque import GRAVITY
from tests.kinematics.weighed import HELI4
from tests.sizes import later
from trajectory import AdeptCycle, Limits, LimitsExceeded, TimedPath, repair, time_optimal, verify


def rough(**drives: float) -> Heli4:
    return Heli4(inertia=replace(HELI4, drive_train=DriveTrain(**drives)))


def test_the_law_with_coulomb_friction_is_on_the_edge_of_the_limit(
    path: AdeptCycle, limits: Limits, timed: TimedPath
) -> None:
    """By `verify`, which takes friction from inverse dynamics. Without it in the law the peak is 10 N m too high."""
    robot = rough(coulomb=10.0)
    found = time_optimal(robot, path, limits, 1.0)
    ratio = verify(robot, found, limits, 1.0).peak_over_limit["torque"]
    assert 0.999 < ratio < 1.002
    ignored = verify(robot, timed, limits, 1.0).peak_over_limit["torque"]
    assert ignored == pytest.approx(1 + 10.0 / 127.0, abs=0.01)
    assert found.duration > timed.duration


def test_a_free_vertical_fall_against_friction_takes_as_long_as_by_hand(straight: type) -> None:
    """Two kilograms, half on each plate, under four massless drives, down a short line.

    J^T tau = m (g + z''), all four torques alike by symmetry. Each drive gives L less its friction c to go, and L more
    c to brake: the force is the sum of |J_z| (L -+ c), and J varies little over the line. On a fine grid, as the law
    counts on no friction where it comes to rest.
    """
    light = Heli4.Inertia(
        drive=0.0, arm_mass=0.0, rod_mass=0.0, plate_masses=(1.0, 1.0), drive_train=DriveTrain(coulomb=3.0)
    )
    line = straight(start=(0.0, 0.0, -0.7, 0.0), direction=(0.0, 0.0, -1.0, 0.0), length=1e-3)
    robot, limit = Heli4(inertia=light), 10.0
    found = time_optimal(robot, line, Limits(speed=1e6, torque=limit), 0.0, intervals=20_000)
    lever = np.abs(robot.inverse_jacobian(np.array([0.0, 0.0, -0.7005, 0.0]))[:, 2]).sum()
    down = lever * (limit - 3.0) / 2.0 + GRAVITY
    up = lever * (limit + 3.0) / 2.0 - GRAVITY
    top = math.sqrt(2 * line.length * down * up / (down + up))
    assert found.duration == pytest.approx(top / down + top / up, rel=2e-3)


def test_viscous_friction_is_refused_by_name_where_torque_is_limited(path: AdeptCycle, limits: Limits) -> None:
    robot = rough(viscous=0.1)
    with pytest.raises(InvalidValue, match=r"DriveTrain viscous for the toppra law: found 0.1; expected 0"):
        time_optimal(robot, path, limits, 1.0)
    assert time_optimal(robot, path, replace(limits, torque=None, acceleration=500.0), 1.0).duration > 0


@pytest.mark.parametrize(
    "drives",
    [
        later({"coulomb": 8.0}),
        later({"viscous": 0.5}),
        {"coulomb": 5.0, "viscous": 0.3},
    ],
)
def test_the_repair_stretches_as_little_as_friction_lets_it(timed: TimedPath, drives: dict[str, float]) -> None:
    robot = rough(**drives)
    slower = timed.stretched(1.05)
    peak = verify(robot, slower, Limits(speed=20.0), 1.0).peaks[2].value
    tight = Limits(speed=20.0, torque=peak / 1.005)
    repaired = repair(robot, slower, tight, 1.0)
    assert 1.0 < repaired.factor < 1.01
    assert not verify(robot, slower.stretched(repaired.factor - 5e-5), tight, 1.0).ok


def test_friction_beyond_the_limit_cannot_be_stretched_away(path: AdeptCycle, timed: TimedPath) -> None:
    robot = rough(coulomb=100.0)
    slow = timed.stretched(100.0)
    rest = np.zeros(4)
    weight = np.abs(inverse_dynamics(robot, 1.0, path.evaluate(np.array(0.0), 0)[0], rest, rest)).max()
    peak = verify(robot, slow, Limits(speed=20.0), 1.0).peaks[2].value
    assert peak > 100.0 + weight / 2
    with pytest.raises(LimitsExceeded, match="torque at rest"):
        repair(robot, slow, Limits(speed=20.0, torque=peak / 1.005), 1.0)
