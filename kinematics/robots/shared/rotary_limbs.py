"""Limbs of a rotary arm and a rod, as in Heli4, Delta, Par4, Hexa and 3-RRR.

The arm turns about a fixed axis and carries A = P + L (zero cos q + quarter sin q); the rod holds |A - B| = l. Squaring
gives M cos q + N sin q = G, expressions (10)-(12) of Krut et al. 2006, with two roots, the elbow on either side of the
line from B to P. Usual is the side on which the elbow is further along `quarter` when the robot is at home: outside,
where `quarter` points outward, whether the platform hangs below the drives or stands above them.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.machine import (
    GeometryRecord,
    LimbStatics,
    Pair,
    PassiveJoint,
    RodRanges,
)
from kinematics.model import Mechanism, Mode
from kinematics.robots.shared.limb_statics import arm_statics

_LEVEL = 1e-9  # times the robot's size: a platform point that is closer to the drive's level counts as level with it


class Limbs(NamedTuple):
    """m limbs.

    Attributes:
        actuators: (3, m) P_i, a point of each arm's axis.
        zero, quarter: (3, m) unit directions of each arm at q = 0 and a quarter turn on.
        arm, rod: L and l, one for all or (m,).
    """

    actuators: ca.SX
    zero: ca.SX
    quarter: ca.SX
    arm: ca.SX
    rod: ca.SX

    def elbows(self, joints: ca.SX) -> ca.SX:
        """(3, m) A_i, where the rods meet the arms."""
        along = self.swing(joints)
        return self.actuators + along @ ca.diag(ca.repmat(self.arm, joints.numel() // self.arm.numel(), 1))

    def swing(self, joints: ca.SX) -> ca.SX:
        """(3, m) unit directions of the arms."""
        return ca.mtimes(self.zero, ca.diag(ca.cos(joints))) + ca.mtimes(self.quarter, ca.diag(ca.sin(joints)))

    def terms(self, platform: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
        """M_i, N_i, G_i and sqrt(M^2 + N^2 - G^2), NaN where a limb cannot reach its B_i (3, m)."""
        to_actuator = self.actuators - platform
        m = 2 * self.arm * ca.sum1(to_actuator * self.zero).T
        n = 2 * self.arm * ca.sum1(to_actuator * self.quarter).T
        right = self.rod**2 - ca.sum1(to_actuator * to_actuator).T - self.arm**2
        return m, n, right, ca.sqrt(m * m + n * n - right * right)

    def inverse(self, platform: ca.SX, mode: Mode) -> ca.SX:
        """(m,) joints of a working mode."""
        cosines, sines, _ = self._scaled(platform, mode)
        return mode.angles(cosines, sines)

    def cosines_and_sines(self, platform: ca.SX, mode: Mode) -> tuple[ca.SX, ca.SX]:
        """Both from the root that is kept, without an angle."""
        cosines, sines, square = self._scaled(platform, mode)
        return cosines / square, sines / square

    def _scaled(self, platform: ca.SX, mode: Mode) -> tuple[ca.SX, ca.SX, ca.SX]:
        """(m,) cosines and sines times M^2 + N^2, and that."""
        m, n, right, root = self.terms(platform)
        root = ca.vertcat(*(branch * root[i] for i, branch in enumerate(mode.branches)))
        return m * right - n * root, n * right + m * root, m * m + n * n

    def axes(self) -> ca.SX:
        """(3, m) unit directions about which the arms turn, and along which their rods' joints lie."""
        return ca.horzcat(*(ca.cross(self.zero[:, i], self.quarter[:, i]) for i in range(self.zero.shape[1])))

    def reach(self, platform: ca.SX) -> ca.SX:
        """(m,) how much longer or shorter each rod could be and still reach from B_i to the arm's circle [m]."""
        to_actuator = self.actuators - platform
        across, outward, along = (ca.sum1(to_actuator * d).T for d in (self.axes(), self.quarter, self.zero))
        distance = ca.sqrt(outward**2 + along**2)
        nearest = ca.sqrt((distance - self.arm) ** 2 + across**2)
        farthest = ca.sqrt((distance + self.arm) ** 2 + across**2)
        return ca.fmin(self.rod - nearest, farthest - self.rod)


def radial_directions(azimuths: ca.SX) -> tuple[ca.SX, ca.SX]:
    """u_i (3, m), radial at these azimuths, and e_z x u_i (3, m)."""
    c, s, zero = ca.cos(azimuths).T, ca.sin(azimuths).T, ca.SX(1, azimuths.numel())
    return ca.vertcat(c, s, zero), ca.vertcat(-s, c, zero)


def upright_limbs(actuators: ca.SX, radial: ca.SX, g: SimpleNamespace) -> Limbs:
    """Arms in vertical planes along u_i, counted from e_z outward; (3, m) each."""
    up = columns(ca.SX([0, 0, 1]), radial.shape[1])
    return Limbs(actuators, up, radial, g.arm_length, g.rod_length)


def central_limbs(g: SimpleNamespace) -> Limbs:
    """Drives on a circle about e_z, and arms in vertical planes through it."""
    radial, _ = radial_directions(g.azimuths)
    return upright_limbs(g.base_radius * radial, radial, g)


def height_in_reach(base_radius: float, platform_radius: float, arm: float, rod: float) -> float:
    """The depth below the drives' plane where a platform on the axis is in the middle of its reach [m]."""
    aside = base_radius - platform_radius
    lowest, highest = ((rod + side * arm) ** 2 - aside**2 for side in (1, -1))
    return (math.sqrt(max(lowest, 0.0)) + math.sqrt(max(highest, 0.0))) / 2


def columns(point: ca.SX, count: int) -> ca.SX:
    """(3, count) the same point in every column."""
    return ca.repmat(point, 1, count)


@dataclass(frozen=True)
class ArmRanges(RodRanges):
    """Arms in vertical planes and ball joints of a Delta's kind: an assumption of this project, not a datasheet.

    Arms from straight up to 38 degrees past straight down; rods up to 57 degrees out of their arms' planes.
    """

    joints: Pair | tuple[Pair, ...] = (0.0, 3.8)


class RotaryLimbs(Mechanism):
    """A mechanism whose m limbs are all of this kind. It gives the place of its limbs and the points that they hold."""

    inertia: Any

    @staticmethod
    @abstractmethod
    def limbs(g: SimpleNamespace) -> Limbs:
        """Its limbs."""

    @staticmethod
    @abstractmethod
    def platform_points(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(3, m) B_i, where the rods meet the platform."""

    @classmethod
    def rods(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(3, m) from B_i to A_i."""
        return cls.limbs(g).elbows(joints) - cls.platform_points(pose, g)

    def passive_joints(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[PassiveJoint]:
        """Ball joints whose studs lie along the arm's axis, on the arm and on the platform.

        They are like those of the FlexPicker, whose forearms Heli4 has: a rod swings freely in the arm's plane and
        leans out of it.
        """
        limbs, turned = self.limbs(g), self.platform_axes(pose, g)
        rods, lengths = self.rods(pose, joints, g), ca.repmat(limbs.rod, joints.numel() // limbs.rod.numel(), 1)
        return [
            PassiveJoint(axes[:, i], rods[:, i], lengths[i], end)
            for end, axes in enumerate((limbs.axes(), turned))
            for i in range(joints.numel())
        ]

    @classmethod
    def rods_aside(cls, g: SimpleNamespace) -> list[tuple[int, ca.SX]]:  # noqa: ARG003
        """The limb of each rod, from 0, and how far the rod is beside A_i B_i (3,); here each limb has one rod."""
        return [(i, ca.SX.zeros(3)) for i in range(len(cls.joint_names))]

    @classmethod
    def rod_wrenches(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(f, k) what a tension of 1 N in each rod does to the platform's freedoms, which here are the twist."""
        by_twist: ca.SX = cls.closure_by_twist(pose, joints, g)
        return -by_twist.T @ ca.diag(1 / ca.repmat(cls.limbs(g).rod, joints.numel() // cls.limbs(g).rod.numel(), 1))

    def statics(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[LimbStatics]:
        """Rods in tension; arms in bending, torsion and tension."""
        return arm_statics(self, pose, joints, g)

    @classmethod
    def platform_axes(cls, pose: ca.SX, g: SimpleNamespace) -> ca.SX:  # noqa: ARG003
        """(3, m) unit directions of the studs on the platform, which here keeps its orientation."""
        return cls.limbs(g).axes()

    @classmethod
    def closure(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """Half of |A_i B_i|^2 - l^2: J_q,i is the rod times the arm's tangent, and J_x holds the rods."""
        rods = cls.rods(pose, joints, g)
        return (ca.sum1(rods * rods).T - cls.limbs(g).rod ** 2) / 2

    @classmethod
    def inverse_closed_form(cls, pose: ca.SX, g: SimpleNamespace, mode: Mode) -> ca.SX:
        """Of each limb."""
        return cls.limbs(g).inverse(cls.platform_points(pose, g), mode)

    @classmethod
    def joint_cosines_and_sines(cls, pose: ca.SX, g: SimpleNamespace, mode: Mode) -> tuple[ca.SX, ca.SX]:
        """Of the inverse model."""
        return cls.limbs(g).cosines_and_sines(cls.platform_points(pose, g), mode)

    @classmethod
    def j_q_closed_form(cls, pose: ca.SX, g: SimpleNamespace, mode: Mode) -> ca.SX:
        """(N cos q - M sin q) / 2, which is minus half the root that the branch keeps."""
        return -ca.DM(mode.branches) * cls.limb_roots(pose, g) / 2

    @classmethod
    def usual_branches(cls, home: Array, geometry: GeometryRecord) -> tuple[int, ...]:
        """Elbows out: +1 where the drive is ahead of the platform's point along `zero`, or level with it; else -1."""
        pose, (symbols, g) = ca.SX.sym("pose", len(cls.pose_names)), cls.Geometry.symbols()
        limbs = cls.limbs(g)
        ahead = ca.sum1((limbs.actuators - cls.platform_points(pose, g)) * limbs.zero).T
        found = np.array(ca.Function("ahead", [pose, symbols], [ahead])(home, geometry.vector()))[:, 0]
        return tuple(-1 if v < -_LEVEL * geometry.size else 1 for v in found.tolist())

    @classmethod
    def limb_roots(cls, pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """Of `Limbs.terms`."""
        return cls.limbs(g).terms(cls.platform_points(pose, g))[3]

    @classmethod
    def reach(cls, pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """Of each arm and rod [m]."""
        return cls.limbs(g).reach(cls.platform_points(pose, g))

    @classmethod
    def limb_lines(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:
        """Base, arms and rods as polylines, each rod one line."""
        base, elbows, platform = cls.limbs(g).actuators, cls.limbs(g).elbows(joints), cls.platform_points(pose, g)
        count = joints.numel()
        arms = {f"arm {i + 1}": ca.horzcat(base[:, i], elbows[:, i]) for i in range(count)}
        rods = {f"rod {i + 1}": ca.horzcat(elbows[:, i], platform[:, i]) for i in range(count)}
        return {"base": base[:, [*range(count), 0]]} | arms | rods
