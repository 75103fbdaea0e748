"""Path and timing together: every limit kept, outside the arch, and faster than any law on the cycle's own path."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
import pytest

from kinematics import Heli4, InvalidShape, InvalidValue
from trajectory import (
    AdeptCycle,
    Limits,
    PoseSpline,
    Reversed,
    TimingFailed,
    certify_path,
    free_motion,
    lower_bound,
    there_and_back,
    verify,
)
from trajectory.laws.free import law
from trajectory.laws.free.interval_nlp import Answer, IntervalProgram
from trajectory.laws.free.law import _require_clear
from trajectory.motions.pose_spline import InTime
from trajectory.paths.clearance_arch import TOLERANCE, Arch
from trajectory.paths.pose_bounds import EDGE, PoseBounds, bezier_points

JERK = Limits(speed=20.0, torque=127.0, jerk=1e5)


@pytest.fixture(scope="module")
def motion(robot: Heli4, path: AdeptCycle) -> PoseSpline:
    return free_motion(robot, path, JERK, 1.0, 16)


def test_every_limit_is_kept_and_torque_and_jerk_are_used(robot: Heli4, motion: PoseSpline) -> None:
    ratios = verify(robot, motion, JERK, 1.0).peak_over_limit
    assert max(ratios.values()) < 1.01
    assert min(ratios["torque"], ratios["joint jerk"]) > 0.99


def test_it_is_faster_than_any_motion_on_the_cycle_s_own_path(
    robot: Heli4, path: AdeptCycle, motion: PoseSpline
) -> None:
    """Even than one without a limit of jerk."""
    assert motion.duration < 0.9 * lower_bound(robot, path, JERK, 1.0)


def test_the_tool_keeps_clear_of_the_arch_and_a_shrunken_motion_does_not(path: AdeptCycle, motion: PoseSpline) -> None:
    _require_clear(Arch.of(path), motion)
    low = replace(motion, pose=motion.pose - [0.0, 0.0, 5 * TOLERANCE * path.blend, 0.0])
    with pytest.raises(TimingFailed, match="enters the clearance arch"):
        _require_clear(Arch.of(path), low)


@pytest.mark.long
def test_the_thermal_limit_the_speed_torque_line_and_the_ranges_are_kept_too(robot: Heli4, path: AdeptCycle) -> None:
    limits = replace(JERK, rms_torque=95.0, stall_torque=180.0, no_load_speed=40.0, position=(0.8, 2.6))
    found = free_motion(robot, path, limits, 1.0, 16)
    ratios = verify(robot, found, limits, 1.0).peak_over_limit
    assert set(ratios) == {"joint speed", "torque", "joint jerk", "joint position", "torque at speed", "rms torque"}
    assert max(ratios.values()) < 1.01
    assert ratios["rms torque"] > 0.99


@pytest.mark.long
def test_the_way_back_takes_as_long_and_starts_where_the_way_there_ends(
    robot: Heli4, path: AdeptCycle, motion: PoseSpline
) -> None:
    back = free_motion(robot, Reversed(path), JERK, 1.0, 16)
    assert back.duration == pytest.approx(motion.duration, rel=1e-3)
    assert back.at(np.array(0.0)).pose == pytest.approx(motion.at(np.array(motion.duration)).pose, abs=1e-9)


@pytest.mark.long
def test_it_stays_inside_its_bounds_between_the_knots_too(robot: Heli4, path: AdeptCycle, motion: PoseSpline) -> None:
    """Bounds that the free motion without them leaves: above, in its turn, and through the circle."""
    bounds = PoseBounds((-1.0, -1.0, -0.8, 0.0), (1.0, 1.0, -0.75, math.pi), 3, radius=0.153)

    def room(found: PoseSpline) -> np.ndarray:
        pose = found.at(np.linspace(0.0, found.duration, 20_001)).pose
        sides = [pose[:, 2] + 0.8, -0.75 - pose[:, 2], pose[:, 3], math.pi - pose[:, 3]]
        return np.min([*sides, 0.153 - np.hypot(pose[:, 0], pose[:, 1])], axis=1)

    inside = free_motion(robot, path, JERK, 1.0, 16, bounds)
    assert room(inside).min() > -2 * EDGE
    assert room(motion).min() < -0.01


def test_a_cubic_is_inside_the_hull_of_its_bezier_points() -> None:
    rng, t = np.random.default_rng(3), np.linspace(0.0, 1.0, 1001)[:, None]
    start, lasting = rng.normal(size=(4, 50)), 0.3
    points = np.array([np.array(ca.DM(p))[:, 0] for p in bezier_points([ca.DM(row) for row in start], lasting)])
    p, v, a, j = start
    since = lasting * t
    curve = p + since * (v + since * (a / 2 + since * j / 6))
    bernstein = sum(math.comb(3, k) * t**k * (1 - t) ** (3 - k) * points[k] for k in range(4))
    assert np.abs(curve - bernstein).max() < 1e-12


def test_an_answer_that_did_not_converge_is_not_returned(
    robot: Heli4, path: AdeptCycle, motion: PoseSpline, monkeypatch: pytest.MonkeyPatch
) -> None:
    good = np.hstack([motion.pose, motion.velocity, motion.acceleration, motion.jerk])
    answer = Answer("Maximum_Iterations_Exceeded", good, motion.duration)
    monkeypatch.setattr(IntervalProgram, "solve", lambda *_: answer)
    with pytest.raises(TimingFailed, match="Maximum_Iterations_Exceeded"):
        free_motion(robot, path, JERK, 1.0, 16)


def test_a_motion_that_breaks_a_limit_between_its_instants_is_sought_on_twice_as_many_intervals(
    robot: Heli4, path: AdeptCycle, motion: PoseSpline, monkeypatch: pytest.MonkeyPatch
) -> None:
    tried = []

    def on_intervals(*given: Any) -> PoseSpline:
        tried.append(given[5])
        if given[5] == 16:
            law._require_kept(robot, replace(JERK, torque=120.0), 1.0, motion, {})
        return motion

    monkeypatch.setattr(law, "_on_intervals", on_intervals)
    assert free_motion(robot, path, JERK, 1.0, 16) is motion
    assert tried == [16, 32]


@pytest.mark.parametrize(
    "limits",
    [JERK, replace(JERK, speed=14.0), replace(JERK, jerk=9e4), replace(JERK, position=(-1.0, 0.0))],
    ids=["out of reach", "speed", "jerk", "position"],
)
def test_no_limit_may_be_broken_between_the_instants_nor_a_pose_be_out_of_reach(
    robot: Heli4, motion: PoseSpline, limits: Limits
) -> None:
    law._require_kept(robot, JERK, 1.0, motion, {})
    below = replace(motion, pose=motion.pose - [0.0, 0.0, 1.0, 0.0]) if limits is JERK else motion
    with pytest.raises(TimingFailed, match="between its instants"):
        law._require_kept(robot, limits, 1.0, below, {})


def test_what_cannot_be_done_is_refused(robot: Heli4, path: AdeptCycle, straight: type) -> None:
    with pytest.raises(InvalidValue, match="jerk"):
        free_motion(robot, path, replace(JERK, jerk=None), 1.0)
    with pytest.raises(InvalidValue, match="an Adept cycle"):
        free_motion(robot, straight(), JERK, 1.0)


def test_the_arch_lets_the_cycle_s_own_path_pass_and_no_shortcut(path: AdeptCycle) -> None:
    """A circle through the corner is what the exponent 2 stands for; the G3 corner is sharper than the exponent 3."""
    arch = Arch(path, exponent=2.0)
    angle = np.linspace(0.0, math.pi / 2, 50)
    centre = np.array([path.pick[0] + path.blend, 0.0, path.pick[2] + path.lift - path.blend])
    circle = centre + path.blend * np.stack([-np.cos(angle), 0 * angle, np.sin(angle)], axis=-1)
    none = np.zeros_like(circle)
    assert arch.kept_clear(circle, none)
    assert not arch.kept_clear(centre + (circle - centre) * (1 - 3 * TOLERANCE), none)
    assert not arch.kept_clear(circle, none + 3 * TOLERANCE * path.blend)
    below = np.array([[path.pick[0] - 0.01, 0.0, path.pick[2] - 3 * TOLERANCE * path.blend]])
    assert not arch.kept_clear(below, np.zeros((1, 3)))


def test_an_arch_between_unequal_heights_has_its_corners_at_both_lifts() -> None:
    cycle = AdeptCycle(lift=0.03, place_lift=0.05, rise=0.02, heading=0.6)
    arch, none = Arch(cycle), np.zeros((2, 3))
    ends = np.array([cycle.pick, cycle.place])
    assert arch.kept_clear(ends, none)
    tops = ends + np.array([[0, 0, 0.03], [0, 0, 0.05]])
    assert arch.kept_clear(tops, none)
    inward = (ends[1] - ends[0]) * 0.02 * [[1], [-1]] * [1, 1, 0]
    assert not arch.kept_clear(tops[:1] + inward[:1] - [0, 0, 0.01], none[:1])
    assert not arch.kept_clear(tops[1:] + inward[1:] - [0, 0, 0.01], none[:1])


def test_a_spline_is_its_own_derivative_and_stretches(motion: PoseSpline) -> None:
    rng, h = np.random.default_rng(5), 1e-6
    t = rng.uniform(0.001, motion.duration - 0.001, 200)
    t = t[np.abs(t[:, None] - motion.times).min(axis=1) > 2 * h]
    before, there, after = (motion.at(t + d) for d in (-h, 0.0, h))
    for low, middle, high in zip(before, there[1:], after, strict=False):
        assert np.abs((high - low) / (2 * h) - middle).max() < 1e-5 * max(1.0, np.abs(middle).max())
    slow = motion.stretched(2.0).at(2.0 * t)
    for order, (a, b) in enumerate(zip(there, slow, strict=True)):
        assert a == pytest.approx(b * 2.0**order, rel=1e-9, abs=1e-9)


def test_a_spline_that_does_not_join_is_refused(motion: PoseSpline) -> None:
    velocity = motion.velocity.copy()
    velocity[4, 1] += 1e-3
    with pytest.raises(InvalidValue, match="PoseSpline"):
        replace(motion, velocity=velocity)
    with pytest.raises(InvalidShape):
        replace(motion, jerk=motion.jerk[:-1])


def test_what_is_proved_is_proved_of_the_motion_and_not_of_the_path_that_it_left(
    robot: Heli4, path: AdeptCycle, motion: PoseSpline
) -> None:
    own = certify_path(robot, InTime(motion, path.pose_names)).margins
    poses = motion.at(np.linspace(0.0, motion.duration, 20_001)).pose
    for name in ("reach", "J_q", "det_J_x", "internal_determinant", "joint_travel"):
        assert 0.85 * robot.margin(name, poses).min() <= own[name] <= robot.margin(name, poses).min()
    cycle = there_and_back(robot, path, JERK, 1.0, lambda *_: motion)
    assert {way.length for way in cycle.ways} == {cycle.half}
    assert cycle.certificate.margins["reach"] == pytest.approx(own["reach"], rel=1e-5)
    assert own["reach"] != pytest.approx(certify_path(robot, path).margins["reach"], rel=1e-4)
