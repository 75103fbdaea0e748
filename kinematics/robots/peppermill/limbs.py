"""The Peppermill's two limbs in closed form, each in its own plane.

A limb moves in the plane across its drive axis a_i, spanned by x_i and y_i: (j, k) for limb 1 and (k, i) for limb 2. In
this plane it is a chain of two bars from A_i to P_i. The drive turns its proximal link r_i by theta_i. All functions
work on both limbs at once, on (2,) columns. Equation numbers are those of the paper.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import NamedTuple

import casadi as ca

from kinematics.machine import TURN

ELBOWS = ((1, 1), (1, -1), (-1, 1), (-1, -1))  # sign of sin lambda_i, the +- of (25); usual first
SIDES = ((1, -1), (1, 1), (-1, -1), (-1, 1))  # sign of v_iz; usual: limb 1 reaches up, limb 2 down


class Plane(NamedTuple):
    """Coordinates of a vector in both limbs' planes, each (2,)."""

    along_x: ca.SX
    along_y: ca.SX


def target(pose: ca.SX, g: SimpleNamespace) -> Plane:
    """q_i = p_i - d_i a_i [m], from A_i to P_i; (20). In (13) b_0 has the sign that (9), (29), (30) give it."""
    heights = pose[2] + g.half_distance * ca.DM([1, -1]) + g.pitches / TURN * pose[3]
    return Plane(ca.vertcat(pose[1], heights[1]), ca.vertcat(heights[0], pose[0]))


def triangle(q: Plane, g: SimpleNamespace) -> tuple[ca.SX, ca.SX, ca.SX]:
    """|q|^2, -e_3 of (26), sqrt(e_1^2 + e_2^2 - e_3^2) as a product that keeps its digits near straight limbs.

    The root is NaN where the angle is free.
    """
    near, far = g.proximal_lengths, g.distal_lengths
    square = q.along_x**2 + q.along_y**2
    root = ca.sqrt(((near + far) ** 2 - square) * (square - (near - far) ** 2)) / (2 * near)
    root = ca.if_else(_determined(square, g), root, ca.DM.nan(2))
    return square, (square + near**2 - far**2) / (2 * near), root


def _determined(square: ca.SX, g: SimpleNamespace) -> ca.SX:
    """(2,) whether |q_i|^2 determines theta_i: links as long as each other, folded onto the drive axis, turn freely."""
    return ca.fmax(square, ca.fabs(g.proximal_lengths - g.distal_lengths)) > 0


def cosines_and_sines(pose: ca.SX, elbows: tuple[int, ...], g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
    """(2,) and (2,) of theta_i; (24)-(26), without the half angle of (25), which is not defined at pi."""
    q = target(pose, g)
    square, right, root = triangle(q, g)
    root = ca.DM(elbows) * root
    return (q.along_x * right + q.along_y * root) / square, (q.along_y * right - q.along_x * root) / square


def reach(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
    """(2,) distance of |q_i| from the ends of [|r_i - l_i|, r_i + l_i], inside positive [m].

    NaN if any theta_i closes.
    """
    q = target(pose, g)
    square = q.along_x**2 + q.along_y**2
    distance, near, far = ca.sqrt(square), g.proximal_lengths, g.distal_lengths
    margin = ca.fmin(near + far - distance, distance - ca.fabs(near - far))
    return ca.if_else(_determined(square, g), margin, ca.DM.nan(2))


def distal(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> Plane:
    """l_i v_i = q_i - r_i u_i [m]; (21), (27)."""
    q, near, theta = target(pose, g), g.proximal_lengths, joints[2:]
    return Plane(q.along_x - near * ca.cos(theta), q.along_y - near * ca.sin(theta))


def pose_of_joints(joints: ca.SX, sides: tuple[int, int], g: SimpleNamespace) -> ca.SX:
    """(4,) pose; (28)-(35). The sign of v_iz takes the place of the arcsine's and the arccosine's branch.

    The arcsine of (32) has its principal value at v_2z > 0; the working layout needs pi minus it.
    """
    near, far, theta = g.proximal_lengths, g.distal_lengths, joints[2:]
    level = ca.vertcat(joints[1] - near[0] * ca.cos(theta[0]), joints[0] - near[1] * ca.sin(theta[1]))  # l_i v_iy, v_ix
    proximal = ca.vertcat(near[0] * ca.sin(theta[0]), near[1] * ca.cos(theta[1]))
    height = proximal + ca.DM(sides) * ca.sqrt((far - level) * (far + level))
    right = height - g.half_distance * ca.DM([1, -1])
    p1, p2 = g.pitches[0], g.pitches[1]
    z = (p1 * right[1] - p2 * right[0]) / (p1 - p2)
    return ca.vertcat(joints[0], joints[1], z, TURN * (right[0] - right[1]) / (p1 - p2))


def in_space(plane: Plane) -> ca.SX:
    """(3, 2) the vectors of both limbs' planes in the base frame."""
    (x1, x2), (y1, y2) = ((v[0], v[1]) for v in plane)
    return ca.horzcat(ca.vertcat(0, x1, y1), ca.vertcat(y2, 0, x2))
