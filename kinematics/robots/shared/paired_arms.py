"""Rotary limbs of two rods each, as in Heli4, Delta and Par4: their single rods."""

from __future__ import annotations

from types import SimpleNamespace

import casadi as ca

from kinematics.robots.shared.arm_and_rod_members import SIDES
from kinematics.robots.shared.paired_rods import RodLevel
from kinematics.robots.shared.rotary_limbs import RotaryLimbs


class PairedArms(RodLevel, RotaryLimbs):
    """Rotary limbs whose rods are `parallelogram_width` apart along the arm's axis."""

    @classmethod
    def limb_ends(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """Elbows and platform points."""
        return cls.limbs(g).elbows(joints), cls.platform_points(pose, g)

    @classmethod
    def rods_aside(cls, g: SimpleNamespace) -> list[tuple[int, ca.SX]]:
        """Rods 11, 12, 21 and so on."""
        axes = cls.limbs(g).axes()
        return [(i, side * g.parallelogram_width * axes[:, i]) for i in range(axes.shape[1]) for side in SIDES.values()]

    @classmethod
    def rod_lengths(cls, g: SimpleNamespace) -> ca.SX:
        """The same for all."""
        result: ca.SX = ca.repmat(cls.limbs(g).rod, len(cls.joint_names), 1)
        return result

    def parallelogram_normals(self) -> ca.SX:
        """(3, m) axis x rod / l at a pose: about these no limb holds its body by the difference of its rods."""
        model = self.model()
        rods, axes = model.at_pose(self.rods(model.pose, model.joints, model.g)), self.limbs(model.g).axes()
        normals = [ca.cross(axes[:, i], rods[:, i]) / model.g.rod_length for i in range(rods.shape[1])]
        result: ca.SX = ca.horzcat(*normals)
        return result
