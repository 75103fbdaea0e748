"""The masses of rotary arms with their drives, and of the rods that they hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace

import casadi as ca

from kinematics.machine import Bodies, DriveTrain, InertiaRecord, Particle, Rod, Rotor
from kinematics.robots.shared.rotary_limbs import RotaryLimbs


@dataclass(frozen=True)
class ArmInertia(InertiaRecord):
    """A drive set of the Quattro's class: an assumption of this project, not a datasheet. SI units.

    Attributes:
        drive: inertia of drive and gear at the joint.
        arm_mass, arm_centre, arm_factor: the arm's mass, its centre of mass c as a fraction of L, and its inertia about
            the joint over m c^2.
        rod_mass: mass of the one or two rods between an arm and the platform.
        drive_train: gear and servo loop give way by 1e-5 rad for each N m.
    """

    drive: float = 0.045
    arm_mass: float = 0.9
    arm_centre: float = 0.40
    arm_factor: float = 1.25
    rod_mass: float = 0.26
    drive_train: DriveTrain = field(default=DriveTrain(stiffness=1e5), kw_only=True)


def arms_and_rods(
    robot: RotaryLimbs, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, rod_mass: float, platforms: Sequence[str]
) -> Bodies:
    """Arms with their drives, and from each elbow a rod of `rod_mass` [kg] to the link named in `platforms`."""
    i, limbs = robot.inertia, robot.limbs(g)
    bodies = Bodies(i.rod_middle)
    swing, elbows, ends = limbs.swing(joints), limbs.elbows(joints), robot.platform_points(pose, g)
    arms, axes = ca.repmat(limbs.arm, joints.numel() // limbs.arm.numel(), 1), limbs.axes()
    for limb in range(joints.numel()):
        centre = i.arm_centre * arms[limb]
        arm = f"arm {limb + 1}"
        bodies.particles.append(Particle(arm, i.arm_mass, limbs.actuators[:, limb] + centre * swing[:, limb]))
        own = (i.arm_factor - 1) * i.arm_mass * centre**2  # beyond the particle at the centre of mass
        bodies.rotors.append(Rotor(i.drive + own, joints[limb], axes[:, limb]))
        bodies.rods.append(Rod(rod_mass, (platforms[limb], arm), ends[:, limb], elbows[:, limb]))
    return bodies
