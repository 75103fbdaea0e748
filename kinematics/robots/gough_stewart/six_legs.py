"""A platform of six freedoms on six legs, each of which has a length that the joints determine.

Pose [x, y, z, roll, pitch, yaw] with R = Rz(yaw) Ry(pitch) Rx(roll); twists are (v of the tool point, omega) in the
base's frame. The legs are a Gough-Stewart platform's own, or a Hexa's rods on the elbows that its arms place.
"""

from __future__ import annotations

from abc import abstractmethod
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from kinematics.arrays import Array, together
from kinematics.machine import Bodies, Member, Particle, mass_points, platform, shared_joints
from kinematics.mathematics import angles, rotation, turn
from kinematics.model import Mechanism, reached
from kinematics.robots.gough_stewart.forward import ForwardSolution, solve_forward


class SixLegs(Mechanism):
    """The base of the Gough-Stewart platform and the Hexa."""

    geometry: Any
    inertia: Any
    pose_names = ("x", "y", "z", "roll", "pitch", "yaw")
    joint_names = ("q1", "q2", "q3", "q4", "q5", "q6")
    rotations = (3, 4, 5)

    @property
    def characteristic_length(self) -> float:
        """Mean distance of the B_i from their centroid [m]."""
        points = np.array(self.geometry.platform_points)
        return float(np.linalg.norm(points - points.mean(axis=0), axis=1).mean())

    @abstractmethod
    def leg_errors(self, pose: Array, joints: Array) -> tuple[Array, Array]:
        """(k, 6) missing length of each leg [m], and the legs' inverse Jacobian (k, 6, 6) [8.20]."""

    @abstractmethod
    def leg_sizes(self, joints: Array) -> tuple[Array, Array]:
        """(k,) mean leg length, and the largest number that rounding of an error comes from [m]."""

    @staticmethod
    def pose_rate_map(pose: ca.SX) -> ca.SX:
        """Euler-angle rates from omega; not defined where the pitch is a quarter turn."""
        cp, sp, cy, sy = ca.cos(pose[4]), ca.sin(pose[4]), ca.cos(pose[5]), ca.sin(pose[5])
        rates = ca.vertcat(
            ca.horzcat(cy / cp, sy / cp, 0), ca.horzcat(-sy, cy, 0), ca.horzcat(cy * sp / cp, sy * sp / cp, 1)
        )
        return ca.diagcat(ca.SX.eye(3), rates)

    @staticmethod
    @abstractmethod
    def platform_points(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(3, 6) B_i."""

    def platform_bodies(
        self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX, bodies: Bodies
    ) -> None:
        """Adds the platform and the payload at the tool point."""
        points, mass = self.platform_points(pose, g), self.inertia.platform_mass
        share = self.inertia.platform_joint if mass is None else mass / 6
        bodies.particles.extend(Particle("platform", share, points[:, i]) for i in range(6))
        if mass is None:
            rest, moved = (self.members(at, joints, g)[-1] for at in (ca.SX(6, 1), pose))
            own = mass_points(rest, moved, self.structure.of(moved).density)
            bodies.particles.extend(Particle("platform", *point) for point in own)
        bodies.particles.append(Particle("platform", payload, pose[:3]))

    def platform_member(self, points: ca.SX, g: SimpleNamespace) -> Member:
        """The platform, held at the B_i (3, 6)."""
        numbers = np.array(self.geometry.platform_points)
        shapes = platform(points, numbers, g.plate_thickness)
        return Member("platform", tuple(shared_joints("B", numbers)), "plate", shapes)

    @staticmethod
    def moved(pose: Array, twist: Array) -> Array:
        """(k, 6) poses after small displacements (k, 6), the turn about axes of the base's frame."""
        turned = turn(twist[:, 3:]) @ rotation(pose[:, 3:])
        return np.concatenate([pose[:, :3] + twist[:, :3], angles(turned)], axis=1)

    def apart(self, first: Array, second: Array) -> Array:
        """As everywhere here; the angle by the chord between the orientations."""
        first, second = self._poses(first), self._poses(second)
        chord = np.linalg.norm(rotation(first[..., 3:]) - rotation(second[..., 3:]), axis=(-2, -1)) / np.sqrt(2)
        shift = np.abs(first[..., :3] - second[..., :3]).max(axis=-1) / self.geometry.size
        result: Array = np.maximum(chord, shift)
        return result

    def working_forward(self, joints: Array) -> Array:
        """(..., 6) -> (..., 6): continued from home."""
        return reached(self, self._joints(joints), self.home)

    def newton(self, joints: Array, start: Array | None = None, iterations: int = 30) -> ForwardSolution:
        """Newton's method from a start near, [8.6.4.2]: where it converged, in how many steps and with which error.

        It may end in any assembly mode; `forward` stays in one.

        Args:
            joints: (..., 6) [m or rad].
            start: (..., 6); home if not given.
            iterations: the most steps.
        """
        begin = self._poses(self.home if start is None else start)
        return solve_forward(self, *together(self._joints(joints), begin), iterations)
