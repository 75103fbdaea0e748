"""Two hundred random paths with corners of 1 to 25 % of a leg: the law `jerk` times them, within every limit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from kinematics import Delta, GoughStewart, Heli4, LinkwrightError, Mechanism, UnreachablePose
from trajectory import Limits, RoundedPath, jerk_limited, repair, time_optimal

pytestmark = pytest.mark.long

SEED, COUNT, AT_MOST_FAIL = 20261130, 200, 1
Corner = tuple[float, float, float]
CASES: tuple[tuple[Mechanism, Limits, float, Corner, Corner, tuple[float, float]], ...] = (
    # robot, limits, payload, the box of the places, the range of the angles at both ends
    (Heli4(), Limits(20.0, torque=127.0, jerk=1e5), 1.0, (-0.25, -0.25, -0.85), (0.25, 0.25, -0.65), (0.0, 1.0)),
    (
        Delta(),
        Limits(20.0, acceleration=400.0, torque=127.0, jerk=1e5),
        0.5,
        (-0.25, -0.25, -0.85),
        (0.25, 0.25, -0.65),
        (0.0, 0.0),
    ),
    (
        GoughStewart(),
        Limits(2.0, acceleration=40.0, torque=500.0, jerk=4e3),
        1.0,
        (-0.08, -0.08, 0.54),
        (0.08, 0.08, 0.66),
        (-0.15, 0.15),
    ),
)


def random_paths() -> Iterator[tuple[str, Mechanism, RoundedPath, Limits, float]]:
    """The robots by turns, each path within reach."""
    rng, found = np.random.default_rng(SEED), 0
    while found < COUNT:
        robot, limits, payload, low, high, angles = CASES[found % len(CASES)]
        places = rng.uniform(low, high, (rng.integers(4, 13), 3))
        legs, share = np.linalg.norm(np.diff(places, axis=0), axis=1), rng.uniform(0.01, 0.25)
        count = len(robot.pose_names) - 3
        ends = [tuple(rng.uniform(*angles, count).tolist()) for _ in range(2)]
        between = [(None,) * count] * (len(places) - 2)
        poses = tuple(
            (*place, *turn) for place, turn in zip(places.tolist(), [ends[0], *between, ends[1]], strict=True)
        )
        path = RoundedPath(robot.pose_names, poses, tuple((share * np.minimum(legs[1:], legs[:-1])).tolist()))
        try:
            robot.require_reachable(path.evaluate(np.linspace(0.0, path.length, 400), 0)[0])
        except UnreachablePose:
            continue
        yield f"{found}: {type(robot).__name__}, {len(places)} points, {share:.0%}", robot, path, limits, payload
        found += 1


def test_nearly_every_random_path_is_timed_within_its_limits_and_close_to_the_law_without_jerk() -> None:
    failed, factors, over = list[str](), list[float](), list[float]()
    for name, robot, path, limits, payload in random_paths():
        try:
            mended = repair(robot, jerk_limited(robot, path, limits, payload), limits, payload)
        except LinkwrightError as error:
            failed.append(f"{name}: {error}")
            continue
        without = time_optimal(robot, path, replace(limits, jerk=None), payload).duration
        factors.append(mended.factor)
        over.append(mended.motion.duration / without)
    print(f"\n{COUNT - len(failed)} of {COUNT} timed (seed {SEED}); stretched by at most {max(factors) - 1:.3%};")
    print(f"over the law without jerk: median {np.median(over):.3f}, most {max(over):.3f}", *failed, sep="\n")
    assert len(failed) <= AT_MOST_FAIL
    assert max(factors) < 1.01
    assert 1.0 - 1e-3 < min(over) < max(over) < 3.0
