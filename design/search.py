"""Where a margin is worst: a dense grid, then a descent between its points.

A grid alone overstates the worst case, so the lowest grid poses are followed downhill until the step is far below the
grid's. The answer is still a sample's, an upper bound of the true worst, and it is named so.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from design.region import Region, unit_grid
from design.sweep import sweep
from kinematics import FviBounds, Mechanism

Array = np.ndarray
DENSE = 1_000_000  # poses of a grid that is far denser than any that is solved on


@dataclass(frozen=True)
class WorstPoses:
    """Local minima of a margin over a region, the lowest first.

    Attributes:
        values: (k,) the margin; -inf where a limb cannot reach and the margin has no value.
        poses: (k, n).
        sampled: how many poses the grid held.
    """

    values: Array
    poses: Array
    sampled: int

    @property
    def value(self) -> float:
        """The worst of all."""
        return float(self.values[0])

    @property
    def pose(self) -> Array:
        """(n,) where it is."""
        return self.poses[0]


def dense_counts(dimension: int, about: int) -> tuple[int, ...]:
    """Equal counts for a grid of roughly `about` poses, odd so that the middle is on it."""
    each = max(3, round(about ** (1.0 / max(1, dimension))))
    return (each + 1 - each % 2,) * dimension


def worst_poses(
    robot: Mechanism,
    region: Region,
    margin: str,
    *,
    bounds: FviBounds | None = None,
    characteristic_length: float | None = None,
    about: int = DENSE,
    descents: int = 64,
) -> WorstPoses:
    """Local minima of a margin, from a grid of about that many poses and descents between them.

    Args:
        robot: the mechanism with its geometry.
        region: where to look.
        margin: one of `robot.margins`.
        bounds, characteristic_length: as in `Mechanism.margin`.
        about: size of the grid.
        descents: how many of the lowest grid poses are followed downhill.
    """
    names = robot.pose_names
    region.check(names)
    counts = dense_counts(region.dimension, about)

    def value(unit: Array) -> Array:
        found = robot.margin(margin, region.from_unit(unit, names), bounds, characteristic_length)
        return np.where(np.isnan(found), -np.inf, found)

    if region.dimension == 0:
        pose = region.from_unit(np.empty((1, 0)), names)
        return WorstPoses(value(np.empty((1, 0))), pose, 1)
    grid = sweep(value, unit_grid(counts), keep=4 * descents)
    unit, values = descend(value, grid.at, 1.0 / (np.array(counts) - 1.0))
    order = np.argsort(values, kind="stable")
    unit, values = unit[order], values[order]
    poses = region.from_unit(unit, names)
    distinct = _distinct(poses, region.extent(names) + 1e-12)
    return WorstPoses(values[distinct], poses[distinct], grid.poses)


def descend(value, unit: Array, step: Array, rounds: int = 40) -> tuple[Array, Array]:  # type: ignore[no-untyped-def]
    """Compass search of all points at once inside the unit cube; a point without a better neighbour halves its step."""
    k = unit.shape[1]
    moves = np.concatenate([np.eye(k), -np.eye(k)])
    scale = np.ones(len(unit))
    best = value(unit)
    for _ in range(rounds):
        trial = np.clip(unit[:, None, :] + scale[:, None, None] * (moves * step)[None], 0.0, 1.0)
        values = value(trial)
        choice = values.argmin(axis=1)
        rows = np.arange(len(unit))
        better = values[rows, choice] < best
        unit = np.where(better[:, None], trial[rows, choice], unit)
        best = np.where(better, values[rows, choice], best)
        scale = np.where(better, scale, scale / 2.0)
    return unit, best


def _distinct(poses: Array, extent: Array) -> list[int]:
    """Indices of poses that are not within a hundredth of the region of an earlier one."""
    kept: list[int] = []
    for i, pose in enumerate(poses):
        if all(np.abs((pose - poses[j]) / extent).max() > 0.01 for j in kept):
            kept.append(i)
    return kept
