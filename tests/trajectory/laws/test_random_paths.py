"""Random paths with corners of 1 to 25 % of a leg: the law `toppra` times all of them, and each is verified."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from kinematics import Delta, GoughStewart, Heli4, Mechanism
from trajectory import Limits, PathRefused, RoundedPath, certify_path, repair, time_optimal

pytestmark = pytest.mark.long
SEED, PATHS = 10, 200  # of all robots together
GIVEN = 0.3  # share of the angles between the ends that are given


class Case(NamedTuple):
    """A robot, a box of its poses and its limits."""

    robot: Mechanism
    low: tuple[float, ...]
    high: tuple[float, ...]
    limits: Limits


CASES = (
    Case(Heli4(), (-0.25, -0.25, -0.85, -0.5), (0.25, 0.25, -0.65, 0.5), Limits(speed=20.0, torque=127.0)),
    Case(Delta(), (-0.3, -0.3, -0.9), (0.3, 0.3, -0.6), Limits(speed=20.0, acceleration=400.0, torque=127.0)),
    Case(
        GoughStewart(),
        (-0.1, -0.1, 0.55, -0.2, -0.2, -0.3),
        (0.1, 0.1, 0.75, 0.2, 0.2, 0.3),
        Limits(speed=1.0, acceleration=30.0, torque=2000.0),
    ),
)


def random_path(case: Case, rng: np.random.Generator) -> RoundedPath:
    points = rng.uniform(case.low, case.high, (rng.integers(4, 13), len(case.low)))
    legs = np.linalg.norm(np.diff(points[:, :3], axis=0), axis=1)
    blends = rng.uniform(0.01, 0.25, legs.size - 1) * np.minimum(legs[1:], legs[:-1])
    free = rng.random(points.shape) > GIVEN
    free[[0, -1]] = free[:, :3] = False
    poses = np.where(free, None, points.astype(object))
    return RoundedPath(case.robot.pose_names, tuple(map(tuple, poses.tolist())), tuple(blends.tolist()))


def reachable_path(case: Case, rng: np.random.Generator) -> RoundedPath:
    while True:
        path = random_path(case, rng)
        try:
            certify_path(case.robot, path)
        except PathRefused:
            continue
        return path


@pytest.mark.parametrize("case", CASES, ids=lambda case: type(case.robot).__name__)
def test_every_random_path_is_timed_and_verified(case: Case) -> None:
    rng = np.random.default_rng(SEED)
    for _ in range(-(-PATHS // len(CASES))):
        path = reachable_path(case, rng)
        timed = repair(case.robot, time_optimal(case.robot, path, case.limits, 1.0), case.limits, 1.0)
        assert timed.factor < 1.002
        assert timed.verification.ok
