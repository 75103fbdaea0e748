"""Between two times nothing leaves the bounds, and the bounds close in as the times do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from kinematics import DriveTrain, Heli4
from tests.sizes import later
from trajectory import AdeptCycle, Limits, Path, Reversed, TimedPath, jerk_limited, motion_of, time_optimal
from trajectory.verification.enclosure import slack

Parts = Callable[[TimedPath, int], tuple[np.ndarray, np.ndarray]]


def parts_of(timed: TimedPath, count: int, most: int = 1_000_000) -> tuple[np.ndarray, np.ndarray]:
    """Starts and ends of `count` equal parts of each interval of the law, or of `most` about of its intervals."""
    chosen = slice(None, None, 1 + timed.times.size // most)
    starts, lasting = timed.times[:-1][chosen, None], np.diff(timed.times)[chosen, None]
    edges = starts + lasting * np.linspace(0.0, 1.0, count + 1)
    return edges[:, :-1].ravel(), edges[:, 1:].ravel()


@pytest.fixture(scope="module", params=[500, later(1_000_000)])
def parts(request: pytest.FixtureRequest) -> Parts:
    return partial(parts_of, most=request.param)


@pytest.fixture(scope="module", params=["S", "jerk", "toppra", "sharp corners, way back"])
def timed(
    request: pytest.FixtureRequest,
    robot: Heli4,
    path: AdeptCycle,
    limits: Limits,
    s_curve: Callable[[Path, float], TimedPath],
) -> TimedPath:
    if request.param == "S":
        return s_curve(path, 0.2)
    if request.param == "jerk":
        return jerk_limited(robot, path, replace(limits, jerk=1e5), 1.0, 40)
    if request.param == "toppra":
        return time_optimal(robot, path, limits, 1.0, 1000)
    return time_optimal(robot, Reversed(AdeptCycle(blend=0.004, turn=-2.0, heading=0.4)), limits, 1.0, 1000)


def test_every_instant_lies_within_the_slack_around_the_middle_of_its_part(
    robot: Heli4, timed: TimedPath, parts: Parts
) -> None:
    low, high = parts(timed, 4 if timed.times.size > 100 else 500)
    bounds = slack(robot, timed, 1.0, low, high).motion
    middle = motion_of(robot, timed.at(0.5 * low + 0.5 * high), 1.0)
    rng = np.random.default_rng(23)
    for share in (1e-9, 1 - 1e-9, *rng.uniform(size=20)):
        there = motion_of(robot, timed.at(low + share * (high - low)), 1.0)
        assert (np.abs(there.torque - middle.torque) <= bounds.torque + 1e-9).all()
        for group in ("tool", "joints"):
            for value, centre, bound in zip(*(getattr(m, group) for m in (there, middle, bounds)), strict=True):
                assert (np.abs(value - centre) <= bound * (1 + 1e-9) + 1e-9 * np.abs(centre).max()).all()


def test_the_slack_shrinks_with_the_parts(robot: Heli4, timed: TimedPath, parts: Parts) -> None:
    coarse, fine = (slack(robot, timed, 1.0, *parts(timed, count)).motion for count in (20, 80))
    for a, b in ((coarse.torque, fine.torque), (coarse.joints.third, fine.joints.third)):
        assert np.median(b) < 0.3 * np.median(a)


def test_the_fourth_derivative_stays_within_bounds_that_close_in_with_the_parts(timed: TimedPath, parts: Parts) -> None:
    widths = []
    for count in (4, 40):
        low, high = parts(timed, count)
        least, most = timed.enclose_snap(low, high)
        for share in (0.1, 0.5, 0.9):
            t, h = low + share * (high - low), 0.05 * (high - low)
            snap = (timed.at(t + h).jerk - timed.at(t - h).jerk) / (2 * h[:, None])  # a mean over the part
            room = 1e-6 * np.abs(timed.at(t).jerk).max() / h[:, None]
            assert ((least - room <= snap) & (snap <= most + room)).all()
        widths.append(np.median(most - least, axis=0).max())
    assert widths[1] < 0.15 * widths[0]


def test_the_slack_of_a_saturated_torque_is_a_small_share_of_it(robot: Heli4, path: AdeptCycle, limits: Limits) -> None:
    timed = time_optimal(robot, path, limits, 1.0, 1000)
    low, high = parts_of(timed, 10)
    middle, bounds = motion_of(robot, timed.at(0.5 * low + 0.5 * high), 1.0), slack(robot, timed, 1.0, low, high).motion
    assert (np.abs(middle.torque) + bounds.torque).max() < 1.0001 * np.abs(middle.torque).max()


def test_friction_is_bounded_where_a_joint_turns_back(
    path: AdeptCycle, s_curve: Callable[[Path, float], TimedPath]
) -> None:
    rubbing = Heli4(inertia=Heli4.Inertia(drive_train=DriveTrain(coulomb=3.0, viscous=0.4)))
    timed = s_curve(path, 0.2)
    low, high = parts_of(timed, 500)
    bounds = slack(rubbing, timed, 1.0, low, high).motion
    middle = motion_of(rubbing, timed.at(0.5 * low + 0.5 * high), 1.0)
    for share in (0.01, 0.3, 0.99):
        there = motion_of(rubbing, timed.at(low + share * (high - low)), 1.0)
        assert (np.abs(there.torque) <= np.abs(middle.torque) + bounds.torque + 1e-9).all()
    assert (bounds.torque > 3.0).any()


def test_the_mean_torque_of_a_part_is_off_that_in_its_middle_by_the_second_order(
    robot: Heli4, timed: TimedPath, parts: Parts
) -> None:
    errors = []
    for count in (10, 20):
        low, high = parts(timed, count if timed.times.size > 100 else 100 * count)
        bounds = slack(robot, timed, 1.0, low, high)
        nodes, weights = np.polynomial.legendre.leggauss(6)
        at = [motion_of(robot, timed.at(low + (n + 1) / 2 * (high - low)), 1.0).torque for n in nodes]
        mean = sum(w / 2 * torque for w, torque in zip(weights, at, strict=True))
        middle = motion_of(robot, timed.at(0.5 * low + 0.5 * high), 1.0).torque
        assert (np.abs(mean - middle) <= bounds.mean_torque + 1e-9).all()
        errors.append(np.median(bounds.mean_torque))
    assert errors[1] < 0.3 * errors[0]
