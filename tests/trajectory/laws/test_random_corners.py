"""Random robots from centimetres to ten metres, corners from a ten-millionth of a leg up: both laws time every path."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from kinematics import Delta, GoughStewart, Heli4, LinkwrightError, Mechanism, Par4, Planar3RRR, inverse_dynamics
from tests.design.scaled import scaled
from trajectory import Limits, RoundedPath, certify_path, jerk_limited, pieces, repair, time_optimal

pytestmark = pytest.mark.long
SEED, COUNT = 20261130, 30
Places = tuple[float, ...]
BOXES: dict[type, tuple[Places, Places, float]] = {  # places, over the robot's scale, and angles
    Par4: ((-0.12, -0.12, -0.75), (0.12, 0.12, -0.6), 0.6),
    Heli4: ((-0.2, -0.2, -0.85), (0.2, 0.2, -0.65), 1.0),
    Delta: ((-0.2, -0.2, -0.85), (0.2, 0.2, -0.65), 0.0),
    Planar3RRR: ((-0.08, -0.08), (0.08, 0.08), 0.3),
    GoughStewart: ((-0.08, -0.08, 0.54), (0.08, 0.08, 0.68), 0.15),
}


def random_path(rng: np.random.Generator, robot: Mechanism, scale: float) -> RoundedPath:
    low, high, turn = BOXES[type(robot)]
    places = rng.uniform(low, high, (rng.integers(3, 9), len(low))) * scale
    legs = np.linalg.norm(np.diff(places, axis=0), axis=1)
    blends = 10.0 ** rng.uniform(-7.0, np.log10(0.3), len(legs) - 1) * np.minimum(legs[1:], legs[:-1])
    angles = rng.uniform(-turn, turn, (len(places), len(robot.pose_names) - len(low)))
    poses = [(*place, *angle) for place, angle in zip(places.tolist(), angles.tolist(), strict=True)]
    return RoundedPath(robot.pose_names, tuple(poses), tuple(blends.tolist()))


def questions() -> Iterator[tuple[str, Mechanism, RoundedPath, Limits, float]]:
    """Each path within reach, and each weight held everywhere on it."""
    rng, found, kinds = np.random.default_rng(SEED), 0, tuple(BOXES)
    while found < COUNT:
        kind = kinds[found % len(kinds)]
        scale = 1.0 if kind is GoughStewart else float(10.0 ** rng.uniform(-2.0, 1.0))
        robot, payload = scaled(kind(), scale), float(rng.uniform(0.0, 2.0))
        path = random_path(rng, robot, scale)
        try:
            certify_path(robot, path)
        except LinkwrightError:
            continue
        (poses,) = path.evaluate(np.linspace(0.0, path.length, 500), 0)
        weight = np.abs(inverse_dynamics(robot, payload, poses, 0 * poses, 0 * poses)).max()
        speed, ramp = float(10.0 ** rng.uniform(-0.5, 1.0)), float(10.0 ** rng.uniform(-2.0, 0.0))
        torque = float(max(weight, 1e-3 * scale**2) * 10.0 ** rng.uniform(0.02, 1.2))
        jerk = speed / ramp**2 * float(10.0 ** rng.uniform(-0.5, 1.5))
        limits = Limits(speed=speed, acceleration=speed / ramp, torque=torque, jerk=jerk)
        yield f"{found}: {kind.__name__} at {scale:.3g}, {len(path.poses)} points", robot, path, limits, payload
        found += 1


def test_both_laws_time_every_path_on_which_the_robot_can_hold_still() -> None:
    failed = []
    for name, robot, path, limits, payload in questions():
        for part in pieces(path):
            for law, kept in ((jerk_limited, limits), (time_optimal, replace(limits, jerk=None))):
                try:
                    repair(robot, law(robot, part, kept, payload), kept, payload)
                except LinkwrightError as error:
                    failed.append(f"{name}, {law.__name__}: {error}")
    assert not failed
