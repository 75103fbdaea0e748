"""The aspect that home is in: the poses and joints that are reached from there without a singularity of either kind.

Within it no J_q,i and not the determinant of J_x changes its sign. Joints that belong to several poses mostly have one
with home's signs; that is the pose in home's assembly mode. Wenger and Chablat, "Uniqueness domains in the workspace of
parallel manipulators", 1997.
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
    """(k,) whether det J_x has home's sign at poses (k, n) with joints (k, m); where home has none, True."""
    return ~(_over_home(robot, poses, joints)[:, 0] < -_SINGULAR)


def joined_to_home(robot: Mechanism, rows: Array, poses: Array, joints: Array) -> Array:
    """Of candidates the pose in home's assembly mode; of several the nearest to home.

    It has home's signs, and so has every pose on the line from home to it; else the pose to which home leads on a
    straight line of the joints. Where no candidate has home's signs of J_q, as joints of another working mode have
    none, that of det J_x decides. Any candidate serves where home itself is singular or out of reach.

    Args:
        robot: with as many joints as freedoms.
        rows: (j,) to which joints each candidate belongs.
        poses: (j, n) candidates, the same pose more than once or not; NaN for none.
        joints: (k, m).

    Returns:
        (k, n); NaN where no pose is joined to home.
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
