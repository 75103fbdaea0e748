"""How limbs of arms, slides and rods bear the forces along their rods, and give way under them."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import Beam, Cut, LimbStatics, Member, Section, Structure, Tube, rod_cut
from kinematics.robots.shared.arm_and_rod_members import SIDES

if TYPE_CHECKING:
    from kinematics.robots.shared.rotary_limbs import RotaryLimbs


def beam(member: Member, along: ca.SX, length: ca.SX, structure: Structure) -> Beam:
    """A member whose first shape is its tube."""
    tube = member.shapes[0]
    if not isinstance(tube, Tube):
        raise TypeError(f"{member.name} is no tube")
    return Beam(along, length, Section.of(tube), getattr(structure, member.material))


def rods_of(limb: int, members: Sequence[Member]) -> list[Member]:
    """The limb's one or two rods; `limb` from 0."""
    names = {f"rod {limb + 1}{side}" for side in ("", *SIDES)}
    return [member for member in members if member.name in names]


def rod_statics(
    rods: Sequence[Member], structure: Structure, wrenches: ca.SX, along: ca.SX, length: ca.SX, efforts: ca.SX
) -> LimbStatics:
    """A limb whose parallel rods hang on a drive, and on no arm.

    Args:
        rods: k tubes.
        structure: of the robot.
        wrenches: (f, k) for a tension of 1 N in each rod.
        along: (3,) unit direction of the rods, towards the platform.
        length: of the rods [m].
        efforts: (m, k).
    """
    beams = [beam(rod, along, length, structure) for rod in rods]
    compliance = ca.diag(ca.vertcat(*(rod.stretch + 2 / structure.joint_stiffness for rod in beams)))
    cuts = (rod_cut(rod.name, along, k, len(rods)) for k, rod in enumerate(rods))
    return LimbStatics(wrenches, compliance, efforts, tuple(cuts))


def arm_statics(robot: RotaryLimbs, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[LimbStatics]:
    """Of limbs whose rods hang on an arm: a cantilever that is clamped at its drive. The axle on it is rigid."""
    members = robot.members(pose, joints, g)
    limbs, wrenches, structure = robot.limbs(g), robot.rod_wrenches(pose, joints, g), robot.structure
    swing, axes, rods, count = limbs.swing(joints), limbs.axes(), robot.rods(pose, joints, g), joints.numel()
    arms, lengths = (ca.repmat(v, count // v.numel(), 1) for v in (limbs.arm, limbs.rod))
    aside, found = robot.rods_aside(g), []
    for i in range(count):
        own = [k for k, (limb, _) in enumerate(aside) if limb == i]
        along = -rods[:, i] / lengths[i]
        force = ca.repmat(along, 1, len(own))
        moment = ca.horzcat(*(ca.cross(aside[k][1], along) for k in own))
        member = next(m for m in members if m.name == f"arm {i + 1}")
        arm = beam(member, swing[:, i], arms[i], structure)
        root = arm.moment_at_root(force, moment)
        efforts = ca.SX(count, len(own))
        efforts[i, :] = -axes[:, i].T @ root
        hung = rod_statics(rods_of(i, members), structure, wrenches[:, own], along, lengths[i], efforts)
        ends = (Cut(member.name, arm.along, force, v) for v in (root, moment))
        compliance = hung.compliance + arm.compliance(force, moment)
        found.append(hung._replace(compliance=compliance, cuts=(*ends, *hung.cuts)))
    return found
