"""The Peppermill's links, screws and drives as members."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from kinematics.machine import AXES, Member, Tube, bar

if TYPE_CHECKING:
    from kinematics.robots.peppermill.peppermill import Peppermill


def members(robot: Peppermill, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
    """Proximal and distal links, and the screws between the nuts; all at `points_apart`."""
    _, carriages, elbows, nuts = robot.points_apart(pose, joints, g)
    screws = bar("screws", ("thread 1", "thread 2"), "screw", nuts[:, 0], nuts[:, 1], g.screw_radius)
    found = [screws._replace(link="tool")]
    for i, k in enumerate(("1", "2")):
        drive, elbow, nut = (f"drive {k}", f"column {k}"), f"elbow {k}", (f"nut {k}", f"thread {k}")
        near, far = (link_tube(*ends, g) for ends in ((carriages[:, i], elbows[:, i]), (elbows[:, i], nuts[:, i])))
        found += [
            Member(f"proximal link {k}", (*drive, elbow), "link", (near,)),
            Member(f"distal link {k}", (elbow, *nut), "link", (far,), f"rod {k}"),
        ]
    return found


def base_members(robot: Peppermill, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
    """Carriages and nuts; the drive columns, with room for their carriages at both ends of their range, and a motor at
    each end. A column without a range is left out, with its motors.
    """
    origins, carriages, _, nuts = robot.points_apart(pose, joints, g)
    limits, found = robot.ranges.limits(4), []
    for i, axis in enumerate(AXES[:2]):
        k, half, up = i + 1, g.carriage_length / 2, g.nut_length / 2 * AXES[2]
        ends = carriages[:, i] - half * axis, carriages[:, i] + half * axis
        found.append(bar(f"carriage {k}", (f"column {k}", f"drive {k}"), "", *ends, g.carriage_radius))
        ends = nuts[:, i] - up, nuts[:, i] + up
        found.append(bar(f"nut {k}", (f"nut {k}", f"thread {k}"), "", *ends, g.nut_radius))
        if not np.isfinite(limits[i]).all():
            continue
        reach = half + g.carriage_radius + g.motor_radius
        low, high = (origins[:, i] + at * axis for at in (limits[i, 0] - reach, limits[i, 1] + reach))
        found.append(bar(f"column {k}", ("base", f"column {k}"), "", low, high, g.column_radius))
        for name, end, way in ((f"motor {k}L", low, -axis), (f"motor {k}R", high, axis)):
            found.append(bar(name, ("base",), "", end, end + g.motor_length * way, g.motor_radius))
    return found


def link_tube(start: ca.SX, end: ca.SX, g: SimpleNamespace) -> Tube:
    """A link of either limb."""
    return Tube(start, end, g.link_radius, g.link_wall)
