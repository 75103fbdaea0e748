"""The redundant 3T-1R robot's masses: slides, rods, platform and payload."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import AXES, Bodies, DriveTrain, InertiaRecord, Particle, Rod, Rotor
from kinematics.robots.redundant_3t1r.geometry import LIMBS, PARALLELOGRAMS

if TYPE_CHECKING:
    from kinematics.robots.redundant_3t1r.redundant_3t1r import Redundant3T1R


@dataclass(frozen=True)
class Redundant3T1RInertia(InertiaRecord):
    """A light machine with carbon arms: an assumption of this project, the paper gives no masses. SI units.

    Attributes:
        slide_mass: one carriage with the moving part of its linear motor.
        rod_mass: one rod; arms 3 and 4 have two.
        platform_mass: at the tool centre point P, where the payload sits too.
        platform_inertia: of the platform about e_z through P.
        drive_train: the servo loop of each linear motor gives way by 0.1 um for each N.
    """

    slide_mass: float = 5.0
    rod_mass: float = 0.9
    platform_mass: float = 3.0
    platform_inertia: float = 0.015
    drive_train: DriveTrain = field(default=DriveTrain(stiffness=1e7), kw_only=True)


def bodies(robot: Redundant3T1R, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
    """Slides, rods, platform and payload."""
    i, found = robot.inertia, Bodies(robot.inertia.rod_middle)
    rails, platform = robot.rail_points(joints, g), robot.platform_points(pose, g)
    for limb in range(LIMBS):
        slide, rods = f"slide {limb + 1}", i.rod_mass * (2 if limb in PARALLELOGRAMS else 1)
        found.particles.append(Particle(slide, i.slide_mass, rails[:, limb]))
        found.rods.append(Rod(rods, (slide, "platform"), rails[:, limb], platform[:, limb]))
    found.particles.append(Particle("platform", i.platform_mass + payload, pose[:3]))
    found.rotors.append(Rotor(i.platform_inertia, pose[3], AXES[2]))
    return found
