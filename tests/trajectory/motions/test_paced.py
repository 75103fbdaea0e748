"""A motion at another pace: its one-sided limits are the motion's own, and no knot of the motion can be hidden."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics import InvalidValue, Redundant3T1R
from trajectory import AdeptCycle, Limits, PoseSpline, TimedMotion, TimedPath, TimeLaw, emergency_stop, motion_of
from trajectory.motions.paced import PacedMotion

ALONG_X = np.array([1.0, 0.0, 0.0, 0.0])


def spline(times: np.ndarray, jerk: np.ndarray) -> PoseSpline:
    """From rest, with (k, n) jerks."""
    state = np.zeros((3, times.size, jerk.shape[1]))
    for k, h in enumerate(np.diff(times)):
        p, v, a = state[:, k]
        j = jerk[k]
        state[:, k + 1] = p + h * (v + h * (a / 2 + h * j / 6)), v + h * (a + h * j / 2), a + h * j
    return PoseSpline("spline", times, *state[:, :-1], jerk, state[0, [0, -1]])


def random_pace(rng: np.random.Generator, count: int) -> TimeLaw:
    """From 0, with random second to fourth derivatives in each interval, small enough for it not to turn back."""
    times = np.append(0.0, rng.uniform(0.02, 0.05, count).cumsum())
    second, third, fourth = (size * rng.uniform(-1.0, 1.0, count) for size in (0.5, 10.0, 400.0))
    tau, speed = [0.0], [1.0]
    for h, a, j, d in zip(np.diff(times), second, third, fourth, strict=True):
        tau.append(tau[-1] + h * (speed[-1] + h * (a / 2 + h * (j / 6 + h * d / 24))))
        speed.append(speed[-1] + h * (a + h * (j / 2 + h * d / 6)))
    return TimeLaw("pace", times, np.array(tau), np.array(speed), second, third, fourth)


def random_motion(kind: str, rng: np.random.Generator, times: np.ndarray) -> TimedMotion:
    if kind == "spline":
        return spline(times, rng.uniform(-100.0, 100.0, (times.size - 1, 4)))
    speed = rng.uniform(0.5, 1.0, times.size)
    position = np.append(0.0, (np.diff(times) * (speed[1:] + speed[:-1]) / 2).cumsum())
    path = AdeptCycle()
    scale = path.length / position[-1]
    return TimedPath(path, TimeLaw.constant_acceleration("path", scale * position, scale * speed))


@pytest.mark.parametrize("kind", ["spline", "path"])
@pytest.mark.parametrize("seed", range(3))
def test_the_fourth_derivative_stays_within_bounds_that_close_in_with_the_parts(kind: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    pace = random_pace(rng, 12)
    motion = random_motion(kind, rng, pace.position[[0, 1, 4, 5, 9, 12]])
    timed = PacedMotion(motion, pace.cut(motion.times))
    widths = []
    for count in (100, 1000):
        edges = timed.times[:-1, None] + np.diff(timed.times)[:, None] * np.linspace(0.0, 1.0, count + 1)
        low, high = edges[:, :-1].ravel(), edges[:, 1:].ravel()
        least, most = timed.enclose_snap(low, high)
        for share in (0.06, 0.5, 0.94):
            t, h = low + share * (high - low), 0.05 * (high - low)
            snap = (timed.at(t + h).jerk - timed.at(t - h).jerk) / (2 * h[:, None])  # a mean over the part
            room = 1e-11 * np.abs(timed.at(t).jerk).max() / h[:, None]
            assert ((least - room <= snap) & (snap <= most + room)).all()
        widths.append(np.median(most - least, axis=0).max())
    assert widths[1] < 0.15 * widths[0]


def test_at_pace_1_the_limits_on_both_sides_of_each_knot_are_those_of_the_motion() -> None:
    rng = np.random.default_rng(4)
    times = np.append(0.0, rng.uniform(0.01, 0.05, 20).cumsum())
    motion = spline(times, 1e3 * rng.uniform(-1.0, 1.0, (20, 4)))
    none = np.zeros(20)
    timed = PacedMotion(motion, TimeLaw("same", times, times, np.ones(21), none, none, none))
    fractions = np.array([0.0, 1.0])
    for ours, theirs in zip(timed.within(fractions)[1], motion.within(fractions)[1], strict=True):
        assert ours == pytest.approx(theirs, rel=1e-13, abs=1e-13 * np.abs(theirs).max())


def test_a_pace_that_hides_a_knot_of_the_motion_is_refused() -> None:
    motion = spline(np.array([0.0, 0.3, 0.7, 1.0]), np.array([[1.0], [-2.0], [1.0]]) * ALONG_X)
    for tau in ([0.1, 0.3, 0.8], [0.1, 0.3 + 1e-9, 0.7, 0.8], [0.1, 0.8], [0.3, 1.0]):
        pace = TimeLaw.constant_acceleration("hides", np.array(tau), np.linspace(1.0, 0.0, len(tau)))
        with pytest.raises(InvalidValue, match="each knot of the motion that it passes"):
            PacedMotion(motion, pace)
    for tau in ([0.1, 0.3, 0.7, 0.8], [0.3, 0.7], [0.75, 0.9]):
        PacedMotion(motion, TimeLaw.constant_acceleration("all", np.array(tau), np.linspace(1.0, 0.0, len(tau))))


@pytest.mark.parametrize("tau", [[-0.1, 0.2], [0.8, 1.1]])
def test_a_pace_that_leaves_the_motion_is_refused(tau: list[float]) -> None:
    motion = spline(np.array([0.0, 1.0]), ALONG_X[None])
    with pytest.raises(InvalidValue, match=r"rising knots in \[0, 1\] s"):
        PacedMotion(motion, TimeLaw.constant_acceleration("beyond", np.array(tau), np.array([1.0, 0.0])))


def test_a_pace_that_turns_back_is_refused() -> None:
    """tau' = t^2 - t, of which a law sees the ends alone."""
    values = ([0.0, 1.0], [0.5, 0.5 - 1 / 6], [0.0, 0.0], [-1.0], [2.0], [0.0])
    with pytest.raises(InvalidValue, match="rising knots"):
        PacedMotion(spline(np.array([0.0, 1.0]), ALONG_X[None]), TimeLaw("back", *map(np.array, values)))


@pytest.mark.parametrize("later", [1.3e-4, 1e-9])
def test_what_is_proved_of_a_stop_holds_in_a_spike_of_jerk_right_after_its_start(later: float) -> None:
    """In a straight cruise the carriages' jerk is the platform's: +-190 of 200 m/s^3 within 4 us."""
    speed, jerk, spike, d = 1.0, 60.0, 190.0, 1e-6
    h, start = (speed / jerk) ** 0.5, 0.3
    cruise = start + later - 2 * h
    steps = np.array([h, h, cruise, d, 2 * d, d, 0.5 - cruise - 4 * d, h, h])
    jerks = np.array([jerk, -jerk, 0.0, -spike, spike, -spike, 0.0, -jerk, jerk])
    robot = Redundant3T1R()
    motion = spline(np.append(0.0, steps.cumsum()), jerks[:, None] * ALONG_X)
    stop = emergency_stop(robot, motion, start, Limits(speed=5.0, jerk=200.0), 1.0)
    t = np.linspace(0.0, 4e-4, 100_001)
    highest = np.abs(motion_of(robot, stop.motion.at(t), 1.0).joints.third).max() / 200.0
    assert 0.9 < highest <= stop.verification.proved["joint jerk"] <= 1.0
