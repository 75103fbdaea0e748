"""Planar 3-PRR (Khalil and Dombre 2002, figure 8.4b)."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.machine import TURN, Bodies, JointRanges, Member, Pair, Rod, Rotor, angle, bar, length, rod_mass
from kinematics.model import FviBounds, Mode
from kinematics.robots.planar.planar import AZIMUTHS, Planar, PlanarGeometry, PlanarInertia
from kinematics.robots.shared import radial_directions


@dataclass(frozen=True)
class Planar3PRRGeometry(PlanarGeometry):
    """Rails along the tangents of the base's circle."""

    rod_lengths: tuple[float, ...] = length((0.55,) * 3, doc="l_i, slider to platform")
    rail_radius: float = length(0.010, doc="of the rails")
    slide_radius: float = length(0.020, doc="of the slides around their rails")
    slide_length: float = length(0.060, doc="of the slides along their rails, without their round ends")
    rail_angles: tuple[float, ...] = angle(tuple(a + TURN / 4 for a in AZIMUTHS), doc="of the rails, from x")

    def _drives(self) -> list[Array]:
        """Where each rail runs, by its distance from the origin and its direction; and the rod."""
        ahead = np.exp(1j * np.array(self.rail_angles))
        aside = (ahead.conj() * (np.array(self.base_points) @ [1, 1j])).imag
        return [aside, self._size() * ahead.real, self._size() * ahead.imag, np.array(self.rod_lengths)]


@dataclass(frozen=True)
class Planar3PRRRanges(JointRanges):
    """Rails, in metres: an assumption of this project. All pivots turn freely."""

    joints: Pair | tuple[Pair, ...] = (-0.8, 0.2)


class Planar3PRR(Planar):
    """Pose [x, y, theta], joints q1..q3, the sliders' travels from A_i along their rails.

    Usual branch: each slider on the lower side, its rod leading up the rail to the platform.
    """

    Geometry = Planar3PRRGeometry
    Inertia = PlanarInertia
    Ranges = Planar3PRRRanges
    geometry: Planar3PRRGeometry
    joint_units = ("m",) * 3
    fvi_bounds = FviBounds(joint_speed=1.0, joint_effort=200.0, speed=0.3, force=50.0)

    @staticmethod
    def _rails(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """(3, 3) along and across."""
        return radial_directions(g.rail_angles)

    @staticmethod
    def circles(joints: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """About the sliders."""
        return Planar.base_points(g) + Planar3PRR._rails(g)[0] @ ca.diag(joints), g.rod_lengths

    @staticmethod
    def closure(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """Half of |C_i B_i|^2 - l_i^2."""
        rods = Planar3PRR.circles(joints, g)[0] - Planar.platform_points(pose, g)
        result: ca.SX = (ca.sum1(rods * rods).T - g.rod_lengths**2) / 2
        return result

    @staticmethod
    def _from_rails(pose: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """(3,) where each B_i is along and across its rail."""
        ends = Planar.platform_points(pose, g) - Planar.base_points(g)
        along, across = (ca.sum1(ends * d).T for d in Planar3PRR._rails(g))
        return along, across

    @staticmethod
    def inverse_closed_form(pose: ca.SX, g: SimpleNamespace, mode: Mode) -> ca.SX:
        """The smaller root, unless a branch says otherwise."""
        roots = Planar3PRR.limb_roots(pose, g)
        return Planar3PRR._from_rails(pose, g)[0] - ca.vertcat(*(b * roots[i] for i, b in enumerate(mode.branches)))

    @classmethod
    def limb_roots(cls, pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """How far each slider is from the foot of its platform point."""
        result: ca.SX = ca.sqrt(g.rod_lengths**2 - cls._from_rails(pose, g)[1] ** 2)
        return result

    @staticmethod
    def reach(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """How much longer each rod is than the way from B_i to its rail [m]."""
        result: ca.SX = g.rod_lengths - ca.fabs(Planar3PRR._from_rails(pose, g)[1])
        return result

    @staticmethod
    def scales(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """l_i for each J_q,i; `determinant_scale` times their product for det J_x."""
        return g.rod_lengths, Planar.determinant_scale(g) * g.rod_lengths[0] * g.rod_lengths[1] * g.rod_lengths[2]

    def base_members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:  # noqa: ARG002
        """A slide for each rod, and the rails, as long as the joints' ranges. A rail without a range is left out."""
        base, along, limits = self.base_points(g), self._rails(g)[0], self.ranges.limits(3)
        found = []
        for i, slide in enumerate(ca.horzsplit(self.circles(joints, g)[0])):
            held, half = f"A{i + 1}", g.slide_length / 2 * along[:, i]
            found.append(bar(f"slide {i + 1}", (held,), "", slide - half, slide + half, g.slide_radius))
            if np.isfinite(limits[i]).all():
                start, end = (base[:, i] + limit * along[:, i] for limit in limits[i])
                found.append(bar(f"rail {i + 1}", ("base", held), "", start, end, g.rail_radius))
        return found

    def bodies(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
        """Drives, rods and platform."""
        own, bodies = self.inertia, Bodies()
        slides, ends = self.circles(joints, g)[0], self.platform_points(pose, g)
        for i, link in enumerate(self.members(pose, joints, g)[:3]):
            bodies.rotors.append(Rotor(own.drive, joints[i]))
            tube = self.structure.of(link).density * self.link(slides[:, i], ends[:, i], g).area * g.rod_lengths[i]
            mass, middle = rod_mass(tube, own.link_joint, own.link_mass, own.rod_middle)
            bodies.rods.append(Rod(mass, middle, (f"slide {i + 1}", "platform"), slides[:, i], ends[:, i]))
        self.platform_bodies(pose, joints, g, payload, bodies)
        return bodies
