"""Gough-Stewart platform, six UPS legs (Khalil and Dombre 2002, chapter 8; equation numbers are the chapter's).

Pose [x, y, z, roll, pitch, yaw] of the tool frame R_E in the reference frame R_f, R = Rz(yaw) Ry(pitch) Rx(roll);
twists (v of O_E, omega) and wrenches (force, moment about O_E) are expressed in R_f. Joints are the leg lengths.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.errors import InvalidShape
from kinematics.machine import (
    TURN,
    Bodies,
    LimbStatics,
    Member,
    Particle,
    PassiveJoint,
    Rotor,
    Tube,
    platform,
    shared_joints,
)
from kinematics.margins import ANGLE_ACCURACY, PASSIVE_JOINT, ROTATIONAL_STIFFNESS, STANDARD
from kinematics.mathematics import rotation_symbolic
from kinematics.model import FviBounds, Mechanism, Mode, Model, by_name
from kinematics.robots.gough_stewart.forward import ForwardSolution, assembly_modes, matched_pose
from kinematics.robots.gough_stewart.geometry import GoughStewartGeometry, GoughStewartInertia, GoughStewartRanges
from kinematics.robots.gough_stewart.links import links
from kinematics.robots.gough_stewart.six_legs import SixLegs
from kinematics.robots.shared import rod_statics

_SCREW = ("x", "y", "z", "about x", "about y", "about z")


class GoughStewart(SixLegs):
    """Pose [x, y, z, roll, pitch, yaw], joints q1..q6, the leg lengths |A_i B_i|.

    A leg reaches every point except its own base joint. The limits of its stroke are in the margin `joint_travel`.
    """

    Geometry = GoughStewartGeometry
    Inertia = GoughStewartInertia
    Ranges = GoughStewartRanges
    geometry: GoughStewartGeometry
    inertia: GoughStewartInertia
    ranges: GoughStewartRanges
    joint_units = ("m",) * 6
    fvi_bounds = FviBounds(joint_speed=1.0, joint_effort=2000.0, speed=0.3, force=500.0)
    margins = by_name(*STANDARD, ANGLE_ACCURACY, ROTATIONAL_STIFFNESS, PASSIVE_JOINT)

    @staticmethod
    def default_home(geometry: GoughStewartGeometry) -> tuple[float, ...]:
        """The platform above the base, with the rotation that matches the base best.

        It is along the normal of the base's mean plane, on the side of R_0's z axis (or of x, or of y, if z is in that
        plane). The distance is three quarters of the sum of the mean radii.
        """
        base, platform = geometry.in_reference_frame(), geometry.in_tool_frame()
        a, b = base - base.mean(axis=0), platform - platform.mean(axis=0)
        normal = np.linalg.svd(a)[2][2]
        components = np.array(geometry.Z)[:3, :3].T @ normal
        signs = [c for c in components[[2, 0, 1]] if abs(c) > 1e-9]
        radii = sum(np.linalg.norm(points, axis=1).mean() for points in (a, b))
        return tuple(matched_pose(base, platform, 0.75 * radii * math.copysign(1.0, signs[0]) * normal).tolist())

    # Points.

    @staticmethod
    def base_points(g: SimpleNamespace) -> ca.SX:
        """(3, 6) A_i in R_f; [8.6]."""
        z = ca.reshape(g.Z, 4, 4).T
        result: ca.SX = z[:3, :3] @ ca.reshape(g.base_points, 3, 6) + ca.repmat(z[:3, 3], 1, 6)
        return result

    @staticmethod
    def tool_points(g: SimpleNamespace) -> ca.SX:
        """(3, 6) B_i in R_E, by the inverse of E; [8.7] prints E itself."""
        e = ca.reshape(g.E, 4, 4).T
        result: ca.SX = e[:3, :3].T @ (ca.reshape(g.platform_points, 3, 6) - ca.repmat(e[:3, 3], 1, 6))
        return result

    @staticmethod
    def platform_points(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(3, 6) B_i in R_f."""
        return ca.repmat(pose[:3], 1, 6) + rotation_symbolic(pose[3:]) @ GoughStewart.tool_points(g)

    @staticmethod
    def legs(pose: ca.SX, g: SimpleNamespace, twist: ca.SX | None = None) -> ca.SX:
        """(3, 6) A_i B_i in R_f; [8.10]. With a small twist: after that displacement, to first order."""
        ends = rotation_symbolic(pose[3:]) @ GoughStewart.tool_points(g)
        place = pose[:3]
        if twist is not None:
            ends, place = ends + ca.skew(twist[3:]) @ ends, place + twist[:3]
        return ends + ca.repmat(place, 1, 6) - GoughStewart.base_points(g)

    # The closure and its closed forms.

    @staticmethod
    def closure(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """q_i - |A_i B_i|: J_q is the identity and J_x the inverse Jacobian [8.20]."""
        return joints - GoughStewart.leg_lengths(pose, g)

    @classmethod
    def closure_by_twist(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """By a small displacement of the platform itself: regular at a pitch of a quarter turn too."""
        twist = ca.SX.sym("twist", 6)
        legs = cls.legs(pose, g, twist)
        derivative = ca.jacobian(joints - _lengths(legs), twist)
        return ca.substitute(derivative, twist, ca.SX.zeros(6))

    def cleared_j_x(self) -> tuple[ca.SX, ca.SX]:
        """Rows of half the squared lengths, which are polynomial; divided by the lengths they are J_x."""
        model, twist = self.model(), ca.SX.sym("twist", 6)
        squares = ca.sum1(self.legs(model.pose, model.g, twist) ** 2).T / 2
        return ca.substitute(ca.jacobian(squares, twist), twist, ca.SX.zeros(6)), model.inverse

    @staticmethod
    def leg_lengths(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(6,) [8.11]."""
        return _lengths(GoughStewart.legs(pose, g))

    @staticmethod
    def inverse_closed_form(pose: ca.SX, g: SimpleNamespace, mode: Mode) -> ca.SX:  # noqa: ARG004
        """[8.11]; unique, as a length is positive."""
        return GoughStewart.leg_lengths(pose, g)

    @staticmethod
    def reach(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """The leg itself: it reaches everything but its own base joint [m]."""
        return GoughStewart.leg_lengths(pose, g)

    @staticmethod
    def scales(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """1 for J_q; 8 rho^3 for det J_x, rho the root mean square distance of the B_i from their centroid.

        By Hadamard's inequality on columns of squared sums 6 and 6 rho^2 (moments taken about the centroid).
        """
        points = ca.reshape(g.platform_points, 3, 6)
        centred = points - ca.repmat(ca.sum2(points) / 6, 1, 6)
        mean_square = ca.sumsqr(centred) / 6
        return ca.SX.ones(6), 8 * mean_square * ca.sqrt(mean_square)

    def inverse(self, pose: Array) -> Array:
        """(..., 6) -> (..., 6) leg lengths [m]; a NaN row where a leg has no length."""
        return self._possible(super().inverse(pose))

    @staticmethod
    def _possible(joints: Array) -> Array:
        possible = ((joints > 0.0) & np.isfinite(joints)).all(axis=-1, keepdims=True)
        return np.where(possible, joints, np.nan)

    # Rates and forces.

    def leg_rates(self, pose: Array, twist: Array) -> Array:
        """(..., 6), (..., 6) -> (..., 6) leg rates [m/s] from the twist of R_E; [8.12]."""
        result: Array = np.einsum("...ij,...j->...i", self.inverse_jacobian(pose), _six(twist, "twist", _SCREW))
        return result

    def legs_wrench(self, pose: Array, forces: Array) -> Array:
        """(..., 6), (..., 6) -> (..., 6) the wrench that the legs exert on the platform; [8.26].

        Args:
            forces: along the legs [N], positive where a leg pushes.

        Returns:
            force [N] and moment about O_E [N m].
        """
        result: Array = np.einsum(
            "...ij,...i->...j", self.inverse_jacobian(pose), _six(forces, "leg forces", self.joint_names)
        )
        return result

    def leg_forces(self, pose: Array, external_wrench: Array) -> Array:
        """(..., 6), (..., 6) -> (..., 6) leg forces [N] that balance an external wrench on the platform.

        The legs' own wrench is the opposite of the external one, so [8.26] enters with a minus sign. NaN on a
        singularity.
        """
        transposed = np.swapaxes(self.inverse_jacobian(pose), -1, -2)
        wrench = np.broadcast_to(_six(external_wrench, "wrench", _SCREW), transposed.shape[:-1])
        values = np.linalg.svd(np.nan_to_num(transposed), compute_uv=False)
        singular: Array = values[..., -1] <= 6.0 * np.finfo(float).eps * values[..., 0]
        safe = np.where(singular[..., None, None], np.eye(6), transposed)
        return np.where(singular[..., None], np.nan, np.linalg.solve(safe, -wrench[..., None])[..., 0])

    # The forward model.

    def lengths_and_jacobian(self, pose: Array) -> tuple[Array, Array]:
        """Leg lengths (..., 6) and the inverse Jacobian (..., 6, 6) [8.20] at once."""
        lengths, jacobian = self._evaluate(_newton, pose)
        return lengths, jacobian

    def leg_errors(self, pose: Array, joints: Array) -> tuple[Array, Array]:
        """(k, 6) missing length of each leg [m], and the inverse Jacobian (k, 6, 6)."""
        lengths, jacobian = self.lengths_and_jacobian(pose)
        return joints - lengths, jacobian

    def leg_sizes(self, joints: Array) -> tuple[Array, Array]:
        """(k,) mean leg length, and the largest number that rounding of a leg's length comes from [m]."""
        points = (self.geometry.in_reference_frame(), self.geometry.in_tool_frame())
        return joints.mean(axis=1), joints.max(axis=1) + sum(float(np.abs(p).max()) for p in points)

    def working_forward(self, joints: Array) -> Array:
        """(..., 6) -> (..., 6): continued from home; NaN where a length is not positive."""
        return super().working_forward(self._possible(self._joints(joints)))

    def newton(self, joints: Array, start: Array | None = None, iterations: int = 30) -> ForwardSolution:
        """As everywhere here; NaN where a length is not positive."""
        return super().newton(self._possible(self._joints(joints)), start, iterations)

    def assembly_modes(self, joints: Array) -> Array:
        """(6,) -> (k, 6), every real pose with these leg lengths, at most 40; the nearest to home first.

        Raises:
            SelfMotion: the platform can move with its legs locked, so there are infinitely many.
            LostPaths: the continuation that finds them could not be certified.
        """
        joints = self._one(joints)
        return assembly_modes(self, self._possible(joints))

    # Masses and drawing.

    def conditions(self, records: Sequence[str] = ()) -> dict[str, Any]:
        """Home too, where the joints rest there."""
        at_home = {"home": self.home.tolist()} if self.ranges.rest is None else {}
        return super().conditions(records) | at_home

    def passive_joints(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[PassiveJoint]:
        """Universal joints on the base and spherical ones on the platform, mounted along the legs at `ranges.rest`."""
        rest = self.home if self.ranges.rest is None else (*self.ranges.rest, 0, 0, 0)
        rest_pose, legs = ca.SX(ca.DM(rest)), self.legs(pose, g)
        rests = self.legs(rest_pose, g)
        axes = rests @ ca.diag(1 / _lengths(rests))
        turned = rotation_symbolic(pose[3:]) @ (rotation_symbolic(rest_pose[3:]).T @ axes)
        return [
            PassiveJoint(held[:, i], legs[:, i], joints[i], end, swivels=False)
            for end, held in enumerate((axes, turned))
            for i in range(6)
        ]

    link_tree = links

    def bodies(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
        """Screws driven by the joints; rods, platform and payload carried by the pose."""
        i, bodies, legs = self.inertia, Bodies(), self.legs(pose, g)
        ends, shortest = self.platform_points(pose, g), self.ranges.limits(6)[:, 0]
        for k, leg in enumerate(self.members(pose, joints, g)[:6]):
            bodies.rotors.append(Rotor(i.drive * (TURN / i.screw_lead) ** 2, joints[k]))
            length = max(float(shortest[k]), 0.0) if i.rod_length is None else i.rod_length
            mass = self.structure.of(leg).density * leg.tube.area * length if i.rod_mass is None else i.rod_mass
            shares = {0.0: 1 / 6, 0.5: 4 / 6, 1.0: 1 / 6} if length else {0.0: 1.0}
            for place, share in shares.items():
                point = ends[:, k] - place * length / ca.norm_2(legs[:, k]) * legs[:, k]
                bodies.particles.append(Particle(leg.name, share * mass + (0.0 if place else i.rod_joint), point))
        self.platform_bodies(pose, joints, g, payload, bodies)
        return bodies

    def members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:  # noqa: ARG002
        """The legs and the platform. Legs to a common point are joined there."""
        below, above = (np.array(points) for points in (self.geometry.base_points, self.geometry.platform_points))
        held = zip(shared_joints("A", below), shared_joints("B", above), strict=True)
        base, ends = self.base_points(g), self.platform_points(pose, g)
        found = [
            Member(f"leg {i + 1}", names, "leg", (Tube(base[:, i], ends[:, i], g.leg_radius, g.leg_wall),))
            for i, names in enumerate(held)
        ]
        return [*found, self.platform_member(ends, g)]

    def statics(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[LimbStatics]:
        """Legs in tension, each a cylinder of the leg's own length."""
        members = self.members(pose, joints, g)
        legs, wrenches, efforts = self.legs(pose, g), self.closure_by_twist(pose, joints, g).T, -ca.SX.eye(6)
        along = legs @ ca.diag(1 / joints)
        return [
            rod_statics(members[i : i + 1], self.structure, wrenches[:, i], along[:, i], joints[i], efforts[:, i])
            for i in range(6)
        ]

    def base_members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:  # noqa: ARG002
        """The base: a plate, or bars to the legs' joints if these are not in one plane."""
        numbers = np.array(self.geometry.base_points)
        shapes = platform(self.base_points(g), numbers, g.plate_thickness)
        return [Member("base", ("base", *shared_joints("A", numbers)), "", shapes)]

    @staticmethod
    def skeleton(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:  # noqa: ARG004
        """Base and platform as closed polygons, the six legs, and the tool from the platform's centroid."""
        base = GoughStewart.base_points(g)
        ends = base + GoughStewart.legs(pose, g)
        around = [*range(6), 0]
        lines = {"base": base[:, around], "platform": ends[:, around]}
        lines.update({f"leg {i + 1}": ca.horzcat(base[:, i], ends[:, i]) for i in range(6)})
        lines["tool"] = ca.horzcat(ca.sum2(ends) / 6, pose[:3])
        return lines


def _newton(_: Mechanism, model: Model) -> list[ca.SX]:
    return [model.inverse, model.j_x]


def _lengths(legs: ca.SX) -> ca.SX:
    return ca.sqrt(ca.sum1(legs * legs)).T


def _six(values: Array, what: str, names: tuple[str, ...]) -> Array:
    array = np.asarray(values, dtype=float)
    if array.ndim == 0 or array.shape[-1] != 6:
        raise InvalidShape(what, names, array.shape)
    return array
