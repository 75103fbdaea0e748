"""Par4, the Quattro's architecture (Nabat et al., IROS 2005): four rotary limbs and a platform articulated in a plane.

Limbs 1 and 2 carry one half of the platform, limbs 3 and 4 the other. Two equal parallel bars join the halves into a
parallelogram (a pi joint): the halves keep their orientation and move on an arc about each other while the bars turn
by psi; a gear on the bars turns the tool by theta = k psi. The platform's dimensions, and the tool point midway
between the halves, are assumptions of this project: none of its source texts gives them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import MappingProxyType, SimpleNamespace

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.evaluation import evaluate
from kinematics.machine import AXES, TURN, Bodies, Member, Particle, Rotor, Tube, angle, bar, length, member_mass, ratio
from kinematics.margins import ANGLE_ACCURACY, INTERNAL_STIFFNESS, PASSIVE_JOINT, ROTATIONAL_STIFFNESS, STANDARD
from kinematics.mathematics import determinant, distinct, volume, working_first
from kinematics.model import Build, FviBounds, Model, by_name, joined_to_home, polished
from kinematics.robots.par4.forward import Halves, candidates
from kinematics.robots.par4.links import links
from kinematics.robots.par4.pi_joint import PI_JOINT
from kinematics.robots.shared import (
    INTERNAL_DETERMINANT,
    ArmInertia,
    ArmRanges,
    HalvesGeometry,
    Limbs,
    PairedArms,
    arms_and_rods,
    central_limbs,
    columns,
    height_in_reach,
    limb_members,
    means_and_differences,
    motors,
    pairs_held,
    radial_directions,
    studs,
)

_DEG = math.pi / 180.0
_LARGEST_VOLUME = (4 / 3) ** 1.5  # of N^T N with trace 4: three equal eigenvalues
_HALF = (-1.0, -1.0, 1.0, 1.0)  # which end of the bars each limb holds


@dataclass(frozen=True)
class Par4Geometry(HalvesGeometry):
    """A robot of the Quattro's size: an assumption of this project, not a datasheet.

    Raises:
        InvalidGeometry: as for any geometry; or both limbs of a half have the same azimuth.
    """

    base_radius: float = length(0.275, doc="R, of the actuators' axes")
    platform_radius: float = length(0.100, doc="r, of the rods' ends about the tool point at theta = 0")
    arm_length: float = length(0.375, doc="L, actuator to rod")
    rod_length: float = length(0.825, doc="l, rod")
    azimuths: tuple[float, ...] = angle(tuple(a * _DEG for a in (45, 135, 225, 315)), doc="alpha, of the limbs")
    bar_length: float = length(0.100, doc="b, of the bars between the halves")
    bar_angle: float = angle(-90 * _DEG, doc="delta, azimuth of the bars from half 1 to half 2 at theta = 0")
    parallelogram_width: float = length(0.06, doc="between the two rods of a limb")
    arm_radius: float = length(0.025, doc="of the arms' tubes, outside")
    arm_wall: float = length(0.002, doc="of the arms' tubes")
    rod_radius: float = length(0.006, doc="of the rods' tubes, outside")
    rod_wall: float = length(0.0015, doc="of the rods' tubes")
    bar_thickness: float = length(0.012, doc="of the platform's halves and bars")
    motor_radius: float = length(0.040, doc="of the motors")
    motor_length: float = length(0.080, doc="of the motors along their axes, without their round ends")
    amplification: float = ratio(4.0, doc="k, turns of the tool a turn of the bars; 1 without a gear")


@dataclass(frozen=True)
class Par4Inertia(ArmInertia):
    """The masses of the arms and the platform.

    Attributes:
        half_fittings: what each half carries: the rods' joints and the bars' bearings.
        half_masses: masses of the two halves; None takes those of their bars and fittings.
        bars_mass, bars_inertia: mass of both bars and the gear, at the tool point, and their inertia about e_z.
        tool: inertia of the tool about e_z; the payload is a point at the tool point.
    """

    _shapes = MappingProxyType({"half_masses": (2,)})
    half_fittings: tuple[float, float] = (0.268, 0.268)
    half_masses: tuple[float, float] | None = None
    bars_mass: float = 0.25
    bars_inertia: float = 5e-4
    tool: float = 2e-4


class Par4(PairedArms):
    """Pose [x, y, z, theta], joints q1..q4 measured from e_z outward. Elbows are out.

    The bars are turned by psi = theta / k. Beyond half a turn of the bars, the same place has another theta. The
    forward models give the one with |psi| <= pi.
    """

    Geometry = Par4Geometry
    Inertia = Par4Inertia
    Ranges = ArmRanges
    geometry: Par4Geometry
    inertia: Par4Inertia
    pose_names = ("x", "y", "z", "theta")
    joint_names = ("q1", "q2", "q3", "q4")
    joint_units = ("rad",) * 4
    rotations = (3,)
    counts_turns = True  # of the bars, by the gear
    fvi_bounds = FviBounds(joint_speed=20.0, joint_effort=127.0, speed=2.5, force=100.0)
    tool_member = "half 1"
    margins = by_name(
        *STANDARD,
        ANGLE_ACCURACY,
        ROTATIONAL_STIFFNESS,
        PI_JOINT,
        INTERNAL_DETERMINANT,
        INTERNAL_STIFFNESS,
        PASSIVE_JOINT,
    )
    rod_velocities = ("x", "y", "z", "omega_x", "omega_y", "omega_z", "theta")
    row_combinations = means_and_differences(4)
    column_combinations = np.eye(7)[:, [0, 1, 2, 6, 3, 4, 5]]

    @property
    def characteristic_length(self) -> float:
        """b / k, the travel between the halves for each radian of the tool [m]."""
        return self.geometry.bar_length / self.geometry.amplification

    @staticmethod
    def default_home(geometry: Par4Geometry) -> tuple[float, ...]:
        """A pose on the axis below the drives, in the middle of the reach."""
        g = geometry
        return 0.0, 0.0, -height_in_reach(g.base_radius, g.platform_radius, g.arm_length, g.rod_length), 0.0

    @staticmethod
    def limbs(g: SimpleNamespace) -> Limbs:
        """Arms in vertical planes through e_z."""
        return central_limbs(g)

    @staticmethod
    def half_bar(psi: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(3,) from the tool point to half 2, and reversed to half 1."""
        turned = g.bar_angle + psi
        result: ca.SX = g.bar_length / 2 * ca.vertcat(ca.cos(turned), ca.sin(turned), 0)
        return result

    @staticmethod
    def platform_points(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """On a circle about the tool point at theta = 0; each half then moves as its end of the bars does."""
        moved = Par4.half_bar(pose[3] / g.amplification, g) - Par4.half_bar(ca.SX(0), g)
        result: ca.SX = (
            columns(pose[:3], 4) + g.platform_radius * radial_directions(g.azimuths)[0] + moved @ ca.DM(_HALF).T
        )
        return result

    @staticmethod
    def scales(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """L l for each J_q,i; b / k l^4 for det J_x.

        det J_x is +- b / k ((l1 x l2) x (l3 x l4)) . e, l_i the rods and e the horizontal normal of the bars.
        """
        return ca.repmat(g.arm_length * g.rod_length, 4, 1), g.bar_length / g.amplification * g.rod_length**4

    # The rods, one by one.

    @staticmethod
    def carried(pose: ca.SX, displacement: ca.SX, limb: int, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """Both halves turn by omega, and the bars by (theta - omega_z) / k more, which the gear makes of the tool's."""
        omega, psi = displacement[3:6], pose[3] / g.amplification
        half = _HALF[limb] * Par4.half_bar(psi, g)
        further = (displacement[6] - omega[2]) / g.amplification
        return displacement[:3] + further * ca.cross(ca.SX([0, 0, 1]), half), omega

    def internal_determinant_symbolic(self) -> ca.SX:
        """Volume of the four `parallelogram_normals` over the largest of four unit vectors, (4/3)^(3/2)."""
        return volume(self.parallelogram_normals().T) / _LARGEST_VOLUME

    link_tree = links

    def bodies(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
        """Arms, rods, halves, bars, tool, payload."""
        i, psi, halves = self.inertia, pose[3] / g.amplification, ("half 1", "half 2")
        half = self.half_bar(psi, g)
        platforms = [halves[int(side > 0)] for side in _HALF]
        bodies = arms_and_rods(self, pose, joints, g, platforms, g.parallelogram_width)
        at_rest = self.members(ca.SX(4, 1), joints, g)[-2:]
        for k, (member, side) in enumerate(zip(at_rest, (-1, 1), strict=True)):
            own = i.half_fittings[k] + member_mass(member, self.structure.of(member).density)
            mass = own if i.half_masses is None else i.half_masses[k]
            bodies.particles.append(Particle(halves[k], mass, pose[:3] + side * half))
        bodies.particles.append(Particle("bars", i.bars_mass + payload, pose[:3]))
        bodies.rotors.extend([Rotor(i.bars_inertia, psi, AXES[2]), Rotor(i.tool, pose[3], AXES[2])])
        return bodies

    @classmethod
    def members(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
        """Arms, both rods of each limb, the halves, and the bars by the line midway, which joins the halves."""
        ends, thick = cls.platform_points(pose, g), g.bar_thickness / 2
        middle = cls.half_bar(pose[3] / g.amplification, g)
        at = {"half 1": (pose[:3] - middle, (0, 1)), "half 2": (pose[:3] + middle, (2, 3))}
        platform = [bar("bars", tuple(at), "plate", at["half 1"][0], at["half 2"][0], thick)._replace(link="crank")]
        held = studs(ends, cls.limbs(g).axes(), g.parallelogram_width)
        for name, (centre, limbs) in at.items():
            spokes = [Tube(centre, ends[:, i], thick, thick) for i in limbs]
            axles = [Tube(held[:, 2 * i], held[:, 2 * i + 1], thick, thick) for i in limbs]
            platform.append(Member(name, (name, *pairs_held(*limbs)), "plate", (*spokes, *axles)))
        return limb_members(cls, pose, joints, g, g.parallelogram_width) + platform

    def base_members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:  # noqa: ARG002
        """The motors."""
        return motors(self.limbs(g), g)

    @classmethod
    def skeleton(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:
        """Base, arms, rod pairs by their midlines, the halves, a bar, the tool."""
        ends, half = cls.platform_points(pose, g), cls.half_bar(pose[3] / g.amplification, g)
        pointer = pose[:3] + g.platform_radius / 2 * ca.vertcat(ca.cos(pose[3]), ca.sin(pose[3]), 0)
        lines = cls.limb_lines(pose, joints, g)
        lines["half 1"] = ca.horzcat(ends[:, 0], pose[:3] - half, ends[:, 1])
        lines["half 2"] = ca.horzcat(ends[:, 2], pose[:3] + half, ends[:, 3])
        lines["bar"] = ca.horzcat(pose[:3] - half, pose[:3] + half)
        return lines | {"tool": ca.horzcat(pose[:3], pointer)}

    # The forward model.

    def _candidates(self, joints: Array, every: bool) -> tuple[Array, Array]:
        """(k, 4) joints -> rows (j,) and poses (j, 4) close to all that have these joints."""

        (centres,) = evaluate(self.program(_spheres), joints)
        g = self.geometry
        rows, halves = candidates(Halves(centres / g.rod_length, g.bar_length / g.rod_length), every)
        between = (halves[:, 1, :2] - halves[:, 0, :2]) @ [1, 1j] * np.exp(-1j * g.bar_angle)
        return rows, np.column_stack([halves.mean(axis=1) * g.rod_length, g.amplification * np.angle(between)])

    def working_forward(self, joints: Array) -> Array:
        """(..., 4) -> (..., 4): the pose of home's assembly mode."""
        joints = self._joints(joints)
        flat = joints.reshape(-1, 4)
        rows, poses = self._candidates(flat, every=False)
        poses = polished(self, poses, flat[rows], 8)
        result = joined_to_home(self, rows, poses, flat)
        turn = TURN * self.geometry.amplification  # of the bars: the same place
        result[:, 3] -= turn * np.round(result[:, 3] / turn)
        return result.reshape(joints.shape)

    def assembly_modes(self, joints: Array) -> Array:
        """(4,) -> (k, 4), every isolated real pose with these joints, at most eight; the working one first."""
        joints = self._one(joints)
        _, poses = self._candidates(joints[None], every=True)
        poses = polished(self, poses, np.broadcast_to(joints, poses.shape), 20)
        poses = poses[np.isfinite(poses).all(axis=1)]
        poses = poses[np.argsort(poses[:, 2], kind="stable")]
        turn = np.exp(1j * poses[:, 3] / self.geometry.amplification)
        apart = np.abs(turn[:, None] - turn) * self.geometry.bar_length / self.geometry.rod_length
        apart = apart + np.linalg.norm(poses[:, None, :3] - poses[:, :3], axis=-1) / self.geometry.rod_length
        poses = poses[distinct(apart, self._regularity(poses, np.broadcast_to(joints, poses.shape)))]
        return working_first(poses, self.forward(joints), self.geometry.size)

    def _regularity(self, poses: Array, joints: Array) -> Array:
        """(k,) det J_x over its scale, in any mode."""
        return evaluate(self.program(_regularity), poses, joints)[0][..., 0]


def _spheres(robot: Par4, model: Model) -> Build:
    g = model.g
    centres = robot.limbs(g).elbows(model.joints) - robot.platform_points(ca.SX(4, 1), g)
    return [model.joints], [(centres + robot.half_bar(ca.SX(0), g) @ ca.DM(_HALF).T).T]


def _regularity(robot: Par4, model: Model) -> Build:
    return [model.pose, model.joints], [determinant(model.j_x) / robot.scales(model.g)[1]]
