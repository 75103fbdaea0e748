"""The three kinds of singularity are named where they are, and nowhere in the workspace."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from kinematics import Heli4

ROBOT = Heli4()


def test_a_stretched_limb_is_a_serial_singularity_alone() -> None:
    def reach(x: float) -> float:
        return float(ROBOT.margin("reach", [x, 0.0, -0.7, 0.0]))

    edge = brentq(reach, 0.3, 2.0, xtol=1e-15)
    inside = np.nextafter(edge, 0.0, dtype=float) - 1e-15
    found = ROBOT.singularities([inside, 0.0, -0.7, 0.0])
    assert {kind: bool(holds) for kind, holds in found.items()} == {
        "serial": True,
        "parallel": False,
        "internal": False,
    }


def test_limbs_paired_at_a_right_angle_make_home_a_parallel_and_an_internal_singularity() -> None:
    turned = Heli4(replace(ROBOT.geometry, azimuths=tuple(np.radians([0.0, 90.0, 180.0, 270.0]))))
    found = turned.singularities(turned.home)
    assert {kind: bool(holds) for kind, holds in found.items()} == {"serial": False, "parallel": True, "internal": True}


def test_the_workspace_holds_none_of_the_three() -> None:
    rng = np.random.default_rng(11)
    radius, azimuth = 0.5 * np.sqrt(rng.random(100_000)), rng.uniform(0, 2 * math.pi, 100_000)
    poses = np.stack(
        [
            radius * np.cos(azimuth),
            radius * np.sin(azimuth),
            rng.uniform(-0.8, -0.6, 100_000),
            rng.uniform(-math.pi, math.pi, 100_000),
        ],
        axis=-1,
    )
    assert not any(holds.any() for holds in ROBOT.singularities(poses, tolerance=0.2).values()), "seed 11"


def test_out_of_reach_is_not_called_singular() -> None:
    assert not any(bool(holds) for holds in ROBOT.singularities([3.0, 0.0, -0.7, 0.0]).values())
