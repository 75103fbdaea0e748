"""Planar robots with three legs (Khalil and Dombre 2002, 8.5.1, figure 8.4): 3-RPR, 3-PRR and 3-RRR.

Pose [x, y, theta]. Given the joints, all three are the same problem: three platform points lie on three circles.
`planar_forward` solves it.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.evaluation import evaluate
from kinematics.machine import (
    LINEAR,
    TURN,
    Bodies,
    DriveTrain,
    GeometryRecord,
    InertiaRecord,
    LimbStatics,
    Member,
    Particle,
    Points,
    Tube,
    length,
    mass_points,
    platform,
    shared_joints,
)
from kinematics.margins import ANGLE_ACCURACY, ROTATIONAL_STIFFNESS, STANDARD
from kinematics.mathematics import distinct
from kinematics.model import Build, Mechanism, Model, by_name, joined_to_home
from kinematics.robots.planar.forward import placements, rods_and_determinant
from kinematics.robots.shared import ALIKE, rod_statics, rods_of, twins

_AROUND = [0, 1, 2, 0]
_FAR = 1e60  # [m] or [rad], its fifth power still a double
AZIMUTHS = (-TURN / 4, TURN / 12, 5 * TURN / 12)


def triangle(radius: float, turn: float = 0.0) -> tuple[tuple[float, float], ...]:
    """(3, 2) corners of an equilateral triangle, at -90, 30 and 150 deg + `turn`."""
    corners = radius * np.exp(1j * (np.array(AZIMUTHS) + turn))
    return tuple((float(c.real), float(c.imag)) for c in corners)


@dataclass(frozen=True)
class PlanarGeometry(GeometryRecord):
    """Joint centres; the dimensions are assumptions of this project, as the chapter gives none.

    Raises:
        InvalidGeometry: as for any geometry; or all platform points coincide, or two legs do.
    """

    base_points: tuple[tuple[float, ...], ...] = length(triangle(0.5), minimum=None, doc="A_i, legs' base joints")
    platform_points: tuple[tuple[float, ...], ...] = length(
        triangle(0.15), minimum=None, doc="B_i, in the platform's frame"
    )
    link_radius: float = length(0.015, doc="of the legs' links, outside")
    link_wall: float = length(0.003, doc="of the legs' links")
    plate_thickness: float = length(0.010, doc="of the platform")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self._coincide(self.platform_points):
            reason = "about a common point the platform could turn freely"
            raise self.invalid("platform_points", self.platform_points, f"points that do not all coincide: {reason}")
        legs = np.column_stack([*self._drives(), self.platform_points])
        if pair := twins(legs, self._size()):
            reason = f"legs {pair[0]} and {pair[1]} have the same drive, so det J_x is zero at every pose"
            raise self.invalid("platform_points", self.platform_points, f"a different point for each leg: {reason}")

    def _size(self) -> float:
        return float(max(np.abs(self.base_points).max(), np.abs(self.platform_points).max()))

    def _coincide(self, points: Points) -> bool:
        return bool(np.ptp(np.array(points), axis=0).max() <= ALIKE * self._size())

    def _drives(self) -> list[Array]:
        """Columns (3,) or (3, k) in metres that are equal for two legs where their rods or links are, at any B_i."""
        return [np.array(self.base_points)]


@dataclass(frozen=True)
class PlanarInertia(InertiaRecord):
    """A small table-top robot: an assumption of this project, not a datasheet. SI units.

    Attributes:
        drive: a prismatic drive's moving inertia as seen at its joint [kg].
        link_joint: mass of the joint at each end of a link.
        link_mass: mass of each leg's link; None takes a tube, of home's length where it changes, with its joints. If
            the link changes its length, half is at each end.
        platform_joint: mass of the platform's part of each joint, at B_i.
        platform_mass: three equal particles at the B_i; None takes the plate and the joints. The payload is a particle
            at the tool point.
        drive_train: screw, bearings and servo loop give way by 0.5 um for each N.
    """

    drive: float = 1.0
    link_joint: float = 0.03
    link_mass: float | None = None
    platform_joint: float = 0.137
    platform_mass: float | None = None
    drive_train: DriveTrain = field(default=replace(LINEAR, stiffness=2e6), kw_only=True)


class Planar(Mechanism):
    """Three legs in the plane z = 0; the base of the three robots."""

    geometry: PlanarGeometry
    inertia: PlanarInertia
    pose_names = ("x", "y", "theta")
    joint_names = ("q1", "q2", "q3")
    rotations = (2,)
    margins = by_name(*STANDARD, ANGLE_ACCURACY, ROTATIONAL_STIFFNESS)

    @property
    def characteristic_length(self) -> float:
        """Root mean square distance of the B_i from their centroid [m]."""
        points = np.array(self.geometry.platform_points)
        return float(np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean()))

    @staticmethod
    def default_home(geometry: PlanarGeometry) -> tuple[float, ...]:
        """The platform's centroid on the base's, not turned."""
        base, platform = (np.mean(points, axis=0) for points in (geometry.base_points, geometry.platform_points))
        return (*(base - platform).tolist(), 0.0)

    @staticmethod
    @abstractmethod
    def circles(joints: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """Centres (3, 3), columns in the plane z = 0, and radii (3,) of the circles on which the B_i lie."""

    @staticmethod
    def base_points(g: SimpleNamespace) -> ca.SX:
        """(3, 3) A_i, in the plane z = 0."""
        return ca.vertcat(ca.reshape(g.base_points, 2, 3), ca.SX(1, 3))

    @staticmethod
    def platform_points(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(3, 3) B_i, in the plane z = 0."""
        c, s = ca.cos(pose[2]), ca.sin(pose[2])
        turned = ca.vertcat(ca.horzcat(c, -s), ca.horzcat(s, c)) @ ca.reshape(g.platform_points, 2, 3)
        return ca.vertcat(turned + ca.repmat(pose[:2], 1, 3), ca.SX(1, 3))

    @staticmethod
    def determinant_scale(g: SimpleNamespace) -> ca.SX:
        """3/2 sqrt(3) rho, rho as in `characteristic_length`: no determinant of three unit forces' lines is larger.

        By Hadamard's inequality on columns of squared sums 3 (both forces) and 3 rho^2 (moments about the centroid).
        """
        points = ca.reshape(g.platform_points, 2, 3)
        result: ca.SX = 1.5 * ca.sqrt(ca.sumsqr(points - ca.repmat(ca.sum2(points) / 3, 1, 3)))
        return result

    def platform_bodies(
        self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX, bodies: Bodies
    ) -> None:
        """Adds platform and payload."""
        points, mass = self.platform_points(pose, g), self.inertia.platform_mass
        share = self.inertia.platform_joint if mass is None else mass / 3
        bodies.particles.extend(Particle("platform", share, points[:, i]) for i in range(3))
        if mass is None:
            rest, moved = (self.members(at, joints, g)[-1] for at in (ca.SX(3, 1), pose))
            own = mass_points(rest, moved, self.structure.of(moved).density)
            bodies.particles.extend(Particle("platform", *point) for point in own)
        bodies.particles.append(Particle("platform", payload, ca.vertcat(pose[:2], 0)))

    def members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
        """Each leg's links, from the base joint or the slide to the platform, and the platform, all in one plane."""
        ends, centres = self.platform_points(pose, g), self.circles(joints, g)[0]
        held = shared_joints("B", np.array(self.geometry.platform_points))
        links = [
            Member(f"rod {i + 1}", (f"A{i + 1}", held[i]), "link", (self.link(centres[:, i], ends[:, i], g),))
            for i in range(3)
        ]
        shapes = platform(ends, np.array(self.geometry.platform_points), g.plate_thickness)
        return [*links, Member("platform", tuple(held), "plate", shapes)]

    def statics(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[LimbStatics]:
        """Each leg's link in tension, on its drive. Only the freedoms in the plane count."""
        members = self.members(pose, joints, g)
        centres, radii = self.circles(joints, g)
        rods, lengths = self.platform_points(pose, g) - centres, radii + 0 * joints
        gaps = (ca.sum1(rods * rods).T - radii**2) / 2
        along, per_length = rods @ ca.diag(1 / lengths), ca.diag(1 / lengths)
        wrenches, efforts = (ca.jacobian(gaps, v).T @ per_length for v in (pose, joints))
        return [
            rod_statics(rods_of(i, members), self.structure, -wrenches[:, i], along[:, i], lengths[i], efforts[:, i])
            for i in range(3)
        ]

    @staticmethod
    def link(start: ca.SX, end: ca.SX, g: SimpleNamespace) -> Tube:
        """A leg's link."""
        return Tube(start, end, g.link_radius, g.link_wall)

    @classmethod
    def skeleton(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:
        """Base, the legs from base joint over the circle's centre to the platform, platform, tool."""
        base, ends, centres = cls.base_points(g), cls.platform_points(pose, g), cls.circles(joints, g)[0]
        lines = {"base": base[:, _AROUND], "platform": ends[:, _AROUND]}
        lines |= {f"leg {i + 1}": ca.horzcat(base[:, i], centres[:, i], ends[:, i]) for i in range(3)}
        return lines | {"tool": ca.horzcat(ca.sum2(ends) / 3, ca.vertcat(pose[:2], 0))}

    # The forward model.

    def _problem(self, joints: Array) -> tuple[Array, Array, Array]:
        """(k, 3) joints -> complex centres (k, 3), radii (k, 3), and the platform's points (3,)."""

        x, y, radii = evaluate(self.program(_circles), _bounded(joints))
        return x + 1j * y, radii, np.array(self.geometry.platform_points) @ [1, 1j]

    def working_forward(self, joints: Array) -> Array:
        """(..., 3) -> (..., 3): the pose of home's assembly mode.

        Far from home several modes may be joined to it. The nearest is returned; `near` can choose another one.
        """
        joints = self._joints(joints)
        flat = _bounded(joints).reshape(-1, 3)
        rows, p, theta = placements(*self._problem(flat))
        return joined_to_home(self, rows, _poses(p, theta), flat).reshape(joints.shape)

    def assembly_modes(self, joints: Array) -> Array:
        """(3,) -> (k, 3), every isolated real pose with these joints, at most six; the nearest to `home` first."""
        joints = self._one(joints)
        centres, radii, points = self._problem(joints[None])
        rows, p, theta = placements(centres, radii, points, every=True)
        det = rods_and_determinant(p, theta, centres[rows], points)[2]
        length = self.characteristic_length
        turn = np.exp(1j * theta)
        apart = np.abs(p[:, None] - p) / length + np.abs(turn[:, None] - turn)
        kept = distinct(apart, det / (length * np.prod(radii) + 1e-300))
        away = np.abs(p - complex(*self.home[:2])) / length + np.abs(turn - np.exp(1j * self.home[2]))
        return _poses(p, theta)[sorted(kept, key=lambda i: away[i])]


def _circles(robot: Planar, model: Model) -> Build:
    centres, radii = robot.circles(model.joints, model.g)
    return [model.joints], [centres[0, :].T, centres[1, :].T, radii + 0 * model.joints]


def _bounded(rows: Array) -> Array:
    """(..., 3) with NaN in place of rows that are infinite, or so large that squares and products would overflow."""
    return np.where((np.abs(rows) < _FAR).all(axis=-1, keepdims=True), rows, np.nan)


def _poses(p: Array, theta: Array) -> Array:
    return np.stack([p.real, p.imag, theta], axis=-1)
