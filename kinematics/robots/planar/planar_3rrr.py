"""Planar 3-RRR (Khalil and Dombre 2002, figure 8.4c)."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.machine import (
    AXES,
    ROTARY,
    Bodies,
    DriveTrain,
    GeometryRecord,
    JointRanges,
    Member,
    Pair,
    angle,
    bar,
    length,
    shared_joints,
)
from kinematics.model import FviBounds
from kinematics.robots.planar.planar import AZIMUTHS, Planar, PlanarGeometry, PlanarInertia
from kinematics.robots.shared import Limbs, RotaryLimbs, arms_and_rods, radial_directions


@dataclass(frozen=True)
class Planar3RRRGeometry(PlanarGeometry):
    """Arms counted from outward."""

    arm_lengths: tuple[float, ...] = length((0.30,) * 3, doc="L_i, drive to elbow")
    rod_lengths: tuple[float, ...] = length((0.35,) * 3, doc="l_i, elbow to platform")
    zero_angles: tuple[float, ...] = angle(AZIMUTHS, doc="of the arms at q_i = 0, from x")
    motor_radius: float = length(0.025, doc="of the motors below the arms")
    motor_length: float = length(0.060, doc="of the motors, without their round ends")

    def _drives(self) -> list[Array]:
        """Base joint, arm and rod; where an arm is counted from makes no other leg."""
        return [np.array(self.base_points), np.array(self.arm_lengths), np.array(self.rod_lengths)]


@dataclass(frozen=True)
class Planar3RRRInertia(PlanarInertia):
    """Arms with rotary drives [kg m^2] in place of sliders.

    Attributes:
        arm_hub, arm_joint: masses at a third of an arm, where it is joined to its drive, and at its end.
        arm_mass, arm_centre, arm_factor: the arm's mass, its centre of mass c as a fraction of L_i, and its inertia
            about the joint over m c^2; None takes those of tube, hub and joint.
        drive_train: gear and servo loop give way by 1e-4 rad for each N m.
    """

    drive: float = 0.005
    arm_hub: float = 0.16
    arm_joint: float = 0.03
    arm_mass: float | None = None
    arm_centre: float | None = None
    arm_factor: float | None = None
    drive_train: DriveTrain = field(default=replace(ROTARY, stiffness=1e4), kw_only=True)

    @property
    def rod_joint(self) -> float:
        """As for other arms and rods."""
        return self.link_joint

    @property
    def rod_mass(self) -> float | None:
        """As for other arms and rods."""
        return self.link_mass


@dataclass(frozen=True)
class Planar3RRRRanges(JointRanges):
    """Arms between outward and inward: an assumption of this project. All pivots turn freely."""

    joints: Pair | tuple[Pair, ...] = (0.0, 3.1)


class Planar3RRR(Planar, RotaryLimbs):
    """Pose [x, y, theta], joints q1..q3, the arms' angles from `zero_angles`.

    Usual branch: seen from B_i, the elbow is on the left of the line to A_i; with arms counted from outward, as the
    defaults are, each elbow lies ahead counter-clockwise and q_i is between 0 and pi around home.
    """

    Geometry = Planar3RRRGeometry
    Inertia = Planar3RRRInertia
    Ranges = Planar3RRRRanges
    geometry: Planar3RRRGeometry
    joint_units = ("rad",) * 3
    fvi_bounds = FviBounds(joint_speed=6.0, joint_effort=10.0, speed=0.3, force=10.0)

    @staticmethod
    def limbs(g: SimpleNamespace) -> Limbs:
        """In the plane z = 0."""
        return Limbs(Planar.base_points(g), *radial_directions(g.zero_angles), g.arm_lengths, g.rod_lengths)

    @classmethod
    def usual_branches(cls, home: Array, geometry: GeometryRecord) -> tuple[int, ...]:  # noqa: ARG003
        """All elbows on the left, wherever the arms are counted from."""
        return (1, 1, 1)

    @classmethod
    def circles(cls, joints: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """About the elbows."""
        return cls.limbs(g).elbows(joints), g.rod_lengths

    @staticmethod
    def scales(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """L_i l_i for each J_q,i; `determinant_scale` times the rods' product for det J_x."""
        rods = g.rod_lengths[0] * g.rod_lengths[1] * g.rod_lengths[2]
        return g.arm_lengths * g.rod_lengths, Planar.determinant_scale(g) * rods

    def members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
        """The arms too."""
        base, elbows = self.base_points(g), self.limbs(g).elbows(joints)
        held = shared_joints("P", np.array(self.geometry.base_points))
        arms = [
            Member(f"arm {i + 1}", (held[i], f"A{i + 1}"), "link", (self.link(base[:, i], elbows[:, i], g),))
            for i in range(3)
        ]
        return arms + super().members(pose, joints, g)

    def base_members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:  # noqa: ARG002
        """The motors, below the plane of the links by as much as a link's radius."""
        base, held = self.base_points(g), shared_joints("P", np.array(self.geometry.base_points))
        top, found = 2 * g.link_radius + g.motor_radius, []
        for i in range(3):
            start, end = (base[:, i] - height * AXES[2] for height in (top, top + g.motor_length))
            found.append(bar(f"motor {i + 1}", ("base", held[i]), "", start, end, g.motor_radius))
        return found

    statics = RotaryLimbs.statics

    def bodies(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
        """Arms, drives, rods and platform."""
        bodies = arms_and_rods(self, pose, joints, g, ["platform"] * 3)
        self.platform_bodies(pose, joints, g, payload, bodies)
        return bodies
