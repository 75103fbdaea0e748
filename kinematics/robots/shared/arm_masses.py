"""The masses of rotary arms with their drives, and of the rods that they hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import casadi as ca

from kinematics.machine import (
    ROTARY,
    Bodies,
    DriveTrain,
    InertiaRecord,
    Member,
    Particle,
    Rod,
    Rotor,
    Tube,
    arm_mass,
    rod_mass,
)
from kinematics.robots.shared.rotary_limbs import RotaryLimbs


@dataclass(frozen=True)
class ArmInertia(InertiaRecord):
    """A drive set of the Quattro's class: an assumption of this project, not a datasheet. SI units.

    Attributes:
        drive: inertia of drive and gear at the joint.
        arm_hub: mass that joins an arm's tube to its drive, at a third of the arm.
        arm_joint: mass at the arm's end, without the axle between two rods.
        rod_joint: mass of the joint at each end of a rod.
        arm_mass, arm_centre, arm_factor: the arm's mass, its centre of mass c as a fraction of L, and its inertia about
            the joint over m c^2; None takes those of tube, hub, axle and joint.
        rod_mass: mass of the one or two rods between an arm and the platform; None takes that of tubes and joints.
        drive_train: gear and servo loop give way by 1e-5 rad for each N m.
    """

    drive: float = 0.045
    arm_hub: float = 0.594
    arm_joint: float = 0.0
    rod_joint: float = 0.033
    arm_mass: float | None = None
    arm_centre: float | None = None
    arm_factor: float | None = None
    rod_mass: float | None = None
    drive_train: DriveTrain = field(default=replace(ROTARY, stiffness=1e5), kw_only=True)


def arms_and_rods(
    robot: RotaryLimbs,
    pose: ca.SX,
    joints: ca.SX,
    g: SimpleNamespace,
    platforms: Sequence[str],
    width: ca.SX | None = None,
) -> Bodies:
    """Arms with their drives, and from each elbow a rod, or two that are `width` apart, to a link of `platforms`."""
    i, limbs, bodies = robot.inertia, robot.limbs(g), Bodies()
    swing, elbows, ends = limbs.swing(joints), limbs.elbows(joints), robot.platform_points(pose, g)
    members = {member.name: member for member in robot.members(pose, joints, g)}
    count, axes = joints.numel(), limbs.axes()
    arms, rods = (ca.repmat(length, count // length.numel(), 1) for length in (limbs.arm, limbs.rod))

    def tube_mass(member: Member, place: int, length: ca.SX) -> ca.SX:
        tube = member.shapes[place]
        assert isinstance(tube, Tube)
        return robot.structure.of(member).density * tube.area * length

    for limb in range(count):
        arm, single = members[f"arm {limb + 1}"], members[f"rod {limb + 1}" + ("" if width is None else " a")]
        end, several = (i.arm_joint, 1) if width is None else (i.arm_joint + tube_mass(arm, 1, width), 2)
        given = i.arm_mass, i.arm_centre, i.arm_factor
        mass, centre, factor = arm_mass(tube_mass(arm, 0, arms[limb]), i.arm_hub, end, given)
        place = centre * arms[limb]
        bodies.particles.append(Particle(arm.name, mass, limbs.actuators[:, limb] + place * swing[:, limb]))
        own = (factor - 1) * mass * place**2  # beyond the particle at the centre of mass
        bodies.rotors.append(Rotor(i.drive, joints[limb], axes[:, limb]))
        bodies.rotors.append(Rotor(own, joints[limb], axes[:, limb], arm.name))
        tubes, joint = several * tube_mass(single, 0, rods[limb]), several * i.rod_joint
        whole, middle = rod_mass(tubes, joint, i.rod_mass, i.rod_middle)
        bodies.rods.append(Rod(whole, middle, (platforms[limb], arm.name), ends[:, limb], elbows[:, limb]))
    return bodies
