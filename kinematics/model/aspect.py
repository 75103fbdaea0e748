"""The aspect of home: the poses and joints that the robot can reach from home without a singularity of either kind.

Within an aspect no J_q,i changes its sign, and neither does the determinant of J_x. If joints belong to several poses,
mostly one of them has home's signs. This is the pose in home's assembly mode. Wenger and Chablat, "Uniqueness
domains in the workspace of parallel manipulators", 1997.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from kinematics.arrays import Array
from kinematics.model.continuation import continued, state_at
from kinematics.model.pose_line import joined

if TYPE_CHECKING:
    from kinematics.model.mechanism import Mechanism

_SINGULAR = 1e-6  # of home's value: where rounding of a double root, halved digits, says nothing of the side


def in_aspect(robot: Mechanism, poses: Array, joints: Array) -> Array:
    """(k,) whether det J_x has home's sign at poses (k, n) with joints (k, m); True if home has no sign."""
    return ~(_over_home(robot, poses, joints)[:, 0] < -_SINGULAR)


def joined_to_home(robot: Mechanism, rows: Array, poses: Array, joints: Array) -> Array:
    """The candidate in home's assembly mode. If there are several, the nearest to home.

    First choice: a pose with home's signs, where every pose on the line from home to it has them too. Second choice:
    the pose that a straight line of the joints leads to from home. If no candidate has home's signs of J_q, as for
    joints of another working mode, only the sign of det J_x decides. If home itself is singular or out of reach, any
    candidate is accepted.

    Args:
        robot: a robot with as many joints as freedoms.
        rows: (j,) the row of `joints` that each candidate belongs to.
        poses: (j, n) candidates. A pose may be there more than once; NaN is no candidate.
        joints: (k, m).

    Returns:
        (k, n) poses; NaN if no pose is joined to home.
    """
    real = np.isfinite(poses).all(axis=1)
    rows, poses = rows[real], poses[real]
    over_home = _over_home(robot, poses, joints[rows])
    away = np.where(over_home[:, 0] < -_SINGULAR, np.inf, _away(robot, poses))
    other = (over_home[:, 1:] < -_SINGULAR).any(axis=1)
    result = np.full((len(joints), poses.shape[1]), np.nan)
    order = np.lexsort((away, other, rows))
    order = order[np.isfinite(away[order])]
    found, first = np.unique(rows[order], return_index=True)
    result[found] = poses[order[first]]
    if _at_home(robot)[0] == 0.0:
        return result
    lost = np.isfinite(joints).all(axis=1)
    lost[found] = ~joined(robot, robot.home, result[found])
    result[lost] = continued(robot, joints[lost], robot.home)
    return result


def _away(robot: Mechanism, poses: Array) -> Array:
    """(k,) how far poses are from home, a turn at the characteristic length [m]."""
    gap = poses - robot.home
    turns = np.isin(np.arange(gap.shape[1]), robot.rotations)
    angle = np.abs(gap[:, turns]) if robot.counts_turns else 2 * np.abs(np.sin(gap[:, turns] / 2))
    far: Array = np.linalg.norm(gap[:, ~turns], axis=1) + robot.characteristic_length * angle.sum(axis=1)
    return far


def _values(robot: Mechanism, poses: Array, joints: Array) -> Array:
    """(k, 1 + m) det J_x and each J_q,i."""
    state = state_at(robot, poses, joints)
    return np.column_stack([state.determinant, state.j_q])


def _over_home(robot: Mechanism, poses: Array, joints: Array) -> Array:
    """(k, 1 + m) the same over their values at home; 1 where home has none."""
    home = _at_home(robot)
    values = _values(robot, poses, joints)
    result: Array = np.divide(values, home, out=np.ones_like(values), where=home != 0.0)
    return result


@lru_cache(maxsize=512)
def _at_home(robot: Mechanism) -> Array:
    """(1 + m,) 0 where home is out of reach or singular."""
    result: Array = np.nan_to_num(_values(robot, robot.home[None], robot.inverse(robot.home)[None]))[0]
    return result
