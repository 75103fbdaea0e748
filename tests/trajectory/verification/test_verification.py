"""The verifier measures what is there, and lets nothing wrong pass."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from kinematics import Heli4, InvalidValue, Planar3RPR
from kinematics.dynamics.drive_torque import GRAVITY
from trajectory import (
    AdeptCycle,
    Limits,
    LimitsExceeded,
    Path,
    PoseSpline,
    Repaired,
    Reversed,
    TimedPath,
    TimeLaw,
    motion_of,
    repair,
    verify,
)
from trajectory.verification.sampling import parts_of

CLOSE = 5e-5  # of the least stretch, which a proof between the samples may add


@pytest.fixture(scope="module")
def repaired(robot: Heli4, limits: Limits, timed: TimedPath) -> Repaired:
    return repair(robot, timed, limits, 1.0)


@pytest.fixture(scope="module")
def smooth(path: AdeptCycle, s_curve: Callable[[Path, float], TimedPath]) -> TimedPath:
    return s_curve(path, 0.2)


@pytest.fixture(scope="module")
def lopsided(path: AdeptCycle) -> TimedPath:
    """Slow to start and quick to stop, so that not all joints have one peak."""
    s = np.linspace(0.0, path.length, 401)
    x = np.minimum(s / 0.9, (path.length - s) / 0.1)
    return TimedPath(path, TimeLaw.constant_acceleration("lopsided", s, np.sqrt(x)))


def test_speed_and_acceleration_agree_with_finite_differences_of_the_inverse_model(
    robot: Heli4, timed: TimedPath
) -> None:
    h = 1e-6
    middle = (timed.times[:-1] + timed.times[1:]) / 2
    t = middle[np.diff(timed.times) > 3 * h]
    joints = [robot.inverse(timed.at(at).pose) for at in (t - h, t, t + h)]
    measured = motion_of(robot, timed.at(t), 1.0).joints
    speed = (joints[2] - joints[0]) / (2 * h)
    acceleration = (joints[2] - 2 * joints[1] + joints[0]) / h**2
    assert np.abs(speed - measured.first).max() < 1e-6 * np.abs(measured.first).max()
    assert np.abs(acceleration - measured.second).max() < 1e-2 * np.abs(measured.second).max()


def test_a_jerk_agrees_with_finite_differences_of_the_acceleration(robot: Heli4, smooth: TimedPath) -> None:
    rng = np.random.default_rng(11)
    h = 1e-7
    t = rng.uniform(0.001, 0.199, 300)
    t = t[np.abs(t[:, None] - smooth.times).min(axis=1) > 1e-5]
    after, there, before = (motion_of(robot, smooth.at(at), 1.0).joints for at in (t + h, t, t - h))
    difference = (after.second - before.second) / (2 * h)
    assert np.abs(difference - there.third).max() < 1e-5 * np.abs(there.third).max()


def test_work_of_the_drives_is_the_gain_of_height(robot: Heli4, path: AdeptCycle, timed: TimedPath) -> None:
    """From rest to rest the drives' work is the weight's: the upper plate climbs the screw, the arms swing."""
    motion = motion_of(robot, timed.within(np.linspace(0, 1, 11))[1], 1.0)
    simpson = np.array([1, 4, 2, 4, 2, 4, 2, 4, 2, 4, 1]) / 30
    power = (motion.torque * motion.joints.first).sum(axis=-1)
    work = ((power * simpson).sum(axis=1) * np.diff(timed.times)).sum()
    g, i = robot.geometry, robot.inertia
    climb = (i.plate_masses[1] + i.rod_mass) * g.pitch * path.turn / (2 * math.pi)
    arm = (i.arm_mass * i.arm_centre + i.rod_mass / 2) * g.arm_length
    start, end = robot.inverse(path.evaluate(np.array([0.0, path.length]), 0)[0])
    gain = GRAVITY * (climb + arm * (np.cos(end) - np.cos(start)).sum())
    assert work == pytest.approx(gain, abs=1e-6)


def test_the_reference_keeps_its_limits_after_a_small_repair(repaired: Repaired) -> None:
    assert 1.0 <= repaired.factor < 1.004
    assert repaired.verification.ok
    assert 1.0 - 2 * CLOSE < max(repaired.verification.peak_over_limit.values()) <= 1.0
    assert 1.0 - 2 * CLOSE < max(repaired.verification.proved.values()) <= 1.0
    assert repaired.motion.duration == pytest.approx(repaired.before.duration * repaired.factor)


def test_the_repair_is_the_smallest_stretch(robot: Heli4, limits: Limits, timed: TimedPath, repaired: Repaired) -> None:
    less = timed.stretched(repaired.factor - CLOSE)
    assert not verify(robot, less, limits, 1.0).ok


@pytest.mark.parametrize("field", ["speed", "acceleration", "jerk", "tool_speed", "tool_acceleration"])
def test_each_kind_of_limit_is_repaired_by_its_own_power(robot: Heli4, smooth: TimedPath, field: str) -> None:
    quantity = field.replace("_", " ") if "tool" in field else f"joint {field}"
    free = verify(robot, smooth, Limits(speed=1e6), 1.0)
    peak = next(p.value for p in free.peaks if p.quantity == quantity)
    limits = replace(Limits(speed=1e6), **{field: peak / 1.009})
    mended = repair(robot, smooth, limits, 1.0)
    power = {"speed": 1, "acceleration": 2, "jerk": 3}[field.removeprefix("tool_")]
    assert 0.0 <= mended.factor - 1.009 ** (1 / power) < CLOSE


def test_a_law_within_its_limits_is_left_as_it_is(robot: Heli4, smooth: TimedPath) -> None:
    mended = repair(robot, smooth, Limits(speed=1e6), 1.0)
    assert mended.motion is smooth
    assert mended.factor == 1.0


def test_more_than_one_percent_is_not_repaired(robot: Heli4, limits: Limits, repaired: Repaired) -> None:
    with pytest.raises(LimitsExceeded) as caught:
        repair(robot, repaired.motion.stretched(0.99), limits, 1.0)
    assert caught.value.failures["torque"] > 1.01


def test_no_stretch_repairs_a_torque_limit_below_the_weight(robot: Heli4, repaired: Repaired) -> None:
    slow = repaired.motion.stretched(1000.0)
    torque = verify(robot, slow, Limits(speed=20.0), 1.0).peaks[2].value
    with pytest.raises(LimitsExceeded, match="torque"):
        repair(robot, slow, Limits(speed=20.0, torque=torque / 1.005), 1.0)


def test_the_root_mean_square_torque_is_over_nine_tenths_of_the_peak(repaired: Repaired) -> None:
    assert repaired.verification.rms_over_peak.max() > 0.9


def test_the_root_mean_square_is_the_mean_over_time(robot: Heli4, repaired: Repaired) -> None:
    t = (np.arange(200000) + 0.5) / 200000 * repaired.motion.duration
    torque = motion_of(robot, repaired.motion.at(t), 1.0).torque
    assert repaired.verification.rms_torque == pytest.approx(np.sqrt((torque**2).mean(axis=0)), rel=1e-5)


def test_a_law_five_percent_too_fast_fails(robot: Heli4, limits: Limits, repaired: Repaired) -> None:
    found = verify(robot, repaired.motion.stretched(1 / 1.05), limits, 1.0)
    assert not found.ok
    assert found.failures["torque"] > 1.08


def test_a_heavier_payload_than_was_timed_fails(robot: Heli4, limits: Limits, repaired: Repaired) -> None:
    assert verify(robot, repaired.motion, limits, 1.1).failures.keys() == {"torque"}


def test_a_law_for_other_axes_fails(robot: Heli4, limits: Limits, repaired: Repaired) -> None:
    swapped = AdeptCycle.centred((0.05, 0.0, -0.8), heading=math.pi / 2)
    assert not verify(robot, TimedPath(swapped, repaired.motion.law), limits, 1.0).ok


def test_limits_of_swapped_joints_fail(robot: Heli4, lopsided: TimedPath) -> None:
    motion = motion_of(robot, lopsided.within(np.linspace(0, 1, 11))[1], 1.0)
    own = np.abs(motion.joints.first).max(axis=(0, 1)) * 1.0001
    assert verify(robot, lopsided, Limits(speed=own), 1.0).ok
    found = verify(robot, lopsided, Limits(speed=own[[2, 3, 0, 1]]), 1.0)
    assert found.failures.keys() == {"joint speed"}


def test_a_pose_out_of_reach_fails_with_its_margin(
    robot: Heli4, path: AdeptCycle, limits: Limits, repaired: Repaired
) -> None:
    low = replace(path, pick=(-0.1525, 0.0, -1.2))
    found = verify(robot, TimedPath(low, repaired.motion.law), limits, 1.0)
    assert not found.ok
    assert found.failures["reach margin [m]"] < 0
    assert math.isnan(found.failures["torque"])


def test_one_nan_anywhere_fails(robot: Heli4, repaired: Repaired, monkeypatch: pytest.MonkeyPatch) -> None:
    free = Limits(speed=1e6)
    assert verify(robot, repaired.motion, free, 1.0).ok
    exact = AdeptCycle.evaluate

    def spoiled(self: AdeptCycle, s: np.ndarray, order: int = 3) -> tuple[np.ndarray, ...]:
        derivatives = exact(self, s, order)
        if np.ndim(s) == 2 and len(s) > 700:
            derivatives[2][700, 3, 3] = np.nan
        return derivatives

    monkeypatch.setattr(AdeptCycle, "evaluate", spoiled)
    found = verify(robot, repaired.motion, free, 1.0)
    assert not found.ok
    assert math.isnan(found.failures["torque"])
    with pytest.raises(LimitsExceeded) as caught:
        repair(robot, repaired.motion, Limits(speed=1e6, torque=1e6), 1.0)
    assert math.isnan(caught.value.failures["torque"])


@pytest.mark.parametrize("intervals", [500, 501])
def test_a_cusp_passed_at_speed_fails_on_a_knot_and_between_knots(
    robot: Heli4, straight: type, joined: type, intervals: int
) -> None:
    up = straight()
    there_and_back = joined(up, Reversed(up))
    s = np.linspace(0.0, there_and_back.length, intervals + 1)
    law = TimeLaw.constant_acceleration("through", s, np.sqrt(np.minimum(s, s[-1] - s)))
    found = verify(robot, TimedPath(there_and_back, law), Limits(speed=20.0), 1.0)
    assert found.failures["integral of acceleration"] > 1e4


def test_derivatives_that_are_not_the_path_s_fail(
    robot: Heli4, limits: Limits, repaired: Repaired, monkeypatch: pytest.MonkeyPatch
) -> None:
    exact = AdeptCycle.evaluate
    for order, what in ((1, "integral of speed"), (2, "integral of acceleration")):

        def wrong(self: AdeptCycle, s: np.ndarray, k: int = 3, order: int = order) -> tuple[np.ndarray, ...]:
            return tuple(d * (0.999 if n == order else 1.0) for n, d in enumerate(exact(self, s, k)))

        monkeypatch.setattr(AdeptCycle, "evaluate", wrong)
        assert what in verify(robot, repaired.motion, limits, 1.0).failures


def test_a_law_of_few_intervals_is_sampled_as_densely(smooth: TimedPath) -> None:
    (poses, *_) = parts_of(smooth).tool(smooth)
    steps = np.linalg.norm(np.diff(poses[..., :3], axis=1), axis=-1)
    assert steps.max() < 2.5e-4 * smooth.path.length


def test_an_end_that_is_not_at_rest_fails(robot: Heli4, path: AdeptCycle) -> None:
    s = np.linspace(0.0, path.length, 401)
    rolling = TimedPath(path, TimeLaw.constant_acceleration("rolling", s, np.full(401, 0.1)))
    found = verify(robot, rolling, Limits(speed=20.0), 1.0)
    assert found.failures.keys() == {"start speed", "end speed"}


def test_a_law_of_another_length_is_refused(timed: TimedPath) -> None:
    with pytest.raises(InvalidValue, match="arc length"):
        TimedPath(AdeptCycle(span=0.3), timed.law)


def test_a_jerk_limit_fails_where_the_acceleration_jumps(robot: Heli4, limits: Limits, repaired: Repaired) -> None:
    assert "joint jerk" not in repaired.verification.peak_over_limit
    assert "impulse" in repaired.verification.notes[0]
    found = verify(robot, repaired.motion, replace(limits, jerk=1e5), 1.0)
    assert found.failures == {"joint jerk": math.inf}


def test_a_smooth_law_has_its_jerk_measured(robot: Heli4, smooth: TimedPath) -> None:
    found = verify(robot, smooth, Limits(speed=20.0, jerk=1e7), 1.0)
    assert 0 < found.peak_over_limit["joint jerk"] < 1
    assert found.notes == ()


@pytest.mark.parametrize(("turn", "changes"), [(-1.2, False), (-2.0, True)])
def test_a_motion_through_a_singularity_changes_its_assembly_mode(turn: float, changes: bool) -> None:
    """The legs of the default 3-RPR meet in a point at theta = -90 degrees."""
    jerk = 32.0 * turn * np.array([1.0, -1.0, -1.0, 1.0])[:, None] * [0.0, 0.0, 1.0]
    rows = [np.zeros((3, 3))]
    for k in range(3):
        p, v, a = rows[-1]
        j, h = jerk[k], 0.25
        rows.append(np.stack([p + h * (v + h * (a / 2 + h * j / 6)), v + h * (a + h * j / 2), a + h * j]))
    starts = np.stack(rows)
    ends = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, turn]])
    motion = PoseSpline("by hand", np.linspace(0.0, 1.0, 5), starts[:, 0], starts[:, 1], starts[:, 2], jerk, ends)
    found = verify(Planar3RPR(), motion, Limits(speed=100.0), 0.0)
    assert ("change of assembly mode" in found.failures) == changes
    assert found.residuals["end pose"] < 1e-12


def test_a_peak_says_where_and_when(repaired: Repaired) -> None:
    found = repaired.verification
    torque = next(p for p in found.peaks if p.quantity == "torque")
    assert torque.joint in ("q1", "q2", "q3", "q4")
    assert 0 <= torque.time <= repaired.motion.duration
    assert torque.value == pytest.approx(127.0, rel=2 * CLOSE)
    assert found.rows()[2][0] == "torque [N m]"
    assert float(found.rows()[2][3]) <= float(found.rows()[2][4]) <= 1.0
    assert all(len(row) == 7 for row in found.rows())
