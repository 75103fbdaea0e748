"""The redundant 3T-1R robot's masses: slides, rods, platform and payload."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import (
    AXES,
    LINEAR,
    Bodies,
    DriveTrain,
    InertiaRecord,
    Member,
    Particle,
    Rod,
    Rotor,
    mass_points,
    rod_mass,
)
from kinematics.robots.redundant_3t1r.geometry import LIMBS, PARALLELOGRAMS

if TYPE_CHECKING:
    from kinematics.robots.redundant_3t1r.redundant_3t1r import Redundant3T1R


@dataclass(frozen=True)
class Redundant3T1RInertia(InertiaRecord):
    """A light machine with carbon arms: an assumption of this project, the paper gives no masses. SI units.

    Attributes:
        slide_mass: one carriage with the moving part of its linear motor.
        rod_joint: the joint at each end of a rod.
        rod_mass: one rod; arms 3 and 4 have two; None takes that of its tube and joints.
        platform_fittings, fittings_inertia: what the platform carries at the tool centre point P, and its inertia about
            e_z through P.
        platform_mass, platform_inertia: of the whole platform, its mass at P, and about e_z through P; None takes that
            of bars and fittings. The payload is at P too.
        drive_train: the servo loop of each linear motor gives way by 0.1 um for each N.
    """

    slide_mass: float = 5.0
    rod_joint: float = 0.335
    rod_mass: float | None = None
    platform_fittings: float = 2.65
    fittings_inertia: float = 0.012
    platform_mass: float | None = None
    platform_inertia: float | None = None
    drive_train: DriveTrain = field(default=replace(LINEAR, stiffness=1e7), kw_only=True)


def bodies(robot: Redundant3T1R, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
    """Slides, rods, platform and payload."""
    i, found = robot.inertia, Bodies()
    rails, platform, lengths = robot.rail_points(joints, g), robot.platform_points(pose, g), robot.arm_lengths(g)
    rod, moved = robot.members(pose, joints, g)[0], _platform(robot, pose, joints, g)
    per_length = robot.structure.of(rod).density * rod.tube.area
    for limb in range(LIMBS):
        slide, several = f"slide {limb + 1}", 2 if limb in PARALLELOGRAMS else 1
        single, middle = rod_mass(per_length * lengths[limb], i.rod_joint, i.rod_mass, i.rod_middle)
        found.particles.append(Particle(slide, i.slide_mass, rails[:, limb]))
        found.rods.append(Rod(several * single, middle, (slide, "platform"), rails[:, limb], platform[:, limb]))
    rest = _platform(robot, ca.SX(4, 1), joints, g)
    density = robot.structure.of(moved).density
    mass, inertia = ca.SX(i.platform_fittings), ca.SX(i.fittings_inertia)
    if i.platform_mass is None and i.platform_inertia is None:
        found.particles.extend(Particle("platform", *point) for point in mass_points(rest, moved, density))
    else:
        own = mass_points(rest, rest, density)
        mass = mass + ca.sum1(ca.vertcat(*(m for m, _ in own))) if i.platform_mass is None else ca.SX(i.platform_mass)
        about = ca.sum1(ca.vertcat(*(m * ca.sumsqr(p[:2]) for m, p in own)))
        inertia = inertia + about if i.platform_inertia is None else ca.SX(i.platform_inertia)
    found.particles.append(Particle("platform", mass + payload, pose[:3]))
    found.rotors.append(Rotor(inertia, pose[3], AXES[2]))
    return found


def _platform(robot: Redundant3T1R, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> Member:
    """Its stud and both of its bars as one."""
    parts = [member for member in robot.members(pose, joints, g) if member.material == "plate"]
    return parts[0]._replace(shapes=tuple(shape for part in parts for shape in part.shapes))
