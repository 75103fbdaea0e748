"""An emergency stop that keeps the limits of the jerk: from any instant, and against what is known in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from typing import Any

import numpy as np
import pytest

from kinematics import DriveTrain, Heli4, Mechanism, Peppermill, Redundant3T1R
from tests.sizes import later
from trajectory import (
    AdeptCycle,
    EmergencyStop,
    Limits,
    LimitsExceeded,
    Path,
    PoseSpline,
    Reversed,
    TimedMotion,
    TimedPath,
    TimeLaw,
    TimingFailed,
    emergency_stop,
    jerk_limited,
    repair,
    verify,
)
from trajectory.stops.smooth_braking import smooth_braking

LIMITS = Limits(speed=20.0, torque=127.0, jerk=1e5)


def s_law(speed: float, jerk: float, cruise: float) -> TimeLaw:
    """To a speed and, after a time at it, back to rest, at a constant jerk up and down."""
    h = math.sqrt(speed / jerk)
    jerks, steps = jerk * np.array([1.0, -1.0, 0.0, -1.0, 1.0]), np.array([h, h, cruise, h, h])
    acceleration = jerk * h * np.array([0.0, 1.0, 0.0, 0.0, -1.0])
    speeds = speed * np.array([0.0, 0.5, 1.0, 1.0, 0.5, 0.0])
    ways = speeds[:-1] * steps + acceleration * steps**2 / 2 + jerks * steps**3 / 6
    times, position = np.append(0.0, steps.cumsum()), np.append(0.0, ways.cumsum())
    return TimeLaw("S", times, position, speeds, acceleration, jerks, np.zeros(5))


@pytest.fixture(scope="module")
def motion(robot: Heli4, path: AdeptCycle) -> TimedMotion:
    """Close to its limits all along: torque nearly everywhere, jerk where that is not."""
    return repair(robot, jerk_limited(robot, path, LIMITS, 1.0), LIMITS, 1.0).motion


@pytest.fixture(scope="module", params=["few", later("many")])
def stops(request: pytest.FixtureRequest, robot: Heli4, motion: TimedMotion) -> list[EmergencyStop]:
    """From knots, from just before and after them, from next to both ends and from anywhere."""
    shares, anywhere = {"few": ((0.6,), 1), "many": ((0.145, 0.6), 4)}[request.param]
    knots = np.quantile(motion.times, shares, method="nearest")
    at = [1e-6 * motion.duration, *knots, *knots * (1 - 1e-9), *knots * (1 + 1e-9), (1 - 1e-6) * motion.duration]
    at += list(np.random.default_rng(5).uniform(0.0, motion.duration, anywhere))
    return [emergency_stop(robot, motion, t, LIMITS, 1.0) for t in at]


def test_from_every_instant_every_limit_is_proved_to_hold(stops: list[EmergencyStop]) -> None:
    for stop in stops:
        assert stop.verification.ok
        assert {"torque", "joint jerk", "joint speed"} <= stop.verification.proved.keys()
        assert max(stop.verification.proved.values()) <= 1.0
    highest = [max(stop.verification.proved.values()) for stop in stops]
    assert min(highest) > 0.98  # none dawdles


def test_it_takes_over_pose_speed_and_acceleration_and_rests_before_the_end(
    stops: list[EmergencyStop], motion: TimedMotion
) -> None:
    for stop in stops:
        first, theirs = stop.motion.at(np.array([0.0])), motion.at(np.array([stop.start]))
        for ours, other in zip(first[:3], theirs[:3], strict=True):
            assert ours == pytest.approx(other, rel=1e-9, abs=1e-9)
        assert (np.diff(stop.motion.pace.speed) <= 1e-12).all()
        assert stop.start < stop.motion.pace.position[-1] <= motion.duration
        last = stop.motion.at(np.array([stop.duration]))
        assert np.abs(last.velocity).max() < 1e-9
        assert np.abs(last.acceleration).max() < 1e-6


def test_no_knot_of_the_motion_is_hidden(stops: list[EmergencyStop], motion: TimedMotion) -> None:
    for stop in stops:
        tau = stop.motion.pace.position
        passed = motion.times[(motion.times > stop.start * (1 + 1e-12)) & (motion.times < tau[-1])]
        assert np.abs(tau - passed[:, None]).min(axis=1, initial=np.inf) == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize(
    ("way", "jerk", "starts"),
    [
        (AdeptCycle(), 1e6, (0.05719, 0.05979, 0.06)),
        later(Reversed(AdeptCycle()), 1e5, (0.01820958, 0.08155)),
    ],
    ids=["high jerk", "way back"],
)
def test_knots_are_no_jumps_of_the_acceleration(
    robot: Heli4, way: Path, jerk: float, starts: tuple[float, ...]
) -> None:
    limits = replace(LIMITS, jerk=jerk)
    motion = repair(robot, jerk_limited(robot, way, limits, 1.0), limits, 1.0).motion
    for start in starts:
        found = emergency_stop(robot, motion, start, limits, 1.0).verification
        assert 0.9 < found.peak_over_limit["joint jerk"] <= found.proved["joint jerk"] <= 1.0


def test_programmes_that_leave_hardly_a_choice_are_solved_too(robot: Heli4, motion: TimedMotion) -> None:
    """No margin in hand; so late that the motion itself is the only way."""
    for start, margin in ((0.06765380640768347, 0.0), (0.1301092949560268, 1e-3)):
        pace = smooth_braking(robot, motion, start, LIMITS, 1.0, margin)
        assert start < pace.position[-1] <= motion.duration


def test_every_margin_is_tried_before_a_stop_fails(
    robot: Heli4, motion: TimedMotion, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No pace at any margin, then one at the last."""
    module, tried = import_module("trajectory.stops.stop_on_path"), list[float]()

    def only(found: float | None) -> Callable[..., TimeLaw]:
        def pace(*args: Any) -> TimeLaw:
            tried.append(args[-1])
            if args[-1] == found:
                return smooth_braking(*args)
            raise TimingFailed("emergency stop", {}, f"none at {args[-1]}")

        return pace

    monkeypatch.setattr(module, "smooth_braking", only(None))
    with pytest.raises(TimingFailed) as failed:
        emergency_stop(robot, motion, 0.5 * motion.duration, LIMITS, 1.0)
    margins = tried[: len(tried) // 3]  # from the start, and from two knots later
    assert len(margins) > 1
    assert tried == 3 * margins
    assert f"none at {margins[-1]}" in str(failed.value)
    monkeypatch.setattr(module, "smooth_braking", only(margins[-1]))
    assert emergency_stop(robot, motion, 0.5 * motion.duration, LIMITS, 1.0).verification.ok
    assert tried == 4 * margins


def test_where_braking_does_not_succeed_at_once_it_does_from_the_next_knot(
    robot: Heli4, motion: TimedMotion, monkeypatch: pytest.MonkeyPatch
) -> None:
    knot = motion.times[np.searchsorted(motion.times, 0.5 * motion.duration)]

    def from_the_knot(*args: Any) -> TimeLaw:
        if args[2] < knot:
            raise TimingFailed("emergency stop", {}, "no pace")
        return smooth_braking(*args)

    monkeypatch.setattr(import_module("trajectory.stops.stop_on_path"), "smooth_braking", from_the_knot)
    stop = emergency_stop(robot, motion, knot - 1.6e-7, LIMITS, 1.0)
    assert stop.motion.pace.speed[1] == 1.0
    assert stop.motion.pace.position[1] == knot
    assert max(stop.verification.proved.values()) <= 1.0


def test_an_acceleration_that_does_not_continue_the_motion_fails_the_jerk_limit(
    stops: list[EmergencyStop], robot: Heli4, motion: TimedMotion
) -> None:
    stop = stops[-1]
    before = motion.at(np.array(stop.start))
    assert verify(robot, stop.motion, LIMITS, 1.0, before).ok
    found = verify(robot, stop.motion, LIMITS, 1.0, before._replace(acceleration=before.acceleration * (1.0 + 1e-6)))
    assert set(found.failures) == {"joint jerk"}
    found = verify(robot, stop.motion, LIMITS, 1.0, before._replace(velocity=before.velocity + 1e-6))
    assert "start speed" in found.failures


@pytest.mark.parametrize("share", [later(0.25), 0.8])
def test_the_jerk_costs_way_and_time_and_the_less_the_higher_its_limit(
    robot: Heli4, motion: TimedMotion, share: float
) -> None:
    start = share * motion.duration
    shortest = emergency_stop(robot, motion, start, replace(LIMITS, jerk=None), 1.0)
    ways, times = [], []
    for jerk in (1e5, 3e5, 1e8):
        stop = emergency_stop(robot, motion, start, replace(LIMITS, jerk=jerk), 1.0)
        ways.append((stop.motion.pace.position[-1] - start) / (shortest.motion.pace.position[-1] - start))
        times.append(stop.duration / shortest.duration)
    assert ways[0] > ways[1] > ways[2] >= 1.0
    assert times[0] > times[1] > times[2] >= 1.0
    assert ways[2] < 1.05
    assert times[2] < 1.1


@pytest.mark.parametrize("most", [None, 10.0, later(8.0)])
def test_in_a_straight_cruise_it_is_the_closed_form(most: float | None) -> None:
    """All six carriages move as the platform does along their rails: +-jerk, and the acceleration's limit between."""
    speed, jerk, law = 1.0, 200.0, s_law(1.0, 60.0, 0.5)
    along = np.array([1.0, 0.0, 0.0, 0.0])
    p, v, a, j = (values[:, None] * along for values in (law.position, law.speed, law.acceleration, law.jerk))
    motion = PoseSpline("S", law.times, p[:-1], v[:-1], a, j, p[[0, -1]])
    limits = Limits(speed=5.0, acceleration=most, jerk=jerk)
    stop = emergency_stop(Redundant3T1R(), motion, 0.3, limits, 1.0)
    reached = math.sqrt(speed * jerk) if most is None else min(most, math.sqrt(speed * jerk))
    duration = speed / reached + reached / jerk
    assert stop.pose[0] - motion.at(np.array(0.3)).pose[0] == pytest.approx(speed * duration / 2, rel=0.02)
    assert duration <= stop.duration <= 1.1 * duration


PEPPERMILL = Peppermill()
TABLES = {
    "motors that share the joints": (PEPPERMILL, (0.0, 0.0, -0.0125)),
    "friction": (Heli4(inertia=Heli4.Inertia(drive_train=DriveTrain(coulomb=4.0, viscous=0.5))), (0.0, 0.0, -0.7875)),
    "more drives than freedoms": (Redundant3T1R(), (0.0, 0.0, 0.0)),
}


@pytest.mark.parametrize("share", [later(0.3), 0.6])
@pytest.mark.parametrize("name", TABLES)
def test_every_limit_of_other_drives_is_kept_too(name: str, share: float) -> None:
    """A law of few knots, and limits that it just keeps, all kinds of them."""
    robot: Mechanism
    robot, middle = TABLES[name]
    path = AdeptCycle.centred(middle, turn=1.0, heading=0.6)
    motion = TimedPath(path, s_law(path.length / 0.2, path.length / 0.2 / 0.0064, 0.04))
    peaks = {p.quantity: 1.02 * abs(p.value) for p in verify(robot, motion, Limits(speed=1e6), 0.5).peaks}
    limits = Limits(
        speed=peaks["joint speed"],
        acceleration=peaks["joint acceleration"],
        torque=peaks["torque"],
        jerk=peaks["joint jerk"],
        tool_speed=peaks["tool speed"],
        tool_acceleration=peaks["tool acceleration"],
        stall_torque=2.0 * peaks["torque"],
        no_load_speed=2.0 * peaks["joint speed"],
        rms_torque=1e-3,  # of whole ways, which a stop is none of
    )
    stop = emergency_stop(robot, motion, share * motion.duration, limits, 0.5)
    assert 0.9 < max(stop.verification.proved.values()) <= 1.0
    assert stop.verification.proved.keys() >= {"tool acceleration", "torque at speed", "joint jerk"}


def test_a_motion_whose_acceleration_steps_is_not_stopped_within_a_jerk_limit(robot: Heli4, timed: TimedPath) -> None:
    with pytest.raises(LimitsExceeded, match="joint jerk of the motion to be stopped at inf"):
        emergency_stop(robot, timed, 0.5 * timed.duration, LIMITS, 1.0)


def test_a_motion_over_its_jerk_limit_is_said_to_be(robot: Heli4, motion: TimedMotion) -> None:
    with pytest.raises(LimitsExceeded, match=r"joint jerk of the motion to be stopped at 1\.1"):
        emergency_stop(robot, motion, 0.01 * motion.duration, replace(LIMITS, jerk=0.9 * LIMITS.jerk), 1.0)
