"""A drive's interpolation is as far from the motion as the theory of Hermite interpolation says."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics import Heli4
from trajectory import AdeptCycle, Cycle, Limits, cycle_setpoints, there_and_back, time_optimal
from trajectory.setpoints.interpolation import PARTS, between_setpoints

LIMITS = Limits(speed=3.0, acceleration=(8.0, 2.0))
OMEGA, STEP, COUNT = 2.0, 0.01, 400


def measured(derivatives: list[np.ndarray], exact: list[np.ndarray]) -> dict[str, dict[str, float]]:
    time = STEP * np.arange(COUNT + 1)
    return between_setpoints((time, *derivatives), exact, ("rad", "m"), LIMITS)


def waves(t: np.ndarray) -> list[np.ndarray]:
    """Position, speed and acceleration of a sine and of one half as high."""
    derivatives = (np.sin(OMEGA * t), OMEGA * np.cos(OMEGA * t), -(OMEGA**2) * np.sin(OMEGA * t))
    return [np.stack([v, v / 2], axis=-1) for v in derivatives]


def test_errors_between_set_points_are_those_of_hermite_interpolation() -> None:
    """The error of degree 2 k - 1 is at most h^2k / (2^2k (2k)!) times the derivative of order 2 k."""
    inside = STEP * (np.arange(COUNT)[:, None] + np.linspace(0, 1, PARTS + 1))
    found = measured(waves(STEP * np.arange(COUNT + 1)), waves(inside))
    for k, name in enumerate(("linear", "cubic", "quintic"), start=1):
        bound = (STEP * OMEGA / 2) ** (2 * k) / math.factorial(2 * k)
        assert found[name]["position error [rad]"] == pytest.approx(bound, rel=0.01)
        assert found[name]["position error [m]"] == pytest.approx(bound / 2, rel=0.01)
        assert found[name]["peak speed over exact"] == pytest.approx(1.0, abs=1e-3)
        assert found[name]["peak speed over limit"] == pytest.approx(OMEGA / 3.0, abs=1e-3)
    for name in ("cubic", "quintic"):
        assert found[name]["peak acceleration over limit"] == pytest.approx(1.0, abs=1e-3)  # half a wave: 2 of 2
    assert "peak acceleration over exact" not in found["linear"]


def test_an_acceleration_that_steps_between_set_points_overshoots_in_a_cubic() -> None:
    """From a to -a in the middle of a period: with both speeds equal and 0.25 a h^2 gone, the cubic starts at 1.5 a."""
    edge = STEP * (COUNT // 2 - 0.5)

    def motion(t: np.ndarray) -> list[np.ndarray]:
        since = np.maximum(t - edge, 0.0)
        derivatives = (t**2 / 2 - since**2, t - 2 * since, np.where(t < edge, 1.0, -1.0))
        return [np.stack([v, v], axis=-1) for v in derivatives]

    inside = STEP * (np.arange(COUNT)[:, None] + np.linspace(0, 1, PARTS + 1))
    found = measured(motion(STEP * np.arange(COUNT + 1)), motion(inside))
    assert found["cubic"]["peak acceleration over exact"] == pytest.approx(1.5, rel=1e-9)


def test_a_joint_that_stands_still_has_no_peaks_to_compare() -> None:
    inside = STEP * (np.arange(COUNT)[:, None] + np.linspace(0, 1, PARTS + 1))
    given, exact = ([v * [1.0, 1e-15] for v in waves(t)] for t in (STEP * np.arange(COUNT + 1), inside))
    given[0][:, 1] += 0.1 + 1e-16 * np.random.default_rng(0).standard_normal(COUNT + 1)
    exact[0][..., 1] += 0.1
    found = measured(given, exact)
    assert found["cubic"]["peak acceleration over exact"] == pytest.approx(1.0, abs=1e-3)


def test_bang_bang_set_points_at_a_millisecond_take_a_pvt_drive_over_its_limit(robot: Heli4, path: AdeptCycle) -> None:
    cycle = there_and_back(robot, path, Limits(speed=20.0, acceleration=450.0), 1.0, time_optimal)
    found = cycle_setpoints(cycle, 1e-3, ("rad",) * 4).header["between set-points"]
    assert 1.3 < found["cubic"]["peak acceleration over limit"] < 1.5
    assert 50e-6 < found["linear"]["position error [rad]"] < 60e-6


def test_a_shorter_period_brings_every_interpolation_closer(cycle: Cycle) -> None:
    coarse, fine = (cycle_setpoints(cycle, h, ("rad",) * 4).header["between set-points"] for h in (2e-3, 5e-4))
    for name in ("linear", "cubic", "quintic"):
        assert fine[name]["position error [rad]"] < coarse[name]["position error [rad]"] / 8
