"""Planar 3-RPR (Khalil and Dombre 2002, figure 8.4a)."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace

import casadi as ca

from kinematics.machine import (
    AXES,
    ORIGIN,
    TURN,
    Bodies,
    Connection,
    JointRanges,
    Link,
    Member,
    Pair,
    Particle,
    Reference,
    Rotor,
    Tree,
    TreeJoint,
    length,
)
from kinematics.model import FviBounds, Mode
from kinematics.robots.planar.planar import Planar, PlanarGeometry, PlanarInertia, triangle


@dataclass(frozen=True)
class Planar3RPRGeometry(PlanarGeometry):
    """The platform is turned by a quarter turn, as home would be singular with two parallel similar triangles.

    Raises:
        InvalidGeometry: as for any planar robot; or all base points coincide.
    """

    platform_points: tuple[tuple[float, ...], ...] = length(
        triangle(0.15, TURN / 4), minimum=None, doc="B_i, in the platform's frame"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if self._coincide(self.base_points):
            reason = "about a common point the robot could turn freely"
            raise self.invalid("base_points", self.base_points, f"points that do not all coincide: {reason}")


@dataclass(frozen=True)
class Planar3RPRRanges(JointRanges):
    """Cylinders, in metres: an assumption of this project. All pivots turn freely."""

    joints: Pair | tuple[Pair, ...] = (0.2, 0.9)


class Planar3RPR(Planar):
    """Pose [x, y, theta], joints q1..q3, the leg lengths |A_i B_i|: prismatic drives between passive pivots."""

    Geometry = Planar3RPRGeometry
    Inertia = PlanarInertia
    Ranges = Planar3RPRRanges
    geometry: Planar3RPRGeometry
    joint_units = ("m",) * 3
    fvi_bounds = FviBounds(joint_speed=1.0, joint_effort=200.0, speed=0.3, force=50.0)

    @staticmethod
    def circles(joints: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """About the base joints."""
        return Planar.base_points(g), joints

    @staticmethod
    def closure(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """q_i - |A_i B_i|: J_q is the identity, J_x the legs as lines."""
        return joints - Planar3RPR.leg_lengths(pose, g)

    @staticmethod
    def inverse_closed_form(pose: ca.SX, g: SimpleNamespace, mode: Mode) -> ca.SX:  # noqa: ARG004
        """Unique, as a length is positive."""
        return Planar3RPR.leg_lengths(pose, g)

    @staticmethod
    def leg_lengths(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(3,); inf where the pose is infinite or a length's square overflows."""
        legs = Planar.platform_points(pose, g) - Planar.base_points(g)
        return ca.sqrt(ca.sum1(legs * legs)).T

    @staticmethod
    def reach(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """The leg itself: it reaches everything but its own base joint [m]."""
        return Planar3RPR.leg_lengths(pose, g)

    @staticmethod
    def scales(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """1 for J_q; `determinant_scale` for det J_x."""
        return ca.SX.ones(3), Planar.determinant_scale(g)

    def link_tree(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, reference: Reference) -> Tree:
        """Each leg turns about its base joint and slides along itself. Its angle counts from the reference."""
        base, ends = self.base_points(g), self.platform_points(pose, g)
        chain, connections = [], []
        for i, name in enumerate(self.joint_names):
            along = (ends[:, i] - base[:, i]) / ca.norm_2(ends[:, i] - base[:, i])
            before = reference(along)
            turned = ca.atan2(ca.cross(before, along)[2], ca.dot(before, along))
            turn = TreeJoint(f"leg {i + 1}", "hinge", AXES[2], base[:, i], turned)
            chain.append(Link(f"leg {i + 1}", None, (turn, TreeJoint(name, "slide", along, ORIGIN, joints[i]))))
            connections.append(Connection((f"leg {i + 1}", "platform"), ends[:, i]))
        place = ca.vertcat(pose[:2], 0)
        slides = (TreeJoint("xy"[k], "slide", AXES[k], ORIGIN, pose[k]) for k in range(2))
        chain.append(Link("platform", None, (*slides, TreeJoint("theta", "hinge", AXES[2], place, pose[2]))))
        return Tree(tuple(chain), connections=tuple(connections))

    def members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
        """Legs by the links' names."""
        return [m._replace(link=m.name.replace("rod", "leg")) for m in super().members(pose, joints, g)]

    def bodies(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
        """Drives that the joints move; platform, and half of each leg at its end. The other half stays on the base."""
        own, ends, bodies = self.inertia, self.platform_points(pose, g), Bodies()
        at_home = self.leg_lengths(ca.SX(self.home), g)
        for k, leg in enumerate(self.members(pose, joints, g)[:3]):
            bodies.rotors.append(Rotor(own.drive, joints[k]))
            tube = self.structure.of(leg).density * self.link(ends[:, k], ends[:, k], g).area * at_home[k]
            mass = tube + 2 * own.link_joint if own.link_mass is None else own.link_mass
            bodies.particles.append(Particle(f"leg {k + 1}", mass / 2, ends[:, k]))
        self.platform_bodies(pose, joints, g, payload, bodies)
        return bodies
