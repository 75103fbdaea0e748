"""How the redundant 3T-1R robot's rods bear a load, and give way with their slides."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import LimbStatics
from kinematics.robots.redundant_3t1r.geometry import LIMBS
from kinematics.robots.shared import rod_statics, rods_of

if TYPE_CHECKING:
    from kinematics.robots.redundant_3t1r.redundant_3t1r import Redundant3T1R


def statics(robot: Redundant3T1R, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[LimbStatics]:
    """The hook `statics`: eight rods in tension on six slides; one platform, which may tilt."""
    members = robot.members(pose, joints, g)
    (starts, ends), wrenches = robot.limb_ends(pose, joints, g), robot.rod_wrenches(pose, joints, g)
    found = []
    for i in range(LIMBS):
        own = [k for k, (limb, _) in enumerate(robot.rods_aside(g)) if limb == i]
        length = robot.rod_lengths(g)[i]
        along = (ends[:, i] - starts[:, i]) / length
        efforts = ca.SX(LIMBS, len(own))
        efforts[i, :] = -along[0]
        found.append(rod_statics(rods_of(i, members), robot.structure, wrenches[:, own], along, length, efforts))
    return found
