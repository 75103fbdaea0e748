"""The aspect that home is in: the poses and joints that are reached from there without a singularity of either kind.

Within it no J_q,i and not the determinant of J_x changes its sign. Joints that belong to several poses mostly have one
with home's signs; that is the pose in home's assembly mode. Wenger and Chablat, "Uniqueness domains in the workspace of
parallel manipulators", 1997.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from kinematics.continuation import state_at

if TYPE_CHECKING:
    from kinematics.mechanism import Mechanism

Array = np.ndarray


def in_aspect(robot: Mechanism, poses: Array, joints: Array) -> Array:
    """(k,) whether det J_x has home's sign at poses (k, n) with joints (k, m); where home has none, True."""
    return ~(_signs(robot, poses, joints)[:, 0] * _at_home(robot)[0] < 0.0)


def nearest_in_aspect(robot: Mechanism, rows: Array, poses: Array, joints: Array) -> Array:
    """Of candidates the pose in home's aspect; of several the nearest to home.

    Where none has home's signs of J_q, as joints of another working mode have not, that of det J_x decides.

    Args:
        robot: with as many joints as freedoms.
        rows: (j,) to which joints each candidate belongs.
        poses: (j, n) candidates, the same pose more than once or not.
        joints: (k, m).

    Returns:
        (k, n); NaN where there is no candidate with home's sign of det J_x.
    """
    signs, home = _signs(robot, poses, joints[rows]), _at_home(robot)
    rows, poses, signs = (v[~(signs[:, 0] * home[0] < 0.0)] for v in (rows, poses, signs))
    other = (signs[:, 1:] * home[1:] < 0.0).any(axis=1)
    order = np.lexsort((_away(robot, poses), other, rows))
    found, first = np.unique(rows[order], return_index=True)
    result = np.full((len(joints), poses.shape[1]), np.nan)
    result[found] = poses[order[first]]
    return result


def _away(robot: Mechanism, poses: Array) -> Array:
    """(k,) how far poses are from home, a turn at the characteristic length [m]."""
    gap = poses - robot.home
    turns = np.isin(np.arange(gap.shape[1]), robot.rotations)
    angle = np.abs(gap[:, turns]) if robot.counts_turns else 2 * np.abs(np.sin(gap[:, turns] / 2))
    far: Array = np.linalg.norm(gap[:, ~turns], axis=1) + robot.characteristic_length * angle.sum(axis=1)
    return far


def _signs(robot: Mechanism, poses: Array, joints: Array) -> Array:
    """(k, 1 + m) of det J_x and of each J_q,i."""
    state = state_at(robot, poses, joints)
    return np.sign(np.column_stack([state.determinant, state.j_q]))


@lru_cache(maxsize=512)
def _at_home(robot: Mechanism) -> Array:
    """(1 + m,) 0 where home is out of reach or singular."""
    return np.nan_to_num(_signs(robot, robot.home[None], robot.inverse(robot.home)[None]))[0]
