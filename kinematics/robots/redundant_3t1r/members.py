"""The redundant 3T-1R robot's rods and platform as members."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from kinematics.machine import Member, Tube, bar
from kinematics.robots.redundant_3t1r.geometry import LIMBS, PARALLELOGRAMS
from kinematics.robots.shared import SIDES

if TYPE_CHECKING:
    from kinematics.robots.redundant_3t1r.redundant_3t1r import Redundant3T1R

_HELD_AT = ("B1", "B1", "B3", "B3", "B5", "B5")  # arms 1 and 2, 3 and 4, 5 and 6 share their platform points


def members(robot: Redundant3T1R, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
    """The rods of all arms; and the platform: an upright stud at B3 for the rods of arms 3 and 4, and a bar from each
    of its ends to B1 and to B5, so that these rods pass between the bars. The three are members of their own, because
    each holds other rods.
    """
    rails, platform = robot.rail_points(joints, g), robot.platform_points(pose, g)
    found = []
    for i in range(LIMBS):
        sides = SIDES if i in PARALLELOGRAMS else {"": 0.0}
        for name, side in sides.items():
            aside, held = ca.vertcat(0, 0, side * g.parallelogram_width), (f"A{i + 1}{name}", f"{_HELD_AT[i]}{name}")
            tube = Tube(rails[:, i] + aside, platform[:, i] + aside, g.rod_radius, g.rod_wall)
            found.append(Member(f"rod {i + 1}{name}", held, "rod", (tube,), f"rod {i + 1}"))
    half, stud = g.platform_thickness / 2, ca.vertcat(0, 0, g.parallelogram_width / 2)
    low, high = (platform[:, 2] + side * stud for side in (-1, 1))
    bars = {
        "platform": (("B3 a", "B3 b"), low, high),
        "platform's upper bar": (("B1", "B3 b"), platform[:, 0], high),
        "platform's lower bar": (("B5", "B3 a"), platform[:, 4], low),
    }
    return found + [
        Member(name, at, "plate", (Tube(start, end, half, half),), "platform")
        for name, (at, start, end) in bars.items()
    ]


def base_members(robot: Redundant3T1R, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:  # noqa: ARG001
    """The rails, as long as the joints' ranges, and a slide on each. A rail without a range is left out."""
    points, half = robot.rail_points(joints, g), g.slide_length / 2 * ca.DM([1, 0, 0])
    limits = robot.ranges.limits(LIMBS)
    found = []
    for i in range(LIMBS):
        held = tuple(f"A{i + 1}{name}" for name in (SIDES if i in PARALLELOGRAMS else ("",)))
        found.append(bar(f"slide {i + 1}", held, "", points[:, i] - half, points[:, i] + half, g.slide_radius))
        if np.isfinite(limits[i]).all():
            start, end = (ca.vertcat(limit, points[1:, i]) for limit in limits[i])
            found.append(bar(f"rail {i + 1}", ("base", *held), "", start, end, g.rail_radius))
    return found
