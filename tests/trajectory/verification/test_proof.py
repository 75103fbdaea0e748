"""What is proved holds at every instant, and is close to what is used."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kinematics import Heli4
from trajectory import AdeptCycle, Limits, TimedPath, motion_of, repair, time_optimal, verify
from trajectory.limits import uses
from trajectory.verification.limit_proof import proved_use

ALL = Limits(
    speed=20.0,
    acceleration=600.0,
    torque=127.0,
    tool_speed=8.0,
    tool_acceleration=200.0,
    position=(-3.0, 3.0),
    stall_torque=200.0,
    no_load_speed=40.0,
    rms_torque=120.0,
)


@pytest.fixture(scope="module", params=[1000, 3000])
def law(request: pytest.FixtureRequest, robot: Heli4, path: AdeptCycle, limits: Limits) -> TimedPath:
    return time_optimal(robot, path, limits, 1.0, request.param)


def test_no_instant_uses_more_than_is_proved(robot: Heli4, law: TimedPath) -> None:
    bounds = proved_use(robot, law, ALL, 1.0)
    t = np.random.default_rng(31).uniform(0.0, law.duration, 200_000)
    motion = motion_of(robot, law.at(t), 1.0)
    for limit, use in uses(robot, motion, ALL).items():
        if use.ratio is not None:
            assert use.ratio.max() <= bounds[limit.name]
    rms = np.sqrt((motion.torque**2).mean(axis=0)) / 120.0  # by Monte Carlo, good to 1e-3
    assert rms.max() == pytest.approx(bounds["rms torque"], rel=3e-3)


def test_the_bounds_are_close_to_the_samples(robot: Heli4, law: TimedPath) -> None:
    bounds, seen = proved_use(robot, law, ALL, 1.0), verify(robot, law, ALL, 1.0).peak_over_limit
    assert bounds.keys() == seen.keys()
    for name, bound in bounds.items():
        assert 0.0 <= bound / seen[name] - 1.0 + 1e-6 < 1e-4, name


def test_a_repaired_motion_is_proved_within_its_limits(robot: Heli4, law: TimedPath, limits: Limits) -> None:
    repaired = repair(robot, law, replace(limits, tool_acceleration=250.0), 1.0)
    assert set(repaired.verification.proved) == {"joint speed", "torque", "tool acceleration"}
    assert max(repaired.verification.proved.values()) <= 1.0
