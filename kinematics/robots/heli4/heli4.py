"""Heli4 (Krut, Company, Nabat, Pierrot, IROS 2006): four rotary drives, two plates, a screw that turns the tool.

Limbs 1 and 2 carry the plate at the tool's height, limbs 3 and 4 the plate on the screw. Equation numbers are those of
the paper. If an equation in print is wrong, the expression here follows from the closure, and a comment says so.
"""

from __future__ import annotations

from functools import cached_property
from types import SimpleNamespace

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.evaluation import evaluate
from kinematics.machine import TURN, Member, Tube, bar
from kinematics.margins import ANGLE_ACCURACY, INTERNAL_STIFFNESS, PASSIVE_JOINT, ROTATIONAL_STIFFNESS, STANDARD
from kinematics.mathematics import gaps, real_roots, working_first
from kinematics.model import Build, FviBounds, Model, by_name, in_aspect, joined_to_home, polished
from kinematics.robots.heli4.bodies import Heli4Inertia, bodies
from kinematics.robots.heli4.forward import Plates, plates
from kinematics.robots.heli4.geometry import UPPER, Heli4Geometry
from kinematics.robots.heli4.links import links
from kinematics.robots.shared import (
    INTERNAL_DETERMINANT,
    ArmRanges,
    Limbs,
    PairedArms,
    central_limbs,
    height_in_reach,
    limb_members,
    means_and_differences,
    motors,
    outline,
    pairs_held,
    radial_directions,
    studs,
)

_E_Z = ca.DM([0, 0, 1])
_SAME = 1e-6  # rad, or times the robot's size: poses that differ by less are the same
_APART = 0.25  # times a rod's length: if the plates are further apart, the order of the roots may change
_OPEN = 1e-12  # rad, or times the robot's size: the largest error of a closed form, as a displacement


class Heli4(PairedArms):
    """Pose [x, y, z, theta], joints q1..q4 measured from e_z."""

    Geometry = Heli4Geometry
    Inertia = Heli4Inertia
    Ranges = ArmRanges
    geometry: Heli4Geometry
    inertia: Heli4Inertia
    pose_names = ("x", "y", "z", "theta")
    joint_names = ("q1", "q2", "q3", "q4")
    joint_units = ("rad",) * 4
    rotations = (3,)
    counts_turns = True
    fvi_bounds = FviBounds(joint_speed=20.0, joint_effort=127.0, speed=2.5, force=150.0)
    tool_member = "screw"
    margins = by_name(
        *STANDARD, ANGLE_ACCURACY, ROTATIONAL_STIFFNESS, INTERNAL_DETERMINANT, INTERNAL_STIFFNESS, PASSIVE_JOINT
    )
    rod_velocities = ("x", "y", "z", "omega_x", "omega_y", "theta", "epsilon_1", "epsilon_2")
    # (51): sums and differences of a limb's two rods; the plates' own rotations instead of the relative ones.
    row_combinations = means_and_differences(4)
    column_combinations = np.eye(8)[[0, 1, 2, 4, 5, 3, 6, 7]] - np.outer([0] * 6 + [1, 1], np.eye(8)[3])

    @property
    def characteristic_length(self) -> float:
        """p / (2 pi) [m], which turns a rotation into the travel between the plates."""
        return abs(self.geometry.pitch) / TURN

    @staticmethod
    def default_home(geometry: Heli4Geometry) -> tuple[float, ...]:
        """A pose on the axis below the drives, in the middle of the reach."""
        g = geometry
        depth = height_in_reach(g.base_radius, g.platform_radius, g.arm_length, g.rod_length)
        return 0.0, 0.0, -depth - g.plate_offset, 0.0

    # Points.

    @staticmethod
    def limbs(g: SimpleNamespace) -> Limbs:
        """P_i, (2), (3), and the arms' directions, (4), (5): q from e_z outward."""
        limbs = central_limbs(g)
        return limbs._replace(actuators=limbs.actuators + _heights(g.height_step * ca.DM(UPPER)))

    @staticmethod
    def platform_points(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """B_i (3, 4), where the rods meet the plates; (6)-(8), with p in metres per radian."""
        upper = ca.DM(UPPER)
        heights = g.plate_offset + upper * (g.height_step + g.pitch / TURN * pose[3])
        result: ca.SX = (
            ca.repmat(pose[:3], 1, 4) + g.platform_radius * radial_directions(g.azimuths)[0] + _heights(heights)
        )
        return result

    # Scales that make the Jacobians dimensionless.

    @staticmethod
    def scales(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """L l for each J_q,i; p l^4 for det J_x."""
        return ca.repmat(g.arm_length * g.rod_length, 4, 1), ca.fabs(g.pitch / TURN) * g.rod_length**4

    # The rods, one by one.

    @staticmethod
    def carried(pose: ca.SX, displacement: ca.SX, limb: int, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:  # noqa: ARG004
        """The plates turn by theta + epsilon; the upper one rises by -p epsilon_2.

        The paper prints the opposite sign of p in (49), (53) and (54), which contradicts its own (6).
        """
        climb = -UPPER[limb] * g.pitch / TURN * displacement[7]
        turn = ca.vertcat(displacement[3:5], displacement[5] + displacement[6 + limb // 2])
        return displacement[:3] + climb * _E_Z, turn

    def internal_determinant_symbolic(self) -> ca.SX:
        """Expression (59) over d^4 l^4."""
        normals = ca.horzsplit(self.parallelogram_normals())
        lines = ca.cross(normals[0], normals[1]), ca.cross(normals[2], normals[3])
        result: ca.SX = ca.cross(*lines)[2]
        return result

    bodies = bodies
    link_tree = links

    @classmethod
    def members(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
        """Arms, both rods of each limb, two plates in the shape of an H, and the screw from the tool point up.

        The middle bar of the upper plate stands above its rods' ends, so that the plates can pass each other.
        """
        ends = cls.platform_points(pose, g)
        held, radius = studs(ends, cls.limbs(g).axes(), g.parallelogram_width), g.plate_thickness / 2
        plates = []
        for name, thread, first in (("lower plate", "bearing", 0), ("upper plate", "nut", 2)):
            limbs = (first, first + 1)
            axles = [Tube(held[:, 2 * i], held[:, 2 * i + 1], radius, radius) for i in limbs]
            low = [ends[:, i] for i in limbs]
            high = [end + UPPER[first] * ca.vertcat(0, 0, g.plate_rise) for end in low]
            uprights = [Tube(a, b, radius, radius) for a, b in zip(low, high, strict=True)] if UPPER[first] else []
            shapes = (Tube(high[0], high[1], radius, radius), *axles, *uprights)
            plates.append(Member(name, (thread, *pairs_held(*limbs)), "plate", shapes))
        nut, travel = g.plate_offset + g.height_step + g.plate_rise, g.screw_turns * ca.fabs(g.pitch)
        lowest = ca.fmin(g.screw_radius, ca.fmin(g.plate_offset, nut - travel))
        foot, top = (pose[:3] + height * _E_Z for height in (lowest, ca.fmax(g.plate_offset, nut + travel)))
        screw = bar("screw", ("bearing", "nut"), "screw", foot, top, g.screw_radius)._replace(link="tool")
        return [*limb_members(cls, pose, joints, g, g.parallelogram_width), *plates, screw]

    @staticmethod
    def turns_left(pose: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:
        """To both ends of the screw."""
        return {"nut on the screw": g.screw_turns * TURN - ca.fabs(pose[3])}

    def base_members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:  # noqa: ARG002
        """The motors."""
        return motors(self.limbs(g), g)

    @staticmethod
    def skeleton(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:
        """Actuators' circle, arms, both rods of each limb, the two plates and the tool."""
        _, axis = radial_directions(g.azimuths)
        base, arms = Heli4.limbs(g).actuators, Heli4.limbs(g).elbows(joints)
        platform, half = Heli4.platform_points(pose, g), g.parallelogram_width / 2 * axis
        order = [0, 2, 1, 3, 0]
        lines = {"base": base[:, order]}
        for i in range(4):
            lines[f"arm {i + 1}"] = ca.horzcat(base[:, i], arms[:, i])
            lines[f"rods {i + 1}"] = outline(arms[:, i], platform[:, i], half[:, i])
        lines["platform lower"] = platform[:, [0, 1]]
        lines["platform upper"] = platform[:, [2, 3]]
        pointer = pose[:3] + g.platform_radius * ca.vertcat(ca.cos(pose[3]), ca.sin(pose[3]), 0)
        lines["tool"] = ca.horzcat(platform[:, 0:2] @ ca.DM([0.5, 0.5]), pose[:3], pointer)
        return lines

    # The forward model.

    def _poses_of(self, joints: Array, w: Array, t: Array) -> Array:
        """(..., 4) joints and the plates' unknowns w (...,) and t (...,) -> (..., 4) poses."""
        return evaluate(self.program(_pose_of_root), w[..., None], t[..., None], joints)[0]

    @cached_property
    def _sheet(self) -> int:
        """1 if home is below its four elbows, -1 if it is above them, 0 otherwise."""
        joints = self.inverse(self.home)
        if np.isfinite(joints).all():
            for sheet in (1, -1):
                if gaps(self._on_sheet(joints, sheet), self.home, self.geometry.size) <= _SAME:
                    return sheet
            return 0
        return 1

    def _on_sheet(self, joints: Array, sheet: int) -> Array:
        """(..., 4) -> (..., 4): both pairs of limbs on the lower sheet (1; smallest real root) or the upper (-1)."""
        quartic, kappa = evaluate(self.program(_quartic), joints)
        signs = np.where(np.arange(4, -1, -1) % 2, sheet, 1)  # of w in place of -w
        w = sheet * real_roots(quartic * signs, most=1)[..., 0]
        t = np.divide(kappa[..., 0], w, out=np.full_like(w, np.nan), where=w != 0.0)
        return self._poses_of(joints, w, t)

    def working_forward(self, joints: Array) -> Array:
        """(..., 4) -> (..., 4): the pose of home's assembly mode. Where it surely is on home's sheet, that is used."""
        joints = self._joints(joints)
        flat = joints.reshape(-1, 4)
        poses = self._on_sheet(flat, self._sheet) if self._sheet else np.full(flat.shape, np.nan)
        doubtful = np.flatnonzero(~self._surely_at_home(poses, flat))
        if doubtful.size:
            rows, found = self._candidates(flat[doubtful])
            poses[doubtful] = joined_to_home(self, rows, found, flat[doubtful])
        return poses.reshape(joints.shape)

    def _surely_at_home(self, poses: Array, joints: Array) -> Array:
        """(k,) whether both pairs of limbs hang (or stand) clearly, as at home.

        If not, the outermost root may belong to another assembly mode, on the other side of a singularity.
        """
        together = np.abs(self.geometry.pitch / TURN * poses[:, 3]) <= _APART * self.geometry.rod_length
        (above,) = evaluate(self.program(_above_elbows), poses, joints)
        clearly = (self._sheet * above < 0.0).all(axis=-1)
        sure: Array = together & clearly & in_aspect(self, poses, joints) & ~self._open(poses, joints)
        return sure

    def _candidates(self, joints: Array) -> tuple[Array, Array]:
        """(k, 4) joints -> rows (j,) and poses (j, 4), every real one, in the order of w."""
        in_w, in_t, kappa = evaluate(self.program(_quartics), joints)
        # w t = kappa: the larger unknown is used. The factor in the comparison avoids ties by symmetry.
        least, tie = np.sqrt(np.abs(kappa)), 0.9
        w, t = real_roots(in_w), real_roots(in_t)
        by_w = np.nonzero((np.abs(w) >= tie * least) & (w != 0.0))
        by_t = np.nonzero((np.abs(t) >= least / tie) & (t != 0.0))
        rows = np.concatenate([by_w[0], by_t[0]])
        w, t = w[by_w], t[by_t]
        found = np.concatenate([w, kappa[by_t[0], 0] / t]), np.concatenate([kappa[by_w[0], 0] / w, t])
        order = np.lexsort((found[0], rows))
        rows, poses = rows[order], self._poses_of(joints[rows[order]], found[0][order], found[1][order])
        exact = polished(self, poses, joints[rows], 3)
        lost = self._open(poses, joints[rows]) & np.isfinite(exact).all(axis=1)  # else on a singularity
        return rows, np.where(lost[:, None], exact, poses)

    def _open(self, poses: Array, joints: Array) -> Array:
        """(k,) whether a closed form lost too many digits."""
        result: Array = np.abs(self.closure_gap(poses, joints)).max(axis=-1) > _OPEN
        return result

    def assembly_modes(self, joints: Array) -> Array:
        """(4,) -> (k, 4), every real pose with these joints, at most four; that of home's assembly mode is first."""
        joints = self._one(joints)
        _, poses = self._candidates(joints[None])
        return working_first(poses, self.forward(joints), self.geometry.size)


def _plates(model: Model) -> Plates:
    """From s_i = B_i - A_i with both plates at the origin; (18) with h_i minus the actuator's own height."""
    spheres = Heli4.platform_points(ca.SX(4, 1), model.g) - Heli4.limbs(model.g).elbows(model.joints)
    return plates(spheres, model.g.rod_length)


def _above_elbows(robot: Heli4, model: Model) -> Build:
    """(2,) height of each plate above the middle between its two elbows, both moved to the plate."""
    to_elbow = robot.limbs(model.g).elbows(model.joints) - robot.platform_points(model.pose, model.g)
    return [model.pose, model.joints], [
        -ca.vertcat(to_elbow[2, 0] + to_elbow[2, 1], to_elbow[2, 2] + to_elbow[2, 3]) / 2
    ]


def _quartic(_: Heli4, model: Model) -> Build:
    found = _plates(model)
    return [model.joints], [found.quartic_in_w(), found.kappa]


def _quartics(_: Heli4, model: Model) -> Build:
    found = _plates(model)
    return [model.joints], [found.quartic_in_w(), found.quartic_in_t(), found.kappa]


def _pose_of_root(_: Heli4, model: Model) -> Build:
    w, t = ca.SX.sym("w"), ca.SX.sym("t")
    position = _plates(model).positions(w, t)
    turn = (position[3] - position[2]) / (model.g.pitch / TURN)
    return [w, t, model.joints], [ca.vertcat(position[:3], turn)]


def _heights(values: ca.SX) -> ca.SX:
    """(3, 4) columns along e_z."""
    row = values.T if values.shape[1] == 1 and values.shape[0] > 1 else ca.repmat(values, 1, 4)
    return ca.vertcat(ca.SX(2, 4), row)
