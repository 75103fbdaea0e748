"""Redundant 3T-1R robot (Shayya, Krut, Company, Baradat, Pierrot, IROS 2013): six parallel slides, four freedoms.

Arms 1, 2 and 5, 6 are single rods to the ends of an upright platform; arms 3 and 4 are parallelograms to its far side.
Equation numbers are those of the paper. If an equation in print is wrong, the expression here follows from the closure,
and a comment says so. The paper draws the platform without dimensions. With B_1 = B_2 at (-d/2, 0, a/2), B_3 = B_4 at
(d/2, 0, 0) and B_5 = B_6 at (-d/2, 0, -a/2) in the platform's frame, the figures of its Table I are reproduced.

The parallelograms are arms 3 and 4 (chains III and IV, section II). Their short sides are along e_z: in any other
direction a side would turn with the platform at one end and not at the other.
"""

from __future__ import annotations

from types import SimpleNamespace

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.evaluation import evaluate
from kinematics.machine import PassiveJoint
from kinematics.margins import ANGLE_ACCURACY, INTERNAL_STIFFNESS, PASSIVE_JOINT, ROTATIONAL_STIFFNESS, STANDARD
from kinematics.model import (
    BestFit,
    EncoderCheck,
    FviBounds,
    Mode,
    Model,
    by_name,
    check_encoders,
    least_squares,
    polished,
)
from kinematics.robots.redundant_3t1r.bodies import Redundant3T1RInertia, bodies
from kinematics.robots.redundant_3t1r.clearance import arm_distances
from kinematics.robots.redundant_3t1r.forward import candidates
from kinematics.robots.redundant_3t1r.geometry import (
    LIMBS,
    PARALLELOGRAMS,
    Redundant3T1RGeometry,
    Redundant3T1RRanges,
)
from kinematics.robots.redundant_3t1r.members import base_members, members
from kinematics.robots.redundant_3t1r.singularities import ParallelSingularity, parallel_conditions
from kinematics.robots.redundant_3t1r.statics import statics
from kinematics.robots.shared import INTERNAL_DETERMINANT, SIDES, RodLevel, outline

_AHEAD = ca.DM([-0.5, -0.5, 0.5, 0.5, -0.5, -0.5])  # B_i along the platform's x, in units of d
_ABOVE = ca.DM([0.5, 0.5, 0.0, 0.0, -0.5, -0.5])  # B_i along e_z, in units of a
_SIDE = (1, -1, 1, -1, 1, -1)  # y_1 = y_5 = -y_2 = -y_6, y_3 = -y_4
_FLOOR = (1, 1, 0, 0, -1, -1)  # z_1 = z_2 = -z_5 = -z_6, z_3 = z_4 = 0
_OUTER = (0, 1, 4, 5)
_ROUNDING = 1e-9  # times the robot's size: the error that rounding may cause in (21)
_CLOSES = 1e-6  # times the robot's size: the largest error of an arm's length


class Redundant3T1R(RodLevel):
    """Pose [x, y, z, theta], joints x1..x6, the slides' own coordinates (X_r = 0 in (8))."""

    Geometry = Redundant3T1RGeometry
    Inertia = Redundant3T1RInertia
    Ranges = Redundant3T1RRanges
    geometry: Redundant3T1RGeometry
    inertia: Redundant3T1RInertia
    pose_names = ("x", "y", "z", "theta")
    joint_names = ("x1", "x2", "x3", "x4", "x5", "x6")
    joint_units = ("m",) * LIMBS
    rotations = (3,)
    margins = by_name(
        *STANDARD, ANGLE_ACCURACY, ROTATIONAL_STIFFNESS, INTERNAL_DETERMINANT, INTERNAL_STIFFNESS, PASSIVE_JOINT
    )
    mirrors = (("y", "theta"), ("z",))
    fvi_bounds = FviBounds(joint_speed=1.0, joint_effort=1.0, speed=0.5, force=0.5)
    rod_velocities = ("x", "y", "z", "omega_x", "omega_y", "theta")
    # (51) of Krut et al.: rows of single rods stay; a parallelogram gives its rods' mean and, last, their difference.
    row_combinations = np.zeros((8, 8))
    row_combinations[[0, 1, 4, 5], [0, 1, 6, 7]] = 1.0
    row_combinations[2:4, 2:6] = np.kron(np.eye(2), [0.5, 0.5])
    row_combinations[6:, 2:6] = np.kron(np.eye(2), [-1.0, 1.0])
    column_combinations = np.eye(6)[:, [0, 1, 2, 5, 3, 4]]

    @property
    def characteristic_length(self) -> float:
        """d / 2 [m], as in the paper's W."""
        return self.geometry.platform_length / 2

    @staticmethod
    def default_home(geometry: Redundant3T1RGeometry) -> tuple[float, ...]:  # noqa: ARG004
        """The middle between all rails; the place along them makes no difference."""
        return 0.0, 0.0, 0.0, 0.0

    # Points.

    @staticmethod
    def rail_points(joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """A_i (3, 6), on the slides."""
        y = [g.outer_rail_y if i in _OUTER else g.middle_rail_y for i in range(LIMBS)]
        columns = [ca.vertcat(joints[i], _SIDE[i] * y[i], _FLOOR[i] * g.outer_rail_z) for i in range(LIMBS)]
        return ca.horzcat(*columns)

    @staticmethod
    def platform_points(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """B_i (3, 6); (2), (3)."""
        forward, up = g.platform_length * _AHEAD.T, g.platform_height * _ABOVE.T
        result: ca.SX = ca.vertcat(
            pose[0] + ca.cos(pose[3]) * forward, pose[1] + ca.sin(pose[3]) * forward, pose[2] + up
        )
        return result

    @staticmethod
    def arm_lengths(g: SimpleNamespace) -> ca.SX:
        """L_i (6,)."""
        result: ca.SX = ca.vertcat(*(g.outer_arm_length if i in _OUTER else g.middle_arm_length for i in range(LIMBS)))
        return result

    # The closure and its closed forms.

    @staticmethod
    def closure(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(L^2 - |A_i B_i|^2) / (2 L), (4), so that J_q = diag(n_i . e_x) and J_x has the rows of (32)."""
        arms = Redundant3T1R.platform_points(pose, g) - Redundant3T1R.rail_points(joints, g)
        lengths = Redundant3T1R.arm_lengths(g)
        return (lengths**2 - ca.sum1(arms * arms).T) / (2 * lengths)

    @staticmethod
    def _across(pose: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """x_bi (6,) and the squared distance of B_i from its rail (6,)."""
        platform = Redundant3T1R.platform_points(pose, g)
        from_rail = platform[1:, :] - Redundant3T1R.rail_points(ca.SX(LIMBS, 1), g)[1:, :]
        return platform[0, :].T, ca.sum1(from_rail * from_rail).T

    @staticmethod
    def inverse_closed_form(pose: ca.SX, g: SimpleNamespace, mode: Mode) -> ca.SX:
        """(7): usually every slide is behind its platform point, which is the minus sign in (5)."""
        roots = Redundant3T1R.limb_roots(pose, g)
        return Redundant3T1R._across(pose, g)[0] - ca.vertcat(*(b * roots[i] for i, b in enumerate(mode.branches)))

    @classmethod
    def limb_roots(cls, pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """Distance of each slide from the point of its rail that is nearest to the platform point."""
        return ca.sqrt(cls.arm_lengths(g) ** 2 - cls._across(pose, g)[1])

    @staticmethod
    def reach(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """Each arm's length minus the distance of its platform point from the rail [m]."""
        return Redundant3T1R.arm_lengths(g) - ca.sqrt(Redundant3T1R._across(pose, g)[1])

    @staticmethod
    def scales(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """1, and sqrt(48) d/2 for sqrt(det J_x^T J_x): unit n_i and levers d/2 allow (6/3)^3 (6 d^2/4) at most."""
        return ca.SX.ones(LIMBS), ca.sqrt(48) * g.platform_length / 2

    # Rods, masses, drawing.

    def passive_joints(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[PassiveJoint]:
        """Universal joints whose first pins are along e_z at both ends, so that they turn freely with the platform.

        The paper has spherical joints or, as their angles are limited, three revolute joints (section II). That the
        first pin is upright is an assumption of this project.
        """
        arms, lengths = self.platform_points(pose, g) - self.rail_points(joints, g), self.arm_lengths(g)
        up = ca.SX([0, 0, 1])
        return [PassiveJoint(up, arms[:, i], lengths[i], end) for end in (0, 1) for i in range(LIMBS)]

    @staticmethod
    def limb_ends(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """Slides and platform points."""
        return Redundant3T1R.rail_points(joints, g), Redundant3T1R.platform_points(pose, g)

    @staticmethod
    def rods_aside(g: SimpleNamespace) -> list[tuple[int, ca.SX]]:
        """Eight rods: one above the other in arms 3 and 4."""
        upright = g.parallelogram_width * ca.SX([0, 0, 1])
        sides = [(SIDES.values() if limb in PARALLELOGRAMS else (0.0,)) for limb in range(LIMBS)]
        return [(limb, side * upright) for limb in range(LIMBS) for side in sides[limb]]

    rod_lengths = arm_lengths

    @staticmethod
    def carried(pose: ca.SX, displacement: ca.SX, limb: int, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:  # noqa: ARG004
        """All hold one rigid platform."""
        return displacement[:3], displacement[3:]

    @classmethod
    def rod_closure(cls, pose: ca.SX, displacement: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(L^2 - |rod|^2) / (2 L), as `closure`."""
        lengths = ca.vertcat(*(cls.rod_lengths(g)[limb] for limb, _ in cls.rods_aside(g)))
        return -super().rod_closure(pose, displacement, joints, g) / lengths

    def internal_determinant_symbolic(self) -> ca.SX:
        """(n_3 x n_4) . e_z: det J_int over the square of the parallelograms' width."""
        arms = _directions(self.model())
        return ca.cross(arms[:, 2], arms[:, 3])[2]

    def parallel_singularity(self, pose: Array) -> ParallelSingularity:
        """How far the pose is from a parallel singularity."""
        translation, rotation = self._evaluate(_parallel_conditions, pose)
        return ParallelSingularity(translation[..., 0], rotation[..., 0])

    bodies = bodies

    @staticmethod
    def skeleton(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:
        """A part of each rail about its slide, the arms (both rods of 3 and 4), and the platform."""
        rails, platform = Redundant3T1R.rail_points(joints, g), Redundant3T1R.platform_points(pose, g)
        stretch, half = ca.vertcat(g.outer_arm_length / 4, 0, 0), ca.vertcat(0, 0, g.parallelogram_width / 2)
        lines = {}
        for i in range(LIMBS):
            lines[f"rail {i + 1}"] = ca.horzcat(rails[:, i] - stretch, rails[:, i] + stretch)
            a, b = rails[:, i], platform[:, i]
            if i in PARALLELOGRAMS:
                lines[f"rods {i + 1}"] = outline(a, b, half)
            else:
                lines[f"arm {i + 1}"] = ca.horzcat(a, b)
        middle = (platform[:, 0] + platform[:, 4]) / 2
        lines["platform"] = ca.horzcat(platform[:, 0], middle, platform[:, 2], middle, platform[:, 4])
        return lines

    def arm_distances(self, pose: Array, rods: bool = False) -> dict[tuple[int, int], Array]:
        """{(i, j): (...,) metres} between the axes of arms, from 1, that share no platform point; NaN out of reach.

        Args:
            rods: use both rods of arms 3 and 4, not their middle line A_i B_i.
        """
        rails, platform = self._evaluate(_arm_ends, pose)
        return arm_distances(rails, platform, self.geometry.parallelogram_width if rods else 0.0)

    members = members
    statics = statics
    base_members = base_members

    def arm_clearance(self, pose: Array, rods: bool = False) -> Array:
        """(...,) the smallest of `arm_distances` [m], between axes: subtract the arms' thickness."""
        result: Array = np.min(list(self.arm_distances(pose, rods).values()), axis=0)
        return result

    # The forward models.

    def _candidates(self, joints: Array) -> tuple[Array, Array, Array]:
        """S_1 to S_4 (..., 4, 4), worst error of a length (..., 4) and smallest x_bi - x_i (..., 4), both in metres."""
        poses, errors, ahead = evaluate(self.program(candidates), joints)
        return poses, errors, ahead

    def working_forward(self, joints: Array) -> Array:
        """(..., 6) -> (..., 4), the candidate of (20) with every slide behind its platform point, (21), or ahead.

        With slides on both sides two candidates may be equal. Each then loses half of its digits. Newton's method
        restores them.
        """
        joints = self._joints(joints)
        poses = self._chosen(joints, _CLOSES * self.geometry.size)
        if len(set(self.mode.branches)) == 1:
            return poses
        return polished(self, poses.reshape(-1, 4), joints.reshape(-1, LIMBS), 4).reshape(poses.shape)

    def paper_forward(self, joints: Array) -> Array:
        """(..., 6) -> (..., 4) the pose of the paper's model, which ignores x_6, even if no pose has these joints.

        `forward_least_squares` uses all six joints.
        """
        return self._chosen(self._joints(joints), np.inf)

    def _chosen(self, joints: Array, tolerance: float) -> Array:
        """The best candidate; NaN if an arm or the platform would be wrong by more than `tolerance` [m]."""
        poses, errors, ahead = self._candidates(joints)
        score = np.fmax(np.where(np.isnan(errors), np.inf, errors), -ahead)
        best = score.argmin(axis=-1)[..., None]
        result = np.take_along_axis(poses, best[..., None], axis=-2)[..., 0, :]
        error, behind = (np.take_along_axis(v, best, axis=-1) for v in (errors, ahead))
        return np.where((error <= tolerance) & (behind >= -_ROUNDING * self.geometry.size), result, np.nan)

    def assembly_modes(self, joints: Array) -> Array:
        """(6,) -> (k, 4), every real pose in which all six arms close; the working one first, k = 0 if there is none.

        The paper's four candidates close arms 1, 2 and 5 (and 3, 4 only at the right distance from B_1): mostly one of
        them closes all six, on the planes y_b1 = 0 and z = 0 two of B_1 may.
        """
        joints = self._one(joints)
        poses, errors, ahead = self._candidates(joints)
        closing = np.flatnonzero(errors <= _CLOSES * self.geometry.size)
        return poses[closing[np.argsort(-ahead[closing], kind="stable")]]

    def forward_least_squares(self, joints: Array, start: Array | None = None) -> BestFit:
        """The pose whose joints are nearest to the measured ones, all six weighed alike.

        Args:
            joints: (..., 6), consistent or not.
            start: (..., 4) a pose nearby, such as the last one; by default the paper's model, or home at the median x
                where that finds no pose within reach.
        """
        joints = self._joints(joints)
        if start is None:
            start = self.paper_forward(joints)
            unreached = np.isnan(self.inverse(start)).any(axis=-1, keepdims=True)
            start = np.where(unreached, self._home_near(joints), start)
        return least_squares(self, joints, self._poses(start))

    def _home_near(self, joints: Array) -> Array:
        """Home, moved along x to where most of the joints say."""
        home = np.tile(self.home, (*joints.shape[:-1], 1))
        home[..., 0] += np.median(joints - self.inverse(self.home), axis=-1)
        return home

    def check_encoders(self, joints: Array, accuracy: float = 1e-6) -> EncoderCheck:
        """Find the faulty encoder from the two redundancy equations; see `joint_redundancy.check_encoders`.

        Encoders 3 and 4 can never be told apart. The outer arms alone decide B_1, which leaves only one equation more
        than the angle needs, and either of the two encoders may be wrong.

        The following holds for the default geometry and theta within ±90°. A fault of encoder 1, 2, 5 or 6 is found if
        it is 2.5 times the accuracy at the median of reachable poses, and 6 times at every pose tried. A fault of
        encoder 3 or 4 is found from 4 times the accuracy at the median, from 25 times at 95 % of the poses, and not at
        all where a turn of the platform does not move along its arm.

        Args:
            joints: (..., 6) measured.
            accuracy: the largest residual that sound encoders leave in a best fit [m].
        """
        joints = self._joints(joints)
        starts = self._home_near(joints)[..., None, :] + np.outer([-1.2, 0.0, 1.2], np.eye(4)[3])
        return check_encoders(self, joints, self.forward_least_squares(joints), starts, accuracy)


def _directions(model: Model) -> ca.SX:
    """n_i (3, 6) at a pose: the translation's part of J_x."""
    return model.j_x_at_pose[:, :3].T


def _parallel_conditions(_: Redundant3T1R, model: Model) -> list[ca.SX]:
    return parallel_conditions(_directions(model), model.pose[3])


def _arm_ends(robot: Redundant3T1R, m: Model) -> list[ca.SX]:
    """A_i and B_i (3, 6) at a pose."""
    return [m.at_pose(robot.rail_points(m.joints, m.g)), robot.platform_points(m.pose, m.g)]
