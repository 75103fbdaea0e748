"""Hexa (Pierrot; Khalil and Dombre 2002, 8.5.3): six rotary arms, each with one rod, carry a platform of six freedoms.

Given the arms' angles the elbows are fixed, and what remains is a Gough-Stewart platform: base joints at the elbows,
legs as long as the rods. Its code gives the forward model.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.evaluation import evaluate
from kinematics.machine import TURN, Bodies, GeometryRecord, Member, angle, length
from kinematics.margins import ANGLE_ACCURACY, PASSIVE_JOINT, ROTATIONAL_STIFFNESS, STANDARD
from kinematics.mathematics import rotation_symbolic
from kinematics.model import Build, FviBounds, Model, by_name
from kinematics.robots.gough_stewart import (
    GoughStewart,
    GoughStewartGeometry,
    SixLegs,
    apart,
    matched_pose,
    symmetric_points,
)
from kinematics.robots.shared import (
    ArmInertia,
    ArmRanges,
    Limbs,
    RotaryLimbs,
    arms_and_rods,
    columns,
    limb_members,
    motors,
    radial_directions,
    twins,
    upright_limbs,
)

_BASE = symmetric_points(0.28, TURN / 18, 0.0)
_PLATFORM = symmetric_points(0.10, TURN / 18, TURN / 6)
_DEPTH = 0.55 / (0.300 + 0.650)  # of the default home, over arm and rod
_IDENTITY = ca.SX(ca.DM.eye(4).reshape((16, 1)))


@dataclass(frozen=True)
class HexaGeometry(GeometryRecord):
    """A robot of a Delta's size: an assumption of this project, as the chapter gives no dimensions.

    Raises:
        InvalidGeometry: as for any geometry; or the platform's points are on one line, about which the platform could
            turn freely; or two limbs have the same drive, arm and platform point.
    """

    base_points: tuple[tuple[float, ...], ...] = length(_BASE, minimum=None, doc="P_i, on the arms' axes")
    platform_points: tuple[tuple[float, ...], ...] = length(
        _PLATFORM[-1:] + _PLATFORM[:-1], minimum=None, doc="B_i, in the platform's frame"
    )
    arm_azimuths: tuple[float, ...] = angle(
        tuple(TURN / 3 * (i // 2) for i in range(6)), doc="of the arms' vertical planes, outward"
    )
    arm_length: float = length(0.300, doc="L, drive to elbow")
    rod_length: float = length(0.650, doc="l, rod")
    arm_radius: float = length(0.020, doc="of the arms' tubes, outside")
    arm_wall: float = length(0.002, doc="of the arms' tubes")
    rod_radius: float = length(0.006, doc="of the rods' tubes, outside")
    rod_wall: float = length(0.0015, doc="of the rods' tubes")
    plate_thickness: float = length(0.008, doc="of the platform")
    motor_radius: float = length(0.040, doc="of the motors")
    motor_length: float = length(0.080, doc="of the motors along their axes, without their round ends")

    def __post_init__(self) -> None:
        super().__post_init__()
        points = np.array(self.platform_points)
        sizes = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        if sizes[1] <= 1e-9 * sizes[0]:
            raise self.invalid("platform_points", self.platform_points, "points that are not on one line")
        turned = self.arm_length * np.exp(1j * np.array(self.arm_azimuths))
        limbs = np.column_stack([self.base_points, turned.real, turned.imag, points])
        if pair := twins(limbs, np.abs(limbs).max()):
            reason = f"limbs {pair[0]} and {pair[1]} have the same drive and arm, so det J_x is zero at every pose"
            raise self.invalid("platform_points", self.platform_points, f"a different point for each limb: {reason}")


@dataclass(frozen=True)
class HexaInertia(ArmInertia):
    """The masses of the arms, with one rod each, and of the platform.

    Attributes:
        platform_joint, platform_mass: as for `GoughStewart`; the payload is a particle at the tool point.
    """

    arm_hub: float = 0.665
    arm_joint: float = 0.0416
    rod_joint: float = 0.039
    platform_joint: float = 0.045
    platform_mass: float | None = None


class Hexa(SixLegs, RotaryLimbs):
    """Pose [x, y, z, roll, pitch, yaw], joints q1..q6 measured from e_z outward. Elbows are out, unless `home_joints`
    choose otherwise.

    Orientation and twist are defined as for the Gough-Stewart platform.
    """

    Geometry = HexaGeometry
    Inertia = HexaInertia
    Ranges = ArmRanges
    geometry: HexaGeometry
    inertia: HexaInertia
    joint_units = ("rad",) * 6
    fvi_bounds = FviBounds(joint_speed=20.0, joint_effort=127.0, speed=1.0, force=50.0)
    margins = by_name(*STANDARD, ANGLE_ACCURACY, ROTATIONAL_STIFFNESS, PASSIVE_JOINT)

    @staticmethod
    def default_home(geometry: HexaGeometry) -> tuple[float, ...]:
        """The platform below the base, by a share of arm and rod together, in the rotation that matches it best."""
        base, platform = (np.array(p) for p in (geometry.base_points, geometry.platform_points))
        below = _DEPTH * (geometry.arm_length + geometry.rod_length)
        return tuple(matched_pose(base, platform, np.array([0.0, 0.0, -below])).tolist())

    @staticmethod
    def limbs(g: SimpleNamespace) -> Limbs:
        """Arms in vertical planes."""
        radial, _ = radial_directions(g.arm_azimuths)
        return upright_limbs(ca.reshape(g.base_points, 3, 6), radial, g)

    @staticmethod
    def platform_points(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(3, 6) B_i."""
        result: ca.SX = columns(pose[:3], 6) + rotation_symbolic(pose[3:]) @ ca.reshape(g.platform_points, 3, 6)
        return result

    @classmethod
    def platform_axes(cls, pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """Unit directions parallel to the arms' axes when the platform is not turned."""
        return rotation_symbolic(pose[3:]) @ cls.limbs(g).axes()

    @staticmethod
    def _as_hexapod(joints: ca.SX, g: SimpleNamespace) -> SimpleNamespace:
        """The Gough-Stewart platform whose base joints are the elbows and whose legs are the rods."""
        elbows = ca.vec(Hexa.limbs(g).elbows(joints))
        return SimpleNamespace(base_points=elbows, platform_points=g.platform_points, Z=_IDENTITY, E=_IDENTITY)

    @classmethod
    def closure_by_twist(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """The rod's and its moment about the tool point: regular at a pitch of a quarter turn too."""
        rods, ends = -cls.rods(pose, joints, g), cls.platform_points(pose, g) - columns(pose[:3], 6)
        moments = ca.horzcat(*(ca.cross(ends[:, i], rods[:, i]) for i in range(6)))
        return ca.vertcat(rods, moments).T

    @staticmethod
    def scales(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """L l for each J_q,i; the Gough-Stewart platform's 8 rho^3 times l^6 for det J_x."""
        _, hexapod = GoughStewart.scales(g)
        return ca.repmat(g.arm_length * g.rod_length, 6, 1), hexapod * g.rod_length**6

    def bodies(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
        """Arms, rods, platform, payload."""
        bodies = arms_and_rods(self, pose, joints, g, ["platform"] * 6)
        self.platform_bodies(pose, joints, g, payload, bodies)
        return bodies

    def members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
        """Arms, rods and platform."""
        platform = self.platform_member(self.platform_points(pose, g), g)
        return [*limb_members(type(self), pose, joints, g, None), platform]

    def base_members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:  # noqa: ARG002
        """The motors."""
        return motors(self.limbs(g), g)

    @classmethod
    def skeleton(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:
        """Base, arms, rods, platform, tool."""
        ends = cls.platform_points(pose, g)
        lines = cls.limb_lines(pose, joints, g) | {"platform": ends[:, [*range(6), 0]]}
        return lines | {"tool": ca.horzcat(ca.sum2(ends) / 6, pose[:3])}

    # The forward model.

    def leg_errors(self, pose: Array, joints: Array) -> tuple[Array, Array]:
        """(k, 6) missing length of each rod from elbow to platform [m], and the hexapod's Jacobian."""
        errors, jacobian = evaluate(self.program(_rods_as_legs), pose, joints)
        return errors, jacobian

    def leg_sizes(self, joints: Array) -> tuple[Array, Array]:
        """(k,) the rods' length, and the largest number that rounding of an error comes from [m]."""
        rods = np.full(len(joints), self.geometry.rod_length)
        points = np.abs(self.geometry.base_points).max() + np.abs(self.geometry.platform_points).max()
        return rods, rods + self.geometry.arm_length + points

    def assembly_modes(self, joints: Array) -> Array:
        """(6,) -> (k, 6), every real pose with these joints, at most 40; the nearest to home first.

        It takes some seconds, as each set of joints gives another hexapod.

        Raises:
            SingularArchitecture: elbows and platform are dependent at every pose, so poses are not isolated.
            SelfMotion: with these joints locked the platform can move.
            LostPaths: the continuation that finds them could not be certified.
        """
        joints = self._one(joints)
        if not np.isfinite(joints).all():
            return np.empty((0, 6))
        (elbows,) = evaluate(self.program(_elbows), joints)
        hexapod = GoughStewart(GoughStewartGeometry(tuple(map(tuple, elbows.tolist())), self.geometry.platform_points))
        modes = hexapod.assembly_modes(np.full(6, self.geometry.rod_length))
        away = apart(modes, self.home[None], self.characteristic_length)[:, 0]
        return modes[np.argsort(away, kind="stable")]


def _elbows(robot: Hexa, model: Model) -> Build:
    return [model.joints], [robot.limbs(model.g).elbows(model.joints).T]


def _rods_as_legs(robot: Hexa, model: Model) -> Build:
    hexapod = robot._as_hexapod(model.joints, model.g)
    lengths = GoughStewart.leg_lengths(model.pose, hexapod)
    jacobian = -GoughStewart.closure_by_twist(model.pose, model.joints, hexapod)
    return [model.pose, model.joints], [model.g.rod_length - lengths, jacobian]
