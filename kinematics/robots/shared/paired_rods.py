"""A model of single rods: a limb of two parallel rods holds an orientation only as long as J_int is regular.

Each rod's length gives one equation between the actuators and all freedoms of the bodies that it carries, including
tilts: J_l q' = J_r v. Sums and differences of the rows of a limb's two rods, and of columns, make it block triangular.
The lower right block shows the internal singularities. Method and names: Krut et al. 2006, (47)-(58).
"""

from __future__ import annotations

from abc import abstractmethod
from types import SimpleNamespace
from typing import ClassVar, NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.model import Mechanism, Model


class BlockTriangular(NamedTuple):
    """[J_q; 0] q' = [J_x J_int_x; 0 J_int] [x'; v_int]; (50)."""

    j_q: Array
    j_x: Array
    j_int_x: Array
    j_int: Array


class RodLevel(Mechanism):
    """A mechanism that also knows its single rods, and how the bodies that they hold can move."""

    rod_velocities: ClassVar[tuple[str, ...]]  # what v holds
    row_combinations: ClassVar[np.ndarray]  # M of (51)
    column_combinations: ClassVar[np.ndarray]  # P of (51): the twist first, then the other freedoms

    @classmethod
    @abstractmethod
    def limb_ends(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """A_i (3, m) and B_i (3, m), the ends of each limb's rod, or of the line midway between its two rods."""

    @classmethod
    @abstractmethod
    def rods_aside(cls, g: SimpleNamespace) -> list[tuple[int, ca.SX]]:
        """The limb of each rod, from 0, and how far the rod is beside A_i B_i (3,)."""

    @staticmethod
    @abstractmethod
    def rod_lengths(g: SimpleNamespace) -> ca.SX:
        """(m,) of each limb's rods."""

    @staticmethod
    @abstractmethod
    def carried(pose: ca.SX, displacement: ca.SX, limb: int, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """Shift (3,) and turn (3,) of the body that a limb holds, about the tool point, to first order.

        They are linear in `displacement`, which is in the directions of `rod_velocities`.
        """

    @abstractmethod
    def internal_determinant_symbolic(self) -> ca.SX:
        """det J_int, up to a sign, over what makes it dimensionless in [-1, 1]."""

    @classmethod
    def rod_closure(cls, pose: ca.SX, displacement: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(k,) half of |A B|^2 - l^2 of each rod after a small displacement; (47)."""
        (starts, ends), lengths, rows = cls.limb_ends(pose, joints, g), cls.rod_lengths(g), []
        for limb, aside in cls.rods_aside(g):
            shift, turn = cls.carried(pose, displacement, limb, g)
            end = ends[:, limb] + aside
            moved = end + shift + ca.cross(turn, end - pose[:3])
            rows.append((ca.sumsqr(starts[:, limb] + aside - moved) - lengths[limb] ** 2) / 2)
        return ca.vertcat(*rows)

    @classmethod
    def rod_wrenches(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(f, k) what each rod's tension of 1 N does to the freedoms: the twist, then the others of `P`."""
        (starts, ends), lengths, columns = cls.limb_ends(pose, joints, g), cls.rod_lengths(g), []
        displacement = ca.SX.sym("displacement", len(cls.rod_velocities))
        for limb, aside in cls.rods_aside(g):
            shift, turn = (ca.jacobian(v, displacement) for v in cls.carried(pose, displacement, limb, g))
            pull = (starts[:, limb] - ends[:, limb]) / lengths[limb]
            columns.append(shift.T @ pull + turn.T @ ca.cross(ends[:, limb] + aside - pose[:3], pull))
        return ca.DM(cls.column_combinations).T @ ca.horzcat(*columns)

    @classmethod
    def beyond_twist(cls, pose: ca.SX, g: SimpleNamespace, limb: int | None, point: ca.SX) -> ca.SX:
        """As what the limb holds; a body that no limb holds moves as the mean of those that limbs hold."""
        held = range(len(cls.joint_names)) if limb is None else (limb,)
        displacement, velocity = ca.SX.sym("displacement", len(cls.rod_velocities)), ca.SX(3, 1)
        for one in held:
            shift, turn = cls.carried(pose, displacement, one, g)
            velocity += (shift + ca.cross(turn, point - pose[:3])) / len(held)
        by_freedom = ca.jacobian(velocity, displacement) @ ca.DM(cls.column_combinations)
        return by_freedom[:, pose.numel() :]

    def rod_system_symbolic(self) -> tuple[ca.SX, ca.SX]:
        """J_l (k, m) and J_r (k, v) of (49) at a pose, by differentiation of the rods' lengths."""
        model = self.model()
        displacement = ca.SX.sym("displacement", len(self.rod_velocities))
        rods = self.rod_closure(model.pose, displacement, model.joints, model.g)
        j_l, j_r = ca.jacobian(rods, model.joints), -ca.jacobian(rods, displacement)
        j_l, j_r = (ca.substitute(j, displacement, 0 * displacement) for j in (j_l, j_r))
        return model.at_pose(j_l), model.at_pose(j_r)

    def rod_system(self, pose: Array) -> tuple[Array, Array]:
        """J_l (..., k, m) and J_r (..., k, v) with J_l q' = J_r v; (49). Redundant drives make k > v."""
        j_l, j_r = self._evaluate(_rod_system, pose)
        return j_l, j_r

    def block_triangular(self, pose: Array) -> BlockTriangular:
        """The system of `rod_system` after (51) and (52)."""
        return BlockTriangular(*self._evaluate(_blocks, pose))

    def internal_determinant(self, pose: Array) -> Array:
        """(...,) det J_int, dimensionless in [-1, 1], sign kept; 0 is an internal singularity."""
        return self._evaluate(_internal_determinant, pose)[0][..., 0]


def _rod_system(robot: RodLevel, _: Model) -> list[ca.SX]:
    return list(robot.rod_system_symbolic())


def _internal_determinant(robot: RodLevel, _: Model) -> list[ca.SX]:
    return [robot.internal_determinant_symbolic()]


def _blocks(robot: RodLevel, _: Model) -> list[ca.SX]:
    j_l, j_r = robot.rod_system_symbolic()
    m, n = len(robot.joint_names), len(robot.pose_names)
    left = ca.DM(robot.row_combinations) @ j_l
    right = ca.DM(robot.row_combinations) @ j_r @ ca.DM(robot.column_combinations)
    return [left[:m, :], right[:m, :n], right[:m, n:], right[m:, n:]]


def means_and_differences(limbs: int) -> np.ndarray:
    """(2 m, 2 m) the means of each limb's two rows, then their differences: `row_combinations` of m pairs."""
    result: np.ndarray = np.vstack([np.kron(np.eye(limbs), [0.5, 0.5]), np.kron(np.eye(limbs), [1.0, -1.0])])
    return result


def outline(start: ca.SX, end: ca.SX, half: ca.SX) -> ca.SX:
    """(3, 5) the parallelogram of a limb's two rods, `half` (3,) to either side of the line between two points."""
    return ca.horzcat(start - half, end - half, end + half, start + half, start - half)
