"""The redundant 3T-1R robot's parallel singularities in closed form, (35)-(38) of its paper.

M is of arms 1, 2, 5, 6.
"""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca

from kinematics.arrays import Array
from kinematics.mathematics import volume

_OUTER = [0, 1, 4, 5]


class ParallelSingularity(NamedTuple):
    """The two conditions of section V.B; J_x loses rank only where one of them is zero.

    Attributes:
        translation: (...,) sqrt(det M^T M) of (37), in [0, 1]: the outer arms hold B_1 where it is not zero.
        rotation: (...,) larger of |n_3 . (r x e_z)| and |n_4 . (r x e_z)| over |r x e_z|, in [0, 1]: the middle arms
            hold the angle where it is not zero.
    """

    translation: Array
    rotation: Array


def parallel_conditions(arms: ca.SX, theta: ca.SX) -> list[ca.SX]:
    """Translation and rotation, from the arms' directions n_i (3, 6) and the platform's angle."""
    across = ca.vertcat(ca.sin(theta), -ca.cos(theta), 0)  # r x e_z over d
    outer = volume(arms[:, _OUTER].T) / ca.sqrt((4 / 3) ** 3)
    return [outer, ca.fmax(ca.fabs(arms[:, 2].T @ across), ca.fabs(arms[:, 3].T @ across))]
