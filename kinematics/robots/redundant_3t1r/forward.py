"""The direct geometric model of the redundant 3T-1R robot, (10)-(22) of its paper, with all four candidates.

Arms 1, 2 and 5 place B_1: two radical planes meet in a line that cuts a sphere twice. Arms 3 and 4 place B_3 in the
horizontal plane that B_1 fixes: two circles, two points. Arm 6 and the distance between B_1 and B_3 are not used, so
a candidate is a pose of the robot only if these two close as well. Everything is written from the slides x_1 and x_3
on, so that a shift along x costs no digits; with h = z_1 - a/2 nothing but h, y_1 and y_3 is divided by.

B_1 is the intersection of regular spheres wherever all arms reach: n_1 . (n_2 x n_5) has the sign of y_1 h throughout.
"""

from __future__ import annotations

from types import SimpleNamespace

import casadi as ca

from kinematics.mathematics import not_below_zero
from kinematics.model import Build, Mechanism, Model


def candidates(robot: Mechanism, model: Model) -> Build:
    """From the joints: the poses (4, 4), one a row; each one's worst error of a length (4,); least x_bi - x_i (4,).

    The last is reversed for a limb whose slide is ahead of its platform point in the working mode.
    """
    poses, ahead, excess = candidate_poses(model.joints, model.g)
    ahead = ca.diag(ca.DM(model.mode.branches)) @ ahead
    columns = range(poses.shape[1])
    gaps = [ca.vertcat(robot.closure(poses[:, k], model.joints, model.g), excess[k]) for k in columns]
    errors = ca.vertcat(*(ca.mmax(ca.fabs(gap)) for gap in gaps))
    return [model.joints], [poses.T, errors, ca.vertcat(*(ca.mmin(ahead[:, k]) for k in columns))]


def candidate_poses(joints: ca.SX, g: SimpleNamespace) -> tuple[ca.SX, ca.SX, ca.SX]:
    """S_1 to S_4 of (20), one a column; NaN where a line misses its sphere.

    Returns:
        Poses (4, 4); x_bi - x_i (6, 4), for (21); how much too far apart B_1 and B_3 are, seen from above (1, 4).
    """
    poses, ahead, excess = [], [], []
    for first in (1, -1):
        along, y_1, height = _first_point(joints, g, first)
        for third in (1, -1):
            beyond, y_3 = _third_point(joints, g, height, third)
            x_1, x_3 = joints[0] + along, joints[2] + beyond
            apart = ca.vertcat(joints[2] - joints[0] + beyond - along, y_3 - y_1)
            distance = ca.norm_2(apart)
            direction = apart / distance  # (cos theta, sin theta), below (21)
            centre = ca.vertcat(x_1, y_1) + g.platform_length / 2 * direction  # (22)
            poses.append(ca.vertcat(centre, height, ca.atan2(direction[1], direction[0])))
            ahead.append(ca.vertcat(x_1, x_1, x_3, x_3, x_1, x_1) - joints)
            excess.append(distance - g.platform_length)
    return ca.horzcat(*poses), ca.horzcat(*ahead), ca.horzcat(*excess)


def _first_point(joints: ca.SX, g: SimpleNamespace, branch: int) -> tuple[ca.SX, ca.SX, ca.SX]:
    """B_1 from (10), (11) and (14): x_b1 - x_1, y_b1 and z_b1 - a/2, which is the pose's z."""
    h = g.outer_rail_z - g.platform_height / 2
    across, up = joints[1] - joints[0], joints[4] - joints[0]
    y = _radical_plane(across, g.outer_rail_y)
    z = _radical_plane(up, h)
    along = _line_and_sphere([y, z], [g.outer_rail_y, h], g.outer_arm_length**2, branch)
    return along, y[0] + y[1] * along, z[0] + z[1] * along


def _third_point(joints: ca.SX, g: SimpleNamespace, height: ca.SX, branch: int) -> tuple[ca.SX, ca.SX]:
    """B_3 from (15), (16) and (19), which puts it at the pose's own z: x_b3 - x_3 and y_b3."""
    y = _radical_plane(joints[3] - joints[2], g.middle_rail_y)
    along = _line_and_sphere([y], [g.middle_rail_y], g.middle_arm_length**2 - height**2, branch)
    return along, y[0] + y[1] * along


def _radical_plane(apart: ca.SX, half: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Plane of the circle in which two equal spheres meet, as v = c_0 + c_1 u.

    The centres are (0, half) and (apart, -half) in the plane of u (along x) and v.
    """
    return -(apart**2) / (4 * half), apart / (2 * half)


def _line_and_sphere(line: list[tuple[ca.SX, ca.SX]], centre: list[ca.SX], square: ca.SX, branch: int) -> ca.SX:
    """u at which the line (u, v_k = c_k0 + c_k1 u) meets the sphere of squared radius about (0, centre_k)."""
    a, half_b, c = ca.SX(1), ca.SX(0), -square
    for (constant, slope), middle in zip(line, centre, strict=True):
        a += slope**2
        half_b += slope * (constant - middle)
        c += (constant - middle) ** 2
    inside = not_below_zero(half_b**2 - a * c, half_b**2 + ca.fabs(a * c))
    return (-half_b + branch * ca.sqrt(inside)) / a
