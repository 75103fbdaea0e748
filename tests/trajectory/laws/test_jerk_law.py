"""The jerk-limited law: against closed forms, against itself under scaling, and that it keeps what it says."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematics import Heli4, InvalidValue, Mechanism, Peppermill, Redundant3T1R, UnreachablePose, inverse_dynamics
from tests.sizes import later
from trajectory import (
    AdeptCycle,
    Limits,
    Path,
    Repaired,
    Reversed,
    RoughPath,
    TimedPath,
    TimingFailed,
    jerk_limited,
    motion_of,
    repair,
    there_and_back,
    time_optimal,
)
from trajectory.laws.jerk import refinement

SMOOTH = Limits(speed=20.0, torque=127.0, jerk=1e5)
RAIL = Redundant3T1R()  # its rails lie along x: a move along x moves every joint as far
QUICK = 60  # intervals, where a coarse law will do


@pytest.fixture(scope="module")
def mended(robot: Heli4, path: AdeptCycle) -> Repaired:
    return repair(robot, jerk_limited(robot, path, SMOOTH, 1.0), SMOOTH, 1.0)


@pytest.fixture(scope="module")
def along_rails(straight: type) -> Path:
    return straight(start=(-0.1, 0.0, 0.0, 0.0), direction=(1.0, 0.0, 0.0, 0.0), length=0.2)


def ratios_at(robot: Mechanism, mended: Repaired, limits: Limits, payload: float, times: np.ndarray) -> np.ndarray:
    """The largest share of any limit at each time, written out."""
    motion = motion_of(robot, mended.motion.at(times), payload)
    used = [np.abs(motion.joints.first) / limits.speed, np.abs(motion.joints.third) / limits.jerk]
    if limits.torque is not None:
        used.append(np.abs(motion.torque) / limits.torque)
    return np.max([u.max(axis=-1) for u in used], axis=0)


def test_the_reference_half_cycle_takes_at_most_132_5_ms(mended: Repaired) -> None:
    assert mended.motion.duration <= 0.1325
    assert mended.factor < 1.0001
    peaks, proved = mended.verification.peak_over_limit, mended.verification.proved
    assert max(peaks.values()) <= max(proved.values()) <= 1.0
    assert min(peaks["torque"], peaks["joint jerk"]) > 0.9998


def test_no_limit_is_exceeded_at_any_of_many_random_times(robot: Heli4, mended: Repaired) -> None:
    times = np.random.default_rng(5).uniform(0.0, mended.motion.duration, 200_000)
    used = ratios_at(robot, mended, SMOOTH, 1.0, times)
    assert used.max() <= 1.0 + 1e-5  # a peak may lie between two samples of the verifier
    assert np.mean(used > 0.97) > 0.9  # the fastest law is on the edge of something, but where it switches


def test_the_acceleration_is_continuous_and_zero_at_both_ends(robot: Heli4, mended: Repaired) -> None:
    ends = motion_of(robot, mended.motion.within(np.array([0.0, 1.0]))[1], 1.0).joints.second
    size = np.abs(ends).max()
    assert np.abs(ends[1:, 0] - ends[:-1, 1]).max() < 1e-9 * size
    assert np.abs(ends[[0, -1], [0, -1]]).max() < 1e-9 * size
    assert "left out" not in "".join(mended.verification.notes)


def test_the_way_back_takes_as_long(robot: Heli4, path: AdeptCycle, mended: Repaired) -> None:
    back = repair(robot, jerk_limited(robot, Reversed(path), SMOOTH, 1.0), SMOOTH, 1.0)
    assert back.motion.duration == pytest.approx(mended.motion.duration, rel=1e-3)


def test_without_much_of_a_jerk_limit_it_comes_to_the_time_optimal_law(
    robot: Heli4, path: AdeptCycle, timed: TimedPath, mended: Repaired
) -> None:
    free = repair(robot, jerk_limited(robot, path, replace(SMOOTH, jerk=1e7), 1.0), replace(SMOOTH, jerk=1e7), 1.0)
    assert timed.duration < free.motion.duration < 1.02 * timed.duration < mended.motion.duration


@pytest.mark.parametrize(
    ("speed", "acceleration", "jerk", "duration"),
    [
        (1.0, 20.0, 800.0, 0.2 / 1.0 + 1.0 / 20.0 + 20.0 / 800.0),  # seven segments
        (9.0, 20.0, 800.0, 20 / 800 + math.sqrt((20 / 800) ** 2 + 4 * 0.2 / 20)),  # no cruise
        (1.0, 900.0, 800.0, 0.2 / 1.0 + 2 * math.sqrt(1.0 / 800.0)),  # the acceleration limit is not reached
        (9.0, 900.0, 800.0, 4 * (0.2 / (2 * 800.0)) ** (1 / 3)),  # jerk alone
    ],
)
def test_on_a_straight_rail_it_is_the_profile_in_closed_form(
    along_rails: Path, speed: float, acceleration: float, jerk: float, duration: float
) -> None:
    limits = Limits(speed=speed, acceleration=acceleration, jerk=jerk)
    found = repair(RAIL, jerk_limited(RAIL, along_rails, limits, 1.0), limits, 1.0).motion.duration
    assert duration * (1 - 1e-9) <= found < duration * 1.001


def forces_by_acceleration(along_rails: Path) -> tuple[np.ndarray, np.ndarray]:
    """(6,) at rest, and for each m/s^2 along the rails."""
    pose, direction = (d[0] for d in along_rails.evaluate(np.array([0.1]), 1))
    rest = inverse_dynamics(RAIL, 1.0, pose, 0 * pose, 0 * pose)
    return rest, inverse_dynamics(RAIL, 1.0, pose, 0 * pose, direction) - rest


def test_on_a_straight_rail_a_force_limit_is_an_acceleration_limit(along_rails: Path) -> None:
    rest, mass = forces_by_acceleration(along_rails)
    force = float(np.abs(rest).max() + 15.0 * np.abs(mass).max())
    allowed = float(((force - np.abs(rest)) / np.abs(mass)).min())
    by_force, by_acceleration = (
        jerk_limited(RAIL, along_rails, Limits(speed=9.0, jerk=800.0, **limit), 1.0, QUICK).duration
        for limit in ({"torque": force}, {"acceleration": allowed})
    )
    assert by_force == pytest.approx(by_acceleration, rel=1e-3)


def test_under_an_rms_limit_alone_the_speed_is_a_parabola(along_rails: Path) -> None:
    """min T with the mean of a^2 at most c^2 has a linear a(t), and T^2 = 2 sqrt(3) length / c."""
    rest, mass = forces_by_acceleration(along_rails)
    limit = 2.0 * float(np.abs(rest).max())
    c = float((np.sqrt(limit**2 - rest**2) / np.abs(mass)).min())
    duration = math.sqrt(2 * math.sqrt(3) * along_rails.length / c)
    limits = Limits(speed=9.0, jerk=1e6, rms_torque=limit)
    mended = repair(RAIL, jerk_limited(RAIL, along_rails, limits, 1.0), limits, 1.0)
    assert duration * (1 - 1e-9) <= mended.motion.duration < 1.004 * duration
    assert mended.verification.peak_over_limit["rms torque"] == pytest.approx(1.0, abs=1e-3)
    half = mended.motion.at(np.array([0.25, 0.5]) * mended.motion.duration).velocity[:, 0]
    assert half == pytest.approx(np.array([0.75, 1.0]) * 1.5 * along_rails.length / duration, rel=5e-3)


def test_limits_of_a_film_played_faster_give_the_same_motion_faster(robot: Heli4, path: AdeptCycle) -> None:
    slow = Limits(speed=5.0, acceleration=100.0, jerk=1e4, tool_speed=2.0, tool_acceleration=50.0)
    k = 1.7
    fast = Limits(
        speed=5.0 * k,
        acceleration=100.0 * k**2,
        jerk=1e4 * k**3,
        tool_speed=2.0 * k,
        tool_acceleration=50.0 * k**2,
    )
    times = [jerk_limited(robot, path, limits, 1.0, QUICK).duration for limits in (slow, fast)]
    assert times[0] == pytest.approx(k * times[1], rel=1e-6)


@pytest.mark.parametrize(
    ("more", "active"),
    [
        ({"rms_torque": 76.2}, "rms torque"),
        later({"rms_torque": 76.2, "jerk": 1e7}, "rms torque"),
        later({"rms_torque": 76.2, "tool_acceleration": 165.0}, "rms torque"),
        ({"stall_torque": 130.0, "no_load_speed": 12.0}, "torque at speed"),
        ({"tool_acceleration": 100.0}, "tool acceleration"),
        ({"tool_speed": 3.0}, "tool speed"),
        ({"speed": 5.0}, "joint speed"),
        ({"acceleration": 300.0}, "joint acceleration"),
        ({"torque": (100.0, 127.0, 80.0, 90.0)}, "torque"),
        ({"jerk": (1e4, 1e4, 2e4, 2e4)}, "joint jerk"),
    ],
)
def test_each_limit_is_kept_and_used(robot: Heli4, path: AdeptCycle, more: dict[str, object], active: str) -> None:
    limits = replace(SMOOTH, **more)
    mended = repair(robot, jerk_limited(robot, path, limits, 1.0, QUICK), limits, 1.0)
    assert mended.verification.ok
    assert mended.verification.peak_over_limit[active] > 0.98


def test_where_the_rms_torque_alone_holds_back_it_converges_and_the_jerk_limit_hardly_matters(
    robot: Heli4, path: AdeptCycle
) -> None:
    smooth, rough = (replace(SMOOTH, rms_torque=76.2, jerk=jerk) for jerk in (1e6, 1e7))
    slower, faster = (repair(robot, jerk_limited(robot, path, asked, 1.0), asked, 1.0) for asked in (smooth, rough))
    assert 0.995 * slower.motion.duration < faster.motion.duration < slower.motion.duration
    assert faster.verification.peak_over_limit["rms torque"] == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize(
    ("robot", "path", "limits", "payload"),
    [
        (Peppermill(), AdeptCycle.centred((0.0, 0.0, -0.0125), heading=0.6), Limits(314.0, torque=7.2, jerk=1e6), 1.0),
        (RAIL, AdeptCycle(pick=(0.0, -0.1525, 0.0), heading=1.57), Limits(4.0, torque=600.0, jerk=1e4), 1.0),
        (Heli4(), AdeptCycle.centred((0.0, 0.0, -0.8), span=0.05), SMOOTH, 1.0),
        (Heli4(), AdeptCycle(blend=0.002), SMOOTH, 1.0),
        (Heli4(), AdeptCycle(), SMOOTH, 6.0),
        (Heli4(), AdeptCycle(), Limits(speed=20.0, jerk=1e5), 0.0),
    ],
    ids=["Peppermill", "Redundant3T1R", "short", "sharp corners", "heavy", "speed and jerk alone"],
)
def test_it_converges_for_other_robots_paths_and_loads(
    robot: Mechanism, path: AdeptCycle, limits: Limits, payload: float
) -> None:
    mended = repair(robot, jerk_limited(robot, path, limits, payload), limits, payload)
    assert mended.factor < 1.004
    times = np.random.default_rng(2).uniform(0.0, mended.motion.duration, 20_000)
    used = ratios_at(robot, mended, limits, payload, times)
    assert used.max() <= 1.0 + 1e-4
    assert np.quantile(used, 0.1) > 0.9


def test_a_heavier_way_back_takes_longer_and_is_checked_with_its_own_load(robot: Heli4, path: AdeptCycle) -> None:
    cycle = there_and_back(robot, path, SMOOTH, 0.0, jerk_limited, payload_back=3.0)
    there, back = cycle.pieces
    assert back.duration > 1.2 * there.duration
    assert (there.payload, back.payload) == (0.0, 3.0)
    assert ratios_at(robot, back.timed, SMOOTH, 3.0, np.linspace(0, back.duration, 5001)).max() <= 1.0 + 1e-5
    assert ratios_at(robot, there.timed, SMOOTH, 3.0, np.linspace(0, there.duration, 5001)).max() > 1.2


def test_a_law_that_cannot_keep_jerk_is_run_without_it_and_says_so(robot: Heli4, path: AdeptCycle) -> None:
    cycle = there_and_back(robot, path, SMOOTH, 1.0, time_optimal, cannot_keep=("jerk",))
    assert cycle.not_kept == ("jerk",)
    assert cycle.limits == replace(SMOOTH, jerk=None)
    assert there_and_back(robot, path, cycle.limits, 1.0, time_optimal, cannot_keep=("jerk",)).not_kept == ()


@pytest.mark.parametrize("limit", [{"jerk": None}, {"intervals": 19}, {"payload": -1.0}, {"torque": (1.0, 2.0)}])
def test_what_it_cannot_do_is_refused_by_name(robot: Heli4, path: AdeptCycle, limit: dict[str, object]) -> None:
    payload, intervals = limit.pop("payload", 1.0), limit.pop("intervals", QUICK)
    with pytest.raises(InvalidValue, match=r"jerk|intervals|payload|torque"):
        jerk_limited(robot, path, replace(SMOOTH, **limit), payload, intervals)


def test_an_answer_that_has_not_converged_is_no_answer(
    robot: Heli4, path: AdeptCycle, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(refinement, "_STEPS", 3)
    with pytest.raises(TimingFailed, match="did not settle"):
        jerk_limited(robot, path, SMOOTH, 1.0, QUICK)


def test_the_intervals_to_start_with_hardly_matter(robot: Heli4, path: AdeptCycle, mended: Repaired) -> None:
    times = [jerk_limited(robot, path, SMOOTH, 1.0, intervals).duration for intervals in (20, QUICK, 500)]
    assert times == pytest.approx([mended.motion.duration] * 3, rel=2e-3)


def test_a_path_with_a_cusp_or_out_of_reach_is_refused(
    robot: Heli4, path: AdeptCycle, straight: type, joined: type
) -> None:
    up = straight()
    with pytest.raises(RoughPath):
        jerk_limited(robot, joined(up, Reversed(up)), SMOOTH, 1.0)
    with pytest.raises(UnreachablePose):
        jerk_limited(robot, replace(path, pick=(-0.1525, 0.0, -1.2)), SMOOTH, 1.0)
